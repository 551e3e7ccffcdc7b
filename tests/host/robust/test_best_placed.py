"""Of one dock found in cells of several sizes the best known places are taken."""

from __future__ import annotations

import numpy as np

from chromadock.robust.find.measure import _best_placed
from chromadock.robust.weigh.acceptance import Constellation

XY = np.array([(100.0, 100.0), (200.0, 100.0), (150.0, 180.0)])


def dock(xy: np.ndarray, sigma_px: float, evidence: float) -> Constellation:
    return Constellation(np.arange(3), xy, np.full(3, sigma_px), evidence, ())


def test_lamps_are_preferred_to_the_corners_of_the_bars_that_they_stand_on() -> None:
    corners, lamps = dock(XY + 9, 1.5, 30.0), dock(XY, 0.2, 20.0)
    elsewhere = dock(XY + 60, 0.1, 25.0)
    assert _best_placed(corners, 16, [lamps, elsewhere]) is lamps


def test_of_two_docks_the_likelier_stays() -> None:
    likely, other = dock(XY, 1.5, 30.0), dock(XY + np.array([0.0, 12.0]), 0.2, 20.0)
    assert _best_placed(likely, 4, [other]) is likely
