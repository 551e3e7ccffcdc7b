"""How far bars draw lamps aside, in pictures of lamps at the ends of bars."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock.robust.frame.bars import FOLLOWED, lean_by_bars, smaller
from chromadock.robust.frame.refine import Tops, leaning, refined
from chromadock.robust.frame.response import respond

PLACES = np.array([(60.3, 60.7), (160.6, 64.2), (92.1, 118.4)])
WATER, RED = np.array([0.4, 0.3, 0.02]), np.array([0.02, 0.04, 0.4])
WHITE = np.array([0.02, 0.02, 0.12])
FINE = 8  # steps to a pixel that bars are drawn in


def picture(bars: np.ndarray | None, post: bool = False, seed: int = 1) -> np.ndarray:
    """Lamps with bars between them that add so much linear BGR to the water; a post as bright as
    a lamp that crosses one."""
    y, x = np.mgrid[0:180, 0:220].astype(float)
    light = np.tile(WATER, (180, 220, 1))
    if bars is not None:
        drawn = np.zeros((180 * FINE, 220 * FINE), np.uint8)
        ends = np.rint((PLACES + 0.5) * FINE).astype(int).tolist()
        for start, end in ((0, 1), (1, 2), (2, 0)):
            cv2.line(drawn, tuple(ends[start]), tuple(ends[end]), 255, 4 * FINE)
        share = cv2.resize(drawn, (220, 180), interpolation=cv2.INTER_AREA) / 255
        light += cv2.GaussianBlur(share, (0, 0), 0.8)[..., None] * bars
    if post:
        light += np.exp(-0.5 * ((x - 110) / 3) ** 2)[..., None] * RED
    for px, py in PLACES:
        light += np.exp(-0.5 * ((x - px) ** 2 + (y - py) ** 2) / 1.6**2)[..., None] * RED
    encoded = 255 * np.clip(light, 0, 1) ** (1 / 2.2)
    encoded += np.random.default_rng(seed).normal(0, 1, light.shape)
    return np.clip(np.rint(encoded), 0, 255).astype(np.uint8)


def tops(frame: np.ndarray, places: np.ndarray = PLACES) -> list[Tops]:
    found = refined(frame, places, 4, respond(frame, 0, 512.0), np.ones(len(places)))
    assert found is not None
    return found


def shrunk(off: np.ndarray) -> float:
    """By what share (3, 2) pixels make the dock smaller."""
    arms = PLACES - PLACES.mean(axis=0)
    return -float((off * arms).sum() / (arms**2).sum())


@pytest.mark.parametrize("bright", [0.5, 1.0, 2.0])
def test_bars_draw_lamps_as_far_as_is_told(bright: float) -> None:
    frame = picture(bright * WHITE)
    found = tops(frame)
    drawn = shrunk(np.array([top.xy[0] for top in found]) - PLACES)
    told = smaller(PLACES, leaning(frame, found)) / FOLLOWED
    assert drawn > 0.001
    assert 0.5 * drawn < told < 2.5 * drawn


@pytest.mark.parametrize(
    ("bars", "post"), [(None, False), (None, True), (np.array([-0.1, -0.1, 0.0]), False)]
)
def test_lamps_without_bright_bars_are_not_drawn(bars: np.ndarray | None, post: bool) -> None:
    """Dark bars end at dark holders; what crosses the way is no bar."""
    frame = picture(bars, post)
    found = tops(frame)
    assert np.abs(leaning(frame, found)).max() < 0.05


def lamps_alone(places: np.ndarray, radius: float) -> np.ndarray:
    y, x = np.mgrid[0:180, 0:220].astype(float)
    light = np.tile(WATER, (180, 220, 1))
    for px, py in places:
        light += np.exp(-0.5 * ((x - px) ** 2 + (y - py) ** 2) / radius**2)[..., None] * RED
    return np.rint(255 * np.clip(light, 0, 1) ** (1 / 2.2)).astype(np.uint8)


def test_a_lamp_on_the_way_to_another_is_no_bar() -> None:
    places = np.array([(40.0 + 45 * k, 90.0) for k in range(4)])
    frame = lamps_alone(places, 1.6)
    assert np.abs(leaning(frame, tops(frame, places))).max() < 0.05


def test_what_lamps_shine_on_each_other_is_no_bar() -> None:
    """Of two that are close to each other."""
    places = np.array([(60.0, 80.0), (160.0, 80.0), (60.0, 91.0), (160.0, 91.0)])
    frame = lamps_alone(places, 2.5)
    assert np.abs(leaning(frame, tops(frame, places))).max() < 0.05


def test_the_size_alone_is_told_and_never_that_it_may_be_larger() -> None:
    arms = PLACES - PLACES.mean(axis=0)
    assert smaller(PLACES, -0.03 * arms) == pytest.approx(0.03 * FOLLOWED)
    assert smaller(PLACES, 0.03 * arms) == 0.0
    assert smaller(PLACES, np.full((3, 2), 4.0)) == pytest.approx(0.0, abs=1e-9)


def test_no_bar_draws_a_lamp_much_farther_than_its_light_is_smoothed() -> None:
    """Of a lamp that hardly bends the light."""
    frame, weights = picture(2.0 * WHITE), np.ones(3, np.float32)
    lean = lean_by_bars(frame, PLACES, np.full(3, 2.0), np.full(3, 1e4), weights)
    assert np.linalg.norm(lean, axis=1).max() < 4 * 2.0
    faint = lean_by_bars(frame, PLACES, np.full(3, 2.0), np.full(3, 1e-3), weights)
    twice = lean_by_bars(frame, PLACES, np.full(3, 2.0), np.full(3, 2e-3), weights)
    assert twice == pytest.approx(2 * faint, rel=1e-3)
