"""What the brightness of markers says of their pose."""

from __future__ import annotations

import numpy as np
import pytest

from chromadock import DockGeometry
from chromadock.geometry.many import rotations
from chromadock.robust.frame.flux import Fluxes
from chromadock.robust.weigh.nearness import log_nearness

POINTS = DockGeometry.default().points
NOISE = np.full(4, 0.02)
T = np.tile([0.1, 0.05, 1.5], (2, 1))
LEFT_OR_RIGHT = rotations(np.radians([(0.0, 25.0, 0.0), (0.0, -25.0, 0.0)]))


def arriving(R: np.ndarray, t: np.ndarray, exponent: float, water: float) -> np.ndarray:
    """(4,) log flux of equal lamps whose light falls by that power of the range, and by the water's
    attenuation, 1/m."""
    range_m = np.linalg.norm(POINTS @ R.T + t, axis=1)
    return np.asarray(-exponent * np.log(range_m) - water * range_m)


@pytest.mark.parametrize("exponent", [1.5, 2.0, 3.0])
@pytest.mark.parametrize("water", [0.1, 1.0])
def test_which_side_is_nearer_is_told(exponent: float, water: float) -> None:
    seen = Fluxes(arriving(LEFT_OR_RIGHT[0], T[0], exponent, water), NOISE)
    right, wrong = log_nearness(seen, POINTS, LEFT_OR_RIGHT, T)
    assert right > wrong + 2


def test_how_bright_all_of_them_are_says_nothing() -> None:
    log = arriving(LEFT_OR_RIGHT[0], T[0], 2.0, 0.3)
    dim, bright = Fluxes(log - 3.0, NOISE), Fluxes(log + 3.0, NOISE)
    first = log_nearness(dim, POINTS, LEFT_OR_RIGHT, T)
    assert first == pytest.approx(log_nearness(bright, POINTS, LEFT_OR_RIGHT, T))


def test_unknown_brightness_says_nothing() -> None:
    assert log_nearness(None, POINTS, LEFT_OR_RIGHT, T).tolist() == [0.0, 0.0]
    unsure = Fluxes(arriving(LEFT_OR_RIGHT[0], T[0], 2.0, 0.3), np.full(4, 50.0))
    assert np.ptp(log_nearness(unsure, POINTS, LEFT_OR_RIGHT, T)) < 0.01


def test_one_lamp_that_is_soiled_does_not_decide() -> None:
    """By itself it would speak for the wrong side by thirty decades."""
    log = arriving(LEFT_OR_RIGHT[0], T[0], 2.0, 0.3)
    for soiled in range(4):
        seen = log.copy()
        seen[soiled] -= 3.0
        right, wrong = log_nearness(Fluxes(seen, NOISE), POINTS, LEFT_OR_RIGHT, T)
        assert wrong - right < 2.5


def test_of_unlike_lamps_as_many_are_taken_wrong_as_the_odds_say() -> None:
    """Docks turned to either side as likely, lamps unlike by what is supposed of them."""
    rng, odds, wrong = np.random.default_rng(3), [], []
    for _ in range(2000):
        range_m = rng.uniform(0.7, 3.0)
        turn = np.array([0.0, rng.uniform(0, 40), 0.0])
        R = rotations(np.radians([turn, -turn]))
        t = np.tile([0.0, 0.0, range_m], (2, 1))
        unlike = 0.25 * rng.standard_normal(4) / np.sqrt(rng.chisquare(3) / 3)
        seen = Fluxes(arriving(R[0], t[0], rng.normal(2.0, 0.7), 0.0) + unlike, NOISE)
        right, other = log_nearness(seen, POINTS, R, t)
        odds.append(1 / (1 + np.exp(abs(right - other))))
        wrong.append(other > right)
    spread = np.sqrt(sum(p * (1 - p) for p in odds))
    assert abs(sum(wrong) - sum(odds)) < 5 * spread
    assert np.mean(wrong) < 0.2
