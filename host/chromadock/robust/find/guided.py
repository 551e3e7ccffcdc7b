"""Markers where a pose known beforehand expects them, of which one may be missing.

``host/native/guided.h`` says what the evidence is for those that are taken for them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock._native import ffi, lib
from chromadock.camera import CameraModel
from chromadock.geometry.pose import MIN_MARKERS, Estimate, projected
from chromadock.native import doubles
from chromadock.robust.weigh.evidence import PlacedPeaks

HIDDEN: float = lib.GUIDED_HIDDEN
"""How often a marker is out or behind something."""

SAME_PLACE_PX = 0.5
"""Pixels.  Two poses that have every marker within this of each other expect the same peaks: a
peak's own place is no better known."""

# Ways to choose the peaks: bounds the time.
_MAX_CHOICES = 64


@dataclass(frozen=True, slots=True)
class Guess:
    """``markers`` (k,) of the dock at ``members`` (k,) of the peaks, and the evidence.

    ``looks``: the part of the evidence that has nothing to do with where exactly they are, where
    no pose was expected; ``expected`` (k, 2): pixels, where they were expected, if they were.
    """

    markers: NDArray[np.intp]
    members: NDArray[np.intp]
    evidence: float
    looks: float | None = None
    expected: NDArray[np.float64] | None = None


class Expectation:
    """Where ``prior`` has the (n, 3) markers of a dock, metres, in a frame of the camera.

    ``along`` (n,): see ``evidence.placed_along``.  ``prior`` is the pose expected of this frame,
    with its information.
    """

    def __init__(
        self,
        points_dock: NDArray[np.float64],
        along: NDArray[np.float64],
        prior: Estimate,
        camera: CameraModel,
    ) -> None:
        seen = projected(points_dock, prior.R, prior.t, camera)
        self._places = None if seen is None else seen[0]
        if seen is None:
            return
        jacobian = seen[1].reshape(-1, 6)
        covariance = jacobian @ prior.covariance @ jacobian.T
        size = np.array([camera.width, camera.height])
        inside = ((seen[0] > 0) & (seen[0] < size - 1)).all(axis=1)
        numbers = map(doubles, (along, seen[0], covariance))
        # C's pointers keep nothing alive.
        self._kept = [*numbers, ffi.from_buffer("uint8_t[]", inside)]
        self._dock = ffi.new("guided_dock_t *", (len(along), MIN_MARKERS, *self._kept))

    def like(self, other: Expectation) -> bool:
        """Whether both have the markers at the same places."""
        if self._places is None or other._places is None:
            return self._places is other._places
        return bool(np.abs(self._places - other._places).max() < SAME_PLACE_PX)

    @property
    def spacing_px(self) -> float:
        """Pixels between the two markers that are closest to each other; 0 behind the camera."""
        if self._places is None:
            return 0.0
        apart = np.linalg.norm(self._places[:, None] - self._places, axis=2)
        np.fill_diagonal(apart, np.inf)
        return float(apart.min())

    def guess(self, placed: PlacedPeaks, sigma_px: float) -> Guess | None:
        """The best set of all markers, or of all but one, among peaks at pixels, which are known to
        ``sigma_px``."""
        if self._places is None:
            return None
        count = len(self._places)
        members = np.empty(count, np.int32)
        evidence = ffi.new("double *")
        if lib.guided_guess(
            self._dock,
            placed.native,
            sigma_px,
            max(1, int(_MAX_CHOICES ** (1 / count))),
            doubles(np.empty(4 * count**2)),
            ffi.from_buffer("int32_t[]", members),
            evidence,
        ):
            raise ValueError(f"{count} markers: too many options")
        if evidence[0] == -math.inf:
            return None
        markers = np.flatnonzero(members >= 0)
        taken = members[markers].astype(np.intp)
        return Guess(markers, taken, evidence[0], expected=self._places[markers])
