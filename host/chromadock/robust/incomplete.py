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
from chromadock.robust.guided import HIDDEN, MIN_MARKERS, Guess
from chromadock.robust.peaks import Peaks
from chromadock.robust.search import Search
from chromadock.robust.shape import ShapeModel, ideal

AMBIGUOUS = float(np.log(2))
"""A name for the places must be so much likelier than any other: three markers with the fourth
above one of them look like three with it below, turned a little.  Where that does not tell,
nothing is found; the dock or the vehicle sways, and another frame will tell."""


@dataclass(frozen=True, eq=False, slots=True)
class _Part:
    """``markers`` (n - 1,) of the dock, and their shape."""

    markers: NDArray[np.intp]
    model: ShapeModel


class Incomplete:
    """Searches for (n, 3) markers but one; ``area`` of the frame in square ideal pixels."""

    def __init__(self, points: NDArray[np.float64], camera: CameraModel, area: float) -> None:
        self._camera, self._area = camera, area
        count = len(points)
        self._parts: list[_Part] = []
        if count > MIN_MARKERS:
            for left_out in range(count):
                markers = np.delete(np.arange(count), left_out)
                self._parts.append(_Part(markers, ShapeModel.learn(points[markers], camera)))
        self._searches: dict[int, list[Search]] = {}

    def find(
        self, cell: int, peaks: Peaks, sigma_px: float, least: float, upright: complex
    ) -> Guess | None:
        """The best set at one scale, if its evidence is ``least`` or more and not AMBIGUOUS.

        ``upright``: see ``view.View.candidates``.
        """
        if not self._parts or len(peaks.snr) < len(self._parts) - 1:
            return None
        if cell not in self._searches:
            self._searches[cell] = [Search(p.model, sigma_px, self._area) for p in self._parts]
        rarely = float(np.log(HIDDEN / len(self._parts)))
        places = ideal(peaks.xy, self._camera) * upright
        guesses: list[Guess] = []
        for part, search in zip(self._parts, self._searches[cell], strict=True):
            found = search.find(places, peaks, least - rarely - AMBIGUOUS)
            for members, evidence in zip(found.members, found.evidence.tolist(), strict=True):
                guesses.append(Guess(part.markers, members, evidence + rarely))
        best = max(guesses, key=lambda guess: guess.evidence, default=None)
        if best is None or best.evidence < least:
            return None
        rivals = [g for g in guesses if g is not best and _shared(g, best) >= MIN_MARKERS - 1]
        if any(g.evidence > best.evidence - AMBIGUOUS for g in rivals):
            return None
        return best


def _shared(a: Guess, b: Guess) -> int:
    """How many places two guesses have both, by another name or not."""
    return len(np.intersect1d(a.members, b.members))
