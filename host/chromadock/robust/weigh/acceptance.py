"""When a constellation is the dock."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.pose import Estimate
from chromadock.results.detection import Misfit

FALSE_ALARM_RATE = 10**-5.5
"""Bound on the share of frames of Poisson clutter in which any set of peaks is taken for the
dock.  It is Markov's, and so loose by far; but real water is not quite Poisson, and what is false
all the same has mostly less than this.  What comes of both on photographs is in docs/robust.md."""

LEAST_EVIDENCE = float(-np.log(FALSE_ALARM_RATE))

LEAST_FOR_A_TRACK = float(3 * np.log(10))
"""Of markers that a track looks for, where it has the dock or with one of them out: no pose of a
frame by itself is told with so little, and a lock takes more from several frames."""

LIKELY = LEAST_EVIDENCE - float(np.log(1.5))
"""Evidence, before places are exact, of what is likely to have enough with them; measuring is the
dearest step."""

GAIN_OF_EXACT = float(3 * np.log(10))
"""What exact places may add to the search's evidence, which knows places to a quarter of a cell and
shapes by a normal distribution: most to a near dock that is turned far."""

HOPEFUL = LEAST_EVIDENCE - GAIN_OF_EXACT
"""The same of the best that is not likely, which is measured where no likely one is the dock."""

MORE_OF_DARK = float(np.log(10))
"""Evidence that dark holders must have beside what lamps must: they are a second chance for clutter
in each frame, and are weighed by the looks of lamps.  On 1,800 drawn scenes of the half that was
developed on 24 right docks are found so beside the others and 1 wrong one, without it 27 and 3."""

HOPEFUL_DARK = float(6 * np.log(10))
"""The same among what is dark, which is looked at in each frame that shows no lamps and must be
quick: with four decades 1 dock more of 1,800 scenes is found, and the photograph that costs most
takes half as long again."""

PLACE_TOLERANCE = 0.05
"""Of the range: a pose whose place is farther off is wrong."""

MOST_DOUBT = 0.1
"""Probability that a pose is wrong, beyond which it is not told."""

NO_DOUBT = 0.02
"""Probability, by the normal errors of its poses, below which that is good enough to go by."""


@dataclass(frozen=True, eq=False, slots=True)
class Constellation:
    """Markers that were taken for the dock's.

    ``markers`` (k,): which of the dock's; ``xy`` (k, 2) pixels; ``sigma_px`` (k,): their standard
    deviations; ``evidence``: natural log of the likelihood ratio; ``poses``: one or two, the
    better first; ``doubt``: see there; ``misfit``: where they stand like a dock, but not rigidly;
    ``smaller``: see ``look.Found``.
    """

    markers: NDArray[np.intp]
    xy: NDArray[np.float64]
    sigma_px: NDArray[np.float64]
    evidence: float
    poses: tuple[Estimate, ...]
    doubt: float = 0.0
    misfit: Misfit | None = None
    smaller: float = 0.0


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

    Each pose, by its weight, puts the dock at its own range, known to a normal error.
    """
    t = np.array([pose.t for pose in poses])
    sight = t / np.linalg.norm(t, axis=1, keepdims=True)
    place = np.array([pose.covariance[:3, :3] for pose in poses])
    sigma = np.sqrt(np.maximum(np.einsum("mi,mij,mj->m", sight, place, sight), 1e-18))
    return share_beyond(t[0], t, sigma, np.asarray(weights))


def doubt_of_size(smaller: float) -> float:
    """Probability that the dock's range is off by more than PLACE_TOLERANCE if its size is off by a
    normal error of which ``smaller``, a share, is one standard deviation."""
    return math.erfc(PLACE_TOLERANCE / max(math.sqrt(2) * smaller, 1e-9))


def share_beyond(
    told: NDArray[np.float64],
    t: NDArray[np.float64],
    sigma: NDArray[np.float64],
    weights: NDArray[np.float64],
) -> float:
    """Of poses at (M, 3), with ranges known to (M,) and (M,) weights that sum to 1: the share
    that is elsewhere than within PLACE_TOLERANCE of ``told`` (3,)."""
    tolerance = PLACE_TOLERANCE * float(np.linalg.norm(told))
    off = np.linalg.norm(t - told, axis=1)
    within = _normal((tolerance - off) / sigma) - _normal((-tolerance - off) / sigma)
    return float(weights @ (1 - within))


def _normal(z: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of a normal distribution below (M,) standard deviations."""
    return 0.5 + 0.5 * np.array([math.erf(each) for each in (z / math.sqrt(2)).tolist()])
