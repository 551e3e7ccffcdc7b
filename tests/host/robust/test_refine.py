from __future__ import annotations

import numpy as np
import pytest

from chromadock.robust.refine import refined
from chromadock.robust.response import Response, respond

LENS_PX = 1.2


def frame_with(
    places: np.ndarray, radius_px: float, radiance: float, rng: np.random.Generator
) -> np.ndarray:
    """Red lamps with a halo on blue water: clipped, noisy, 8 bits.  ``places`` are (n, 2)."""
    y, x = np.mgrid[0:160, 0:240].astype(float)
    light = np.tile(np.array([0.5, 0.3, 0.02]), (160, 240, 1))
    for px, py in places:
        away = np.hypot(x - px, y - py)
        core = np.exp(-0.5 * (away / np.hypot(LENS_PX, radius_px / 2)) ** 2)
        halo = 0.02 * np.exp(-away / 6)
        light += radiance * (core + halo)[..., None] * np.array([0.05, 0.1, 1.0])
    encoded = 255 * np.clip(light, 0, 1) ** (1 / 2.2) + rng.normal(0, 2, light.shape)
    return np.clip(np.rint(encoded), 0, 255).astype(np.uint8)


def seen(frame: np.ndarray) -> Response:
    return respond(frame, 0, 512.0)


@pytest.mark.parametrize(
    ("radius_px", "radiance", "cell", "most_px"),
    [(1.0, 0.1, 4, 0.35), (1.0, 5.0, 4, 0.1), (3.0, 12.0, 4, 0.1), (7.0, 12.0, 8, 0.15)],
    ids=["faint", "clipped", "clipped core", "clipped and close"],
)
def test_lamps_are_located_without_bias_however_much_they_clip(
    radius_px: float, radiance: float, cell: int, most_px: float
) -> None:
    rng = np.random.default_rng(1)
    errors, pulls = [], []
    for _ in range(12):
        places = np.array([(60.0, 80.0), (170.0, 76.0)]) + rng.uniform(-2, 2, (2, 2))
        frame = frame_with(places, radius_px, radiance, rng)
        about = places + rng.uniform(-cell / 3, cell / 3, (2, 2))
        found = refined(frame, about, cell, seen(frame).weights, np.ones(2) * cell / 4)
        assert found is not None
        errors.append(found[0] - places)
        pulls.append((found[0] - places) / found[1][:, None])
    errors = np.concatenate(errors)
    assert np.sqrt((errors**2).mean()) < most_px
    assert np.abs(errors.mean(axis=0)) == pytest.approx(0, abs=most_px / 2)
    assert np.mean(np.abs(np.concatenate(pulls)) < 1.96) > 0.9


def test_neighbours_do_not_melt_into_one() -> None:
    rng = np.random.default_rng(2)
    places = np.array([(100.0, 70.0), (100.4, 79.3)])
    frame = frame_with(places, 0.5, 0.4, rng)
    found = refined(frame, places + 0.8, 4, seen(frame).weights, np.ones(2))
    assert found is not None
    assert found[0] == pytest.approx(places, abs=0.5)


def test_where_no_lamp_is_near_there_is_no_place() -> None:
    y, x = np.mgrid[0:160, 0:240]
    slope = np.stack([x, x, x + y], axis=-1).astype(np.float64) / 400
    frame = np.rint(255 * slope ** (1 / 2.2)).astype(np.uint8)
    weights = np.array([[0.0, 0.0, 1.0]], np.float32)
    assert refined(frame, np.array([(80.0, 80.0), (120.0, 80.0)]), 4, weights, np.ones(2)) is None
