"""When a constellation is the dock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.pose import Estimate

FALSE_ALARM_RATE = 0.003
"""Bound on the share of frames of Poisson clutter in which any set of peaks is taken for the
dock.  It is Markov's, and so loose by far; but real water is not quite Poisson.  What comes of
both on photographs is in docs/robust.md."""

LEAST_EVIDENCE = float(-np.log(FALSE_ALARM_RATE))

HOPEFUL = LEAST_EVIDENCE - float(np.log(1.5))
"""Evidence worth measuring for.  Exact places may add a factor of three, but to wait for that finds
no more docks, and measuring is the dearest step."""

# Of true docks one in a thousand has a larger reprojection error, in standard deviations:
# 3.09 of a normal distribution.
_REJECTED = 3.09


@dataclass(frozen=True, eq=False, slots=True)
class Constellation:
    """Markers that were taken for the dock's.

    ``markers`` (k,): which of the dock's; ``xy`` (k, 2) pixels; ``evidence``: natural log
    of the likelihood ratio; ``poses``: one or two, the better first.
    """

    markers: NDArray[np.intp]
    xy: NDArray[np.float64]
    evidence: float
    poses: tuple[Estimate, ...]


def rigid(pose: Estimate, markers: int) -> bool:
    """Whether so many places fit a pose as places of a rigid dock do."""
    freedom = 2 * markers - 6
    if not freedom:  # three places fit some pose exactly
        return True
    # Quantile of chi-square: Wilson and Hilferty, PNAS 17 (1931) 684.
    spread = 2 / (9 * freedom)
    return bool(pose.chi_square <= freedom * (1 - spread + _REJECTED * np.sqrt(spread)) ** 3)
