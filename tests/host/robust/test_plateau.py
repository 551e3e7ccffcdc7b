from __future__ import annotations

import cv2
import numpy as np

from chromadock.robust.frame.plateau import on_one_thing

FAR = [(300.0, 100.0), (300.0, 130.0)]


def frame(lamps: list[tuple[float, float]], radius: float) -> np.ndarray:
    """Green lamps so bright that they clip: green first, then blue, red at the core alone."""
    y, x = np.mgrid[:240, :400].astype(np.float32)
    light = np.full((240, 400, 3), 20.0, np.float32)
    for u, v in lamps:
        shine = np.exp(-0.5 * ((x - u) ** 2 + (y - v) ** 2) / radius**2)
        light += shine[..., None] * np.array([420, 2000, 300], np.float32)
    return np.clip(light, 0, 255).astype(np.uint8)


def test_two_places_on_one_overexposed_lamp_are_found_out() -> None:
    seen = frame([(100.0, 100.0), *FAR], 12.0)
    assert on_one_thing(seen, np.array([(97.0, 98.0), (103.0, 103.0), *FAR]))


def test_two_lamps_whose_light_runs_into_each_other_are_two() -> None:
    close = [(100.0, 100.0), (100.0, 130.0)]
    seen = frame([*close, *FAR], 10.0)
    assert seen[100:131, 100, 1].min() == 255
    assert not on_one_thing(seen, np.array([*close, *FAR]))


def test_a_bar_of_light_is_one_lamp() -> None:
    seen = np.full((240, 400, 3), 30, np.uint8)
    cv2.line(seen, (80, 60), (320, 60), (255, 255, 255), 9)
    assert on_one_thing(seen, np.array([(100.0, 60.0), (200.0, 60.0), (300.0, 60.0)]))


def test_lamps_that_do_not_clip_are_not_asked() -> None:
    seen = np.full((240, 400, 3), 240, np.uint8)
    assert not on_one_thing(seen, np.array([(100.0, 60.0), (110.0, 60.0), (300.0, 60.0)]))


def test_noise_in_a_channel_that_the_lamps_do_not_light_is_no_gap() -> None:
    """Flat lamps of magenta before bright cyan water: blue and green differ by noise alone."""
    told = []
    for seed in range(200):
        seen = np.full((240, 400, 3), (200, 160, 40), np.uint8)
        for x in (100, 132):
            cv2.circle(seen, (x, 100), 6, (200, 160, 150), -1, cv2.LINE_AA)
        noisy = seen + np.random.default_rng(seed).normal(0, 5, seen.shape)
        seen = np.clip(noisy, 0, 255).astype(np.uint8)
        pairs = [(x + 0.3, y) for x in (100.0, 132.0) for y in (97.0, 103.0)]
        told.append(on_one_thing(seen, np.array(pairs)))
        apart = np.array([(100.0, 100.0), (132.0, 100.0), *FAR])
        assert not on_one_thing(seen, apart)
    assert sum(told) >= 195


def test_faint_lamps_on_a_white_bar_are_two() -> None:
    """The bar is brighter than the water in every channel, the lamps than the bar in red alone."""
    seen = np.full((240, 400, 3), (180, 150, 60), np.uint8)
    cv2.line(seen, (85, 60), (315, 60), (230, 190, 110), 17)
    for x in (100, 300):
        cv2.circle(seen, (x, 60), 5, (230, 190, 118), -1, cv2.LINE_AA)
    assert not on_one_thing(seen, np.array([(100.0, 60.0), (300.0, 60.0)]))
