"""Constellations among peaks, ranked by the evidence that they are the dock.

``host/native/search.h`` says what that evidence is, and what of false alarms it bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock._native import ffi, lib
from chromadock.native import doubles
from chromadock.robust.frame.peaks import Peaks
from chromadock.robust.weigh.evidence import PlacedPeaks, room
from chromadock.robust.weigh.shape import FACETS, Complex, Real, ShapeModel, Window

MAX_SETS = 64
"""Sets that are kept: more than anyone looks at."""

MAX_WEIGHED = 4000
"""Sets, complete or not, that are weighed: bounds the time.  Few frames have half as many."""

# Chi-square with two degrees of freedom, which a marker stays below.  One true marker in 8000 would
# exceed 18 if shapes were normal, but those of a dock near by and turned far have a longer tail.
# Of many markers so many sets pass the wider gate that the search gives up before it is through.
_NEAR_OF_FEW, _NEAR_OF_MANY = 40.0, 18.0
_FEW = 5

_BOUNDS_SIZE = lib.search_bounds_size()


def gate(markers: int) -> float:
    """The chi-square that each of a dock's markers is below."""
    return _NEAR_OF_FEW if markers <= _FEW else _NEAR_OF_MANY


@dataclass(frozen=True, slots=True)
class Candidates:
    """``members`` (M, n): a peak for each marker; ``evidence`` (M,), best first.

    ``looks`` (M,): the part of the evidence that has nothing to do with where exactly they are.
    ``weighed``: how many sets were, complete or not; at MAX_WEIGHED the search gave up.
    """

    members: NDArray[np.intp]
    evidence: Real
    looks: Real
    weighed: int


class SearchedPeaks(PlacedPeaks):
    """What every search among the peaks of one scale takes from them, computed once.

    See ``PlacedPeaks``; markers are looked for among the ``promising``, all peaks are clutter.
    """

    def __init__(self, z: Complex | Real, peaks: Peaks, area: float) -> None:
        super().__init__(z, peaks, area)
        # By the number of markers: as C has them, and the memory that they are in.
        self._bounds: dict[int, tuple[Any, Any]] = {}

    def bounds(self, markers: int) -> Any:
        """What a search for a dock of so many markers is bounded by, as C has it.

        Raises
        ------
        ValueError
            More promising peaks than C has room for.
        """
        if markers not in self._bounds:
            memory = room(_BOUNDS_SIZE)
            bounds = ffi.cast("search_bounds_t *", memory)
            promising = np.ascontiguousarray(self.peaks.promising, np.int32)
            if lib.search_prepare(
                bounds,
                self.native,
                markers,
                len(promising),
                ffi.from_buffer("int32_t[]", promising),
            ):
                raise ValueError(f"{len(promising)} promising peaks: too many")
            self._bounds[markers] = bounds, memory
        return self._bounds[markers][0]


class Search:
    """Finds one dock in peaks located to ``sigma_px``, whose closest markers are ``apart_px`` or
    more from each other."""

    def __init__(self, model: ShapeModel, sigma_px: float, apart_px: float = 0.0) -> None:
        self._by_marker = np.argsort(model.order)
        bounds = np.concatenate([[model.base.shortest], model.edges, [model.base.longest]])
        spans, size = len(bounds) - 1, model.mean.shape[1]
        # The errors of the base's ends add half of the marker's own.
        noise = 1.5 * sigma_px**2 / (bounds[:-1] * bounds[1:]).repeat(FACETS)
        covariance = model.covariance + noise[:, None, None] * np.eye(size)
        whiten = np.tril(np.linalg.inv(np.linalg.cholesky(covariance)))
        peak = np.log(np.diagonal(whiten, axis1=1, axis2=2) / np.sqrt(2 * np.pi)).sum(axis=1)
        norm = model.log_share + peak
        near = gate(len(model.order))
        reach = np.sqrt(near * np.diagonal(covariance, axis1=1, axis2=2)[:, :2])
        low = (model.mean[:, :2] - reach).reshape(spans, FACETS, 2).min(axis=1)
        high = (model.mean[:, :2] + reach).reshape(spans, FACETS, 2).max(axis=1)
        offset = -(whiten @ model.mean[..., None])[..., 0]
        of_third = [norm, *offset.T[:2], whiten[:, 0, 0], whiten[:, 1, 0], whiten[:, 1, 1]]
        thirds = np.zeros((spans, len(of_third), lib.SEARCH_MAX_FACETS))
        thirds[:, 0] = -np.inf
        thirds[:, :, :FACETS] = np.reshape(of_third, (-1, spans, FACETS)).transpose(1, 0, 2)
        turns = model.roll_rad * np.sqrt(2 * np.pi)
        # C's pointers keep nothing alive.
        self._kept = [
            doubles(model.along),
            doubles(model.edges),
            doubles(norm.reshape(spans, FACETS).max(axis=1)),
            doubles(offset),
            doubles(whiten),
            ffi.from_buffer("search_box_t[]", np.stack([low, high], axis=2)),
            ffi.from_buffer("search_third_t[]", thirds),
        ]
        side = model.side.beyond(apart_px)
        self._dock = ffi.new(
            "search_dock_t *",
            (
                len(model.order),
                spans,
                FACETS,
                _native(model.base),
                _native(side),
                2 * sigma_px,
                model.roll_rad,
                np.log(np.log(model.base.longest / model.base.shortest) * turns),
                near,
                *self._kept,
            ),
        )

    def find(self, peaks: SearchedPeaks, least: float) -> Candidates:
        """Sets of peaks at ideal pixels with an evidence of ``least`` or more.

        Raises
        ------
        ValueError
            More promising peaks than C has room for.
        """
        markers = len(self._by_marker)
        members = np.empty((MAX_SETS, markers), np.int32)
        evidence, looks = np.empty((2, MAX_SETS))
        weighed = ffi.new("int32_t *")
        count = lib.search_find(
            self._dock,
            peaks.bounds(markers),
            least,
            MAX_SETS,
            MAX_WEIGHED,
            ffi.from_buffer("int32_t[]", members),
            doubles(evidence),
            doubles(looks),
            weighed,
        )
        if not count:
            return Candidates(np.empty((0, markers), np.intp), evidence[:0], looks[:0], weighed[0])
        ordered = members[:count, self._by_marker].astype(np.intp)
        return Candidates(ordered, evidence[:count], looks[:count], weighed[0])


def _native(window: Window) -> Any:
    """A window as C has it."""
    x, y = window.direction.real, window.direction.imag
    return window.shortest, window.longest, x, y, float(np.tan(window.half_angle))
