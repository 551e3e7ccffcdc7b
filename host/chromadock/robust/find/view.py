"""What one camera makes of one dock: prepared once, used for every frame."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.geometry.pose import MIN_MARKERS
from chromadock.robust.find.incomplete import Incomplete
from chromadock.robust.find.search import Search, SearchedPeaks
from chromadock.robust.frame.layout import finest_cell
from chromadock.robust.frame.peaks import Peaks
from chromadock.robust.weigh.evidence import evidence_of_sets, placed_along
from chromadock.robust.weigh.placement import PosePrior
from chromadock.robust.weigh.shape import (
    ATTITUDE_RAD,
    FINEST_SPACING_CELLS,
    MIN_SPACING_CELLS,
    ShapeModel,
    focal_px,
    ideal,
)

PEAK_ERROR = 0.25
"""Error of a peak's place, in cells."""

MAX_TRIALS = 6
"""Likely candidates of a frame that are measured, beside one that is not likely: bounds the time.
The true one is almost always the first; some of the others are the same dock with one marker
mistaken, and its image."""

LOG_RANGES = float(np.log(20.0))
"""A dock may be met from where it fills the picture to twenty times as far."""


@dataclass(frozen=True, eq=False, slots=True)
class Candidate:
    """``members`` (n,) of the peaks at one scale that were searched, one for each marker; ``looks``
    and ``evidence``: see ``search.Candidates``."""

    cell: int
    among: SearchedPeaks
    members: NDArray[np.intp]
    looks: float
    evidence: float

    @property
    def peaks(self) -> Peaks:
        """All peaks of the scale."""
        return self.among.peaks

    @property
    def xy(self) -> NDArray[np.float64]:
        """(n, 2) pixels."""
        return self.peaks.xy[self.members]

    def looks_without(self, marker: int, along: NDArray[np.float64]) -> float:
        """``looks`` of the others than one marker, which are (n,) ``along`` the dock."""
        others = np.delete(np.arange(len(along)), marker)
        sets = self.members[None, others]
        return float(evidence_of_sets(self.among, sets, along[others])[0])


class View:
    """One camera and one dock of (n, 3) markers."""

    def __init__(self, points: NDArray[np.float64], camera: CameraModel) -> None:
        self.points = points
        self.camera = camera
        self.focal_px = focal_px(camera)
        self.along = placed_along(points)
        self.model = ShapeModel.learn(points, camera)
        corners = ideal(np.array([(0, 0), (camera.width - 1.0, camera.height - 1.0)]), camera)
        across = corners[1] - corners[0]
        self.area = float(abs(across.real * across.imag))
        self._usual_prior = self.prior(np.eye(3), np.diag(ATTITUDE_RAD**2))
        self._searches: dict[int, Search] = {}

    @cached_property
    def incomplete(self) -> Incomplete:
        """The search for all markers but one: learnt when it is first needed."""
        return Incomplete(self.points, self.camera)

    def is_of(self, camera: CameraModel) -> bool:
        """Whether this camera's geometry is the same."""
        return self.camera is camera or self.camera.key == camera.key

    def prior(
        self,
        R_expected: NDArray[np.float64] | None,
        R_covariance: NDArray[np.float64] | None,
    ) -> PosePrior:
        """What is known of the dock's pose: its attitude as told, or that of an upright camera on
        its way in."""
        if R_expected is None or R_covariance is None:
            return self._usual_prior
        return PosePrior(self.focal_px, self.area, LOG_RANGES, R_expected, R_covariance)

    def searched(self, peaks: dict[int, Peaks], upright: complex) -> dict[int, SearchedPeaks]:
        """The peaks of a frame at ideal places, by cell; of scales with enough for a dock.

        ``upright``: a unit complex number that turns the picture to where the dock stands upright.
        """
        return {
            cell: SearchedPeaks(ideal(found.xy, self.camera) * upright, found, self.area)
            for cell, found in peaks.items()
            if len(found.promising) >= MIN_MARKERS
        }

    def candidates(self, cell: int, among: SearchedPeaks, least: float) -> list[Candidate]:
        """What may be the dock among the peaks of one scale, with an evidence of ``least`` or more,
        the best first."""
        if len(among.peaks.promising) < len(self.points):
            return []
        if cell not in self._searches:
            finest = cell == finest_cell(self.camera.width, self.camera.height)
            apart_px = cell * (FINEST_SPACING_CELLS if finest else MIN_SPACING_CELLS)
            self._searches[cell] = Search(self.model, PEAK_ERROR * cell, apart_px)
        found = self._searches[cell].find(among, least)
        if not len(found.evidence):
            return []
        best = zip(found.members, found.looks.tolist(), found.evidence.tolist(), strict=True)
        return [
            Candidate(cell, among, members, looks, evidence)
            for members, looks, evidence in islice(best, MAX_TRIALS)
        ]

    def log_shape(
        self, xy: NDArray[np.float64], sigma: NDArray[np.float64], upright: complex
    ) -> NDArray[np.float64]:
        """(N,) log density of places (N, n, 2), known to (N, n), as shapes of the dock."""
        order = list(self.model.order)
        z = ideal(xy.reshape(-1, 2), self.camera).reshape(sigma.shape)[:, order] * upright
        base = self.model.log_base(z[:, 1] - z[:, 0])
        return np.asarray(base + self.model.log_shape(z, sigma[:, order]))


def upright(R_expected: NDArray[np.float64] | None) -> complex:
    """A unit complex number that turns pixels x + iy to where a dock of attitude ``R_camera_dock``
    (3, 3) stands upright: the inverse of its roll about the line of sight."""
    if R_expected is None:
        return 1.0 + 0.0j
    right, down = R_expected[:2, 0], R_expected[:2, 1]
    # The turn nearest to both axes as the camera sees them.
    turn = complex(right[0] + down[1], right[1] - down[0])
    return turn.conjugate() / abs(turn) if abs(turn) > 0 else 1.0 + 0.0j
