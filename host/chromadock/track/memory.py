"""All that a tracker knows after a frame."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.results.track import Track
from chromadock.track.bank import Bank
from chromadock.track.candidate import Candidate
from chromadock.track.manoeuvre import SELDOM, later
from chromadock.track.states import KEPT_S, MOST_DOUBT_UNSEEN, state_of
from chromadock.track.telemetry import UNHEARD, Telemetry
from chromadock.track.told import following

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Locked:
    """``bank`` at ``time_s``; ``measured_s``: when the dock was last seen, ``whole`` or not, with
    ``evidence`` in decades; ``sure``: whether its place was known well enough then to tell a pose.

    ``swift`` 0..1: probability that the vehicle manoeuvres.
    """

    bank: Bank
    time_s: float
    measured_s: float
    whole: bool
    evidence: float
    sure: bool
    swift: float = SELDOM

    def after(self, elapsed_s: float) -> Bank:
        """The bank ``elapsed_s`` after ``time_s``, nothing seen meanwhile."""
        return self.bank.after(elapsed_s, later(self.swift, elapsed_s))


@dataclass(frozen=True, eq=False, slots=True)
class Memory:
    """Never changed, only replaced by that of the next frame: who has one, in whatever thread, has
    one moment and not a mixture of two.

    ``time_s``: of the newest frame; None before the first.  ``last_...``: of the last frame that
    saw the locked dock, was searched whole, was searched for a dock with a marker out;
    ``last_markers``: of the last frame that showed some.  ``telemetry``: what the attitudes come
    to; ``faced_s``: when the dock's expected attitude was last taken in.
    """

    time_s: float | None = None
    locked: Locked | None = None
    candidates: tuple[Candidate, ...] = ()
    last_seen_s: float | None = None
    last_full_s: float = -math.inf
    last_was_full: bool = False
    last_incomplete_s: float = -math.inf
    last_markers: dict[str, tuple[float, float]] | None = None
    telemetry: Telemetry = UNHEARD
    faced_s: float = -math.inf

    def kept(self, time_s: float) -> Locked | None:
        """The locked dock, unless it was last measured too long before."""
        locked = self.locked
        return None if locked is None or time_s - locked.measured_s > KEPT_S else locked

    def track(self, time_s: float, origin: Floats, judged: Floats) -> Track:
        """Run on to ``time_s``, or that of the newest frame if it is before; of a dock frame with
        its origin at ``origin`` (3,) of the bank's, and sure or not by the place of ``judged``
        (3,), in the bank's frame too: see ``DockGeometry.judged``."""
        time_s = max(time_s, -math.inf if self.time_s is None else self.time_s)
        seen, locked = self.last_seen_s, self.locked
        age_s = None if seen is None else time_s - seen
        state = state_of(
            None if locked is None else time_s - locked.measured_s,
            any(not c.given_up(time_s) for c in self.candidates),
            seen is not None,
        )
        if locked is None or state not in ("tracking", "recently_lost"):
            return Track(state, time_s, age_s=age_s)
        bank = locked.after(time_s - locked.time_s)
        rivalled = any(
            c.rivals(locked.evidence) and not c.given_up(time_s) for c in self.candidates
        )
        if not locked.sure or rivalled or bank.about(judged).doubt > MOST_DOUBT_UNSEEN:
            return Track("acquiring" if state == "tracking" else state, time_s, age_s=age_s)
        hypotheses = bank.about(origin).hypotheses
        return following(state, time_s, hypotheses, time_s - locked.measured_s)
