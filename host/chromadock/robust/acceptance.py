"""When a constellation is the dock."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.pose import Estimate

FALSE_ALARM_RATE = 10**-4.5
"""Bound on the share of frames of Poisson clutter in which any set of peaks is taken for the
dock.  It is Markov's, and so loose by far; but real water is not quite Poisson.  What comes of
both on photographs is in docs/robust.md."""

LEAST_EVIDENCE = float(-np.log(FALSE_ALARM_RATE))

LEAST_FOR_A_TRACK = float(2.5 * np.log(10))
"""Of markers that a track looks for, where it has the dock or with one of them out: no pose of a
frame by itself is told with so little, and a lock takes more from several frames."""

HOPEFUL = LEAST_EVIDENCE - float(np.log(1.5))
"""Evidence worth measuring for.  Exact places may add a factor of three, but to wait for that finds
no more docks, and measuring is the dearest step."""

PLACE_TOLERANCE = 0.05
"""Of the range: a pose whose place is farther off is wrong."""

MOST_DOUBT = 0.15
"""Probability that a pose is wrong, beyond which it is not told."""


@dataclass(frozen=True, eq=False, slots=True)
class Constellation:
    """Markers that were taken for the dock's.

    ``markers`` (k,): which of the dock's; ``xy`` (k, 2) pixels; ``evidence``: natural log
    of the likelihood ratio; ``poses``: one or two, the better first; ``doubt``: see there.
    """

    markers: NDArray[np.intp]
    xy: NDArray[np.float64]
    evidence: float
    poses: tuple[Estimate, ...]
    doubt: float = 0.0


class Placed(Protocol):
    """What has a place and says how well it is known."""

    @property
    def t(self) -> NDArray[np.float64]:
        """(3,) metres, in the camera frame."""

    @property
    def covariance(self) -> NDArray[np.float64]:
        """(N, N), N at least 3: first of the place, metres squared."""


def doubt(poses: Sequence[Placed], weights: Sequence[float]) -> float:
    """Probability that the dock is not where the first of its poses has it.

    Each pose, by its weight, puts the dock at its own range, known to a normal error; elsewhere
    than within PLACE_TOLERANCE of the first one's place that is wrong.
    """
    told = poses[0].t
    tolerance = PLACE_TOLERANCE * float(np.linalg.norm(told))
    wrong = 0.0
    for pose, weight in zip(poses, weights, strict=True):
        sight = pose.t / np.linalg.norm(pose.t)
        sigma = math.sqrt(max(float(sight @ pose.covariance[:3, :3] @ sight), 1e-18))
        off = float(np.linalg.norm(pose.t - told))
        within = _normal((tolerance - off) / sigma) - _normal((-tolerance - off) / sigma)
        wrong += weight * (1 - within)
    return wrong


def _normal(z: float) -> float:
    """Share of a normal distribution below z standard deviations."""
    return 0.5 * math.erfc(-z / math.sqrt(2))
