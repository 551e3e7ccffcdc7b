"""The dock with one marker out, where no pose is expected.

Each way to leave a marker out is a dock of its own, searched for as the whole one is; that it
happens, and to which marker, has its probability in the evidence, so the bound on false alarms
holds as it does for whole docks.  Three markers say less than four: near the bound at best.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.geometry.pose import MIN_MARKERS
from chromadock.robust.find.guided import HIDDEN, Guess
from chromadock.robust.find.search import Search, SearchedPeaks
from chromadock.robust.frame.peaks import Peaks
from chromadock.robust.weigh.shape import ShapeModel, focal_px

AMBIGUOUS = float(np.log(2))
"""A name for the places must be so much likelier than any other: three markers with the fourth
above one of them look like three with it below, turned a little.  Where that does not tell,
nothing is found; the dock or the vehicle sways, and another frame will tell."""

SAME_PLACE = 0.03
"""Unless both names put the dock at the same place, to so much of its range: then the track
has time to find out which is right."""


@dataclass(frozen=True, eq=False, slots=True)
class _Part:
    """``markers`` (n - 1,) of the dock, and their shape."""

    markers: NDArray[np.intp]
    model: ShapeModel


class Incomplete:
    """Searches for (n, 3) markers but one."""

    def __init__(self, points: NDArray[np.float64], camera: CameraModel) -> None:
        self._points, self._focal_px = points - points.mean(axis=0), focal_px(camera)
        count = len(points)
        self._parts: list[_Part] = []
        if count > MIN_MARKERS:
            for left_out in range(count):
                markers = np.delete(np.arange(count), left_out)
                self._parts.append(_Part(markers, ShapeModel.learn(points[markers], camera)))
        self._searches: dict[int, list[Search]] = {}

    def find(self, cell: int, among: SearchedPeaks, sigma_px: float, least: float) -> Guess | None:
        """The best set at one scale, if its evidence is ``least`` or more and not AMBIGUOUS."""
        peaks = among.peaks
        if not self._parts or len(peaks.promising) < len(self._parts) - 1:
            return None
        if cell not in self._searches:
            self._searches[cell] = [Search(p.model, sigma_px) for p in self._parts]
        rarely = float(np.log(HIDDEN / len(self._parts)))
        guesses: list[Guess] = []
        for part, search in zip(self._parts, self._searches[cell], strict=True):
            found = search.find(among, least - rarely - AMBIGUOUS)
            each = zip(found.members, found.evidence.tolist(), found.looks.tolist(), strict=True)
            for members, evidence, looks in each:
                guesses.append(Guess(part.markers, members, evidence + rarely, looks + rarely))
        best = max(guesses, key=lambda guess: guess.evidence, default=None)
        if best is None or best.evidence < least:
            return None
        place = self._centre(best, peaks)
        for rival in guesses:
            close = rival.evidence > best.evidence - AMBIGUOUS
            if rival is not best and close and _shared(rival, best) >= MIN_MARKERS - 1:
                apart = np.linalg.norm(self._centre(rival, peaks) - place)
                if apart > SAME_PLACE * self._focal_px:
                    return None
        return best

    def _centre(self, guess: Guess, peaks: Peaks) -> NDArray[np.float64]:
        """(2,) pixels of the whole dock's centroid, by an affine view of the markers seen."""
        design = np.column_stack([self._points, np.ones(len(self._points))])
        view, *_ = np.linalg.lstsq(design[guess.markers], peaks.xy[guess.members], rcond=None)
        return np.asarray(view[-1])


def _shared(a: Guess, b: Guess) -> int:
    """How many places two guesses have both, by another name or not."""
    return len(np.intersect1d(a.members, b.members))
