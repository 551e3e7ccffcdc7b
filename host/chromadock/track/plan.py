"""Where to look in the next frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.pose import Estimate
from chromadock.track.bank import Bank
from chromadock.track.memory import Memory
from chromadock.track.motion import POSE

Floats = NDArray[np.float64]

FULL_SEARCH_S = 0.5
"""While a dock is tracked the whole frame is searched this often: a wrong lock is left within four
seconds, and the search costs little on the average."""

INCOMPLETE_SEARCH_S = 0.25
"""Without a whole dock in sight one with a marker out is searched for this often: it costs as much
as a whole dock's search for each marker."""

MAX_PRIORS = 2
"""Poses about which a frame is searched: each costs time."""


@dataclass(frozen=True, eq=False, slots=True)
class Plan:
    """How to look at the next frame: see ``look.Look``."""

    priors: tuple[Estimate, ...] = ()
    everywhere: bool = True
    incomplete: bool = False
    R_expected: Floats | None = None
    R_covariance: Floats | None = None


def full_is_due(memory: Memory, time_s: float) -> bool:
    """Whether the whole frame of ``time_s`` is to be searched.

    Now and then; and as soon as the dock was not where it was expected, but not twice in a row,
    that one with a marker out is looked for in between.
    """
    locked = memory.kept(time_s)
    if locked is None:
        return True
    if memory.last_was_full:
        return False
    unsure = bool(memory.candidates) or locked.time_s > locked.measured_s
    return unsure or time_s - memory.last_full_s >= FULL_SEARCH_S


def incomplete_is_due(memory: Memory, time_s: float) -> bool:
    """Whether a search of the whole frame is to do with a marker out: now and then, and at every
    frame that may confirm what there is; not while the whole dock is in sight."""
    locked = memory.kept(time_s)
    if locked is not None and locked.whole:
        return False
    return bool(memory.candidates) or time_s - memory.last_incomplete_s >= INCOMPLETE_SEARCH_S


def priors(bank: Bank) -> tuple[Estimate, ...]:
    """The likeliest poses of a bank as a search wants them."""
    likeliest = sorted(bank.hypotheses, key=lambda h: -h.weight)[:MAX_PRIORS]
    return tuple(
        Estimate(
            h.state.R,
            h.state.t,
            0.0,
            0.0,
            np.asarray(np.linalg.inv(h.state.covariance[POSE, POSE]), np.float64),
        )
        for h in likeliest
    )
