"""Of candidates that share a place the one with most evidence is the dock."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

from chromadock.robust.find.measure import Measure
from chromadock.robust.find.search import SearchedPeaks
from chromadock.robust.find.view import Candidate
from chromadock.robust.frame.peaks import Peaks
from chromadock.robust.weigh.acceptance import Constellation

NOTHING = cast(Any, None)
DECADE = float(np.log(10))
PLACES = np.array([(100, 100), (300, 100), (100, 140), (300, 140), (320, 170)], np.float64)
EXACT, MEASURED = {3: 11.0, 4: 7.0}, list[int]()
MISTAKEN, RIGHT = np.array([0, 1, 2, 4]), np.array([0, 1, 2, 3])


class Exact(Measure):
    """Evidence is EXACT decades by a candidate's last place, which is noted in MEASURED."""

    def _accepted(self, candidate: Candidate) -> Constellation | None:
        MEASURED.append(int(candidate.members[-1]))
        evidence = EXACT[MEASURED[-1]] * DECADE
        return Constellation(candidate.members, candidate.xy, np.ones(4), evidence, (NOTHING,))


def best_of(*candidates: Candidate) -> tuple[Constellation | None, list[int]]:
    MEASURED.clear()
    view = cast(Any, type("V", (), {"camera": None}))
    best = Exact(NOTHING, NOTHING, view, NOTHING, 1 + 0j, np.inf, np.zeros(3)).best(
        list(candidates)
    )
    return best, list(MEASURED)


def candidate(members: np.ndarray, decades: float, cell: int = 4) -> Candidate:
    flat, count = np.zeros((len(PLACES), 2)), len(PLACES)
    rest = (np.ones(count), np.ones(count), flat, np.ones(count))
    peaks = Peaks(PLACES, *rest, np.arange(count), np.ones(count))
    among = SearchedPeaks(PLACES, peaks, 640 * 480)
    return Candidate(cell, among, members, 0.0, decades * DECADE)


@pytest.mark.parametrize("order", [1, -1])
def test_a_set_with_one_marker_mistaken_does_not_hide_the_right_one(order: int) -> None:
    """The search knows places to a quarter of a cell: it may rank the wrong one first."""
    best, _ = best_of(*[candidate(MISTAKEN, 8.5), candidate(RIGHT, 8.0)][::order])
    assert best is not None
    assert best.markers.tolist() == RIGHT.tolist()


def test_the_same_set_in_other_cells_is_not_measured_again() -> None:
    _, measured = best_of(candidate(RIGHT, 8.5), candidate(RIGHT, 8.0, cell=8))
    assert measured == [3]


def test_what_cannot_have_as_much_evidence_is_not_measured() -> None:
    _, measured = best_of(candidate(RIGHT, 8.5), candidate(MISTAKEN, 6.0))
    assert measured == [3]
