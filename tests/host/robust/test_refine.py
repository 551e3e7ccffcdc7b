from __future__ import annotations

import numpy as np
import pytest

from chromadock._native import ffi, lib
from chromadock.robust.frame.refine import _tops, refined
from chromadock.robust.frame.response import Response, respond

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
        found = refined(frame, about, cell, seen(frame), np.ones(2) * cell / 4)
        assert found is not None
        off = np.array([tops.xy[0] for tops in found]) - places
        errors.append(off)
        pulls.append(off / np.array([tops.sigma[0] for tops in found])[:, None])
    errors = np.concatenate(errors)
    assert np.sqrt((errors**2).mean()) < most_px
    assert np.abs(errors.mean(axis=0)) == pytest.approx(0, abs=most_px / 2)
    assert np.mean(np.abs(np.concatenate(pulls)) < 1.96) > 0.9


@pytest.mark.parametrize("apart_px", [14.0, 16.0, 20.0])
def test_overexposed_lamps_close_to_each_other_do_not_drive_each_other_apart(
    apart_px: float,
) -> None:
    """As those of a dock at night: their halos run into each other."""
    rng, spread = np.random.default_rng(6), []
    for _ in range(12):
        places = np.array([(120.0, 70.0), (120.0, 70.0 + apart_px)]) + rng.uniform(-1, 1, 2)
        frame = frame_with(places, 3.0, 4.0, rng)
        about = places + rng.uniform(-1, 1, (2, 2))
        found = refined(frame, about, 4, seen(frame), np.ones(2))
        assert found is not None
        top, bottom = (tops.xy[0] for tops in found)
        spread.append(bottom[1] - top[1] - apart_px)
    assert abs(np.mean(spread)) < 0.03 * apart_px


def glow(places: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Green lamps at night, much too bright: green clips from one to the next, blue nearly, and red
    over their cores alone."""
    y, x = np.mgrid[0:160, 0:240].astype(float)
    light = np.full((160, 240, 3), 0.002)
    for px, py in places:
        away = np.hypot(x - px, y - py)
        core = np.exp(-0.5 * (away / 5.0) ** 2)
        halo = np.exp(-away / 14)
        light += np.array([2.0, 8.0, 3.0]) * core[..., None]
        light += np.array([0.4, 1.6, 0.03]) * halo[..., None]
    encoded = 255 * np.clip(light, 0, 1) ** (1 / 2.2) + rng.normal(0, 2, light.shape)
    return np.clip(np.rint(encoded), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("cell", [4, 8])
def test_channels_that_clip_from_one_lamp_to_the_next_do_not_drive_them_apart(cell: int) -> None:
    rng = np.random.default_rng(7)
    for _ in range(6):
        places = np.array([(120.0, 60.0), (120.0, 90.0)]) + rng.uniform(-1, 1, 2)
        frame = glow(places, rng)
        about = places + rng.uniform(-cell / 3, cell / 3, (2, 2))
        found = refined(frame, about, cell, seen(frame), np.ones(2))
        assert found is not None
        off = np.array([tops.xy[0] for tops in found]) - places
        assert np.abs(off).max() < 0.6


def test_overexposed_lamps_that_have_become_one_have_no_places() -> None:
    rng = np.random.default_rng(8)
    light = np.zeros((160, 240, 3))
    light[40:110, 100:140] = 1.0
    frame = np.rint(255 * light).astype(np.uint8)
    about = np.array([(120.0, 60.0), (120.0, 90.0)]) + rng.uniform(-3, 3, (2, 2))
    assert refined(frame, about, 4, seen(frame), np.ones(2)) is None


@pytest.mark.parametrize("off", [(0.0, 0.0), (1.3, -0.6), (-2.2, 2.2)])
def test_a_cores_centre_is_found_from_beside_it(off: tuple[float, float]) -> None:
    y, x = np.mgrid[-15:16, -15:16].astype(float)
    away = np.hypot(x - off[0], y - off[1])
    light = np.minimum(1.0, 4 * np.exp(-0.5 * (away / 3.0) ** 2)).astype(np.float32)
    at_x, at_y = ffi.new("double *", 0.0), ffi.new("double *", 0.0)
    assert lib.tops_core(ffi.from_buffer("float[]", light), 31, 10.0, at_x, at_y) == 0
    assert (at_x[0], at_y[0]) == pytest.approx(off, abs=0.05)
    dark = np.zeros_like(light)
    assert lib.tops_core(ffi.from_buffer("float[]", dark), 31, 10.0, at_x, at_y) == -1
    assert (at_x[0], at_y[0]) == pytest.approx(off, abs=0.05)


def test_neighbours_do_not_melt_into_one() -> None:
    rng = np.random.default_rng(2)
    places = np.array([(100.0, 70.0), (100.4, 79.3)])
    frame = frame_with(places, 0.5, 0.4, rng)
    found = refined(frame, places + 0.8, 4, seen(frame), np.ones(2))
    assert found is not None
    assert np.array([tops.xy[0] for tops in found]) == pytest.approx(places, abs=0.5)


def test_a_core_that_clips_in_more_channels_than_its_halo_is_no_hole() -> None:
    """Red clips far about the lamp, green at its core only, and the filter takes green away."""
    y, x = np.mgrid[0:160, 0:240].astype(float)
    places = np.array([(60.3, 80.6), (170.4, 76.2), (171.0, 120.0)])
    light = np.tile(np.array([0.02, 0.15, 0.3]), (160, 240, 1))
    for px, py in places:
        away = np.hypot(x - px, y - py)
        light[..., 2] += 3 * np.exp(-away / 4)
        light[..., 1] += 2 * np.exp(-0.5 * (away / 2) ** 2)
    noise = np.random.default_rng(5).normal(0, 2, light.shape)
    frame = np.clip(np.rint(255 * np.clip(light, 0, 1) ** (1 / 2.2) + noise), 0, 255)
    frame = frame.astype(np.uint8)
    found = refined(frame, places + 1.5, 8, seen(frame), np.ones(3) * 0.02)
    assert found is not None
    assert np.array([tops.xy[0] for tops in found]) == pytest.approx(places, abs=0.5)


def test_a_large_lamp_with_room_is_located_beside_small_ones_without() -> None:
    """As a marker out of the others' plane is: nearer, and so larger."""
    rng = np.random.default_rng(4)
    small, large = np.array([(60.0, 70.0), (60.0, 84.0)]), np.array([(170.0, 80.0)])
    both = [frame_with(small, 0.5, 0.4, rng), frame_with(large, 9.0, 12.0, rng)]
    frame = np.maximum(*both)
    places = np.concatenate([small, large])
    found = refined(frame, places + 1.0, 4, seen(frame), np.ones(3))
    assert found is not None
    assert np.array([tops.xy[0] for tops in found]) == pytest.approx(places, abs=0.3)


def test_a_lamp_beside_a_glint_is_among_the_places() -> None:
    """Two small lamps; the glint beside the first is the brighter of the two."""
    rng = np.random.default_rng(3)
    places, glint = np.array([(100.0, 70.0), (100.0, 87.0)]), np.array([(104.5, 66.0)])
    dim = frame_with(places, 0.5, 0.3, rng).astype(int)
    bright = frame_with(glint, 0.5, 0.45, rng).astype(int)
    frame = np.maximum(dim, bright).astype(np.uint8)
    about = np.array([(103.0, 68.0), (100.5, 87.5)])
    found = refined(frame, about, 4, seen(frame), np.ones(2))
    assert found is not None
    first, second = found
    assert np.linalg.norm(first.xy - places[0], axis=1).min() < 0.7
    assert np.linalg.norm(first.xy - glint[0], axis=1).min() < 0.7
    assert first.nearest(places[0])[0] == pytest.approx(places[0], abs=0.7)
    assert len(second.xy) == 1


def test_a_sharp_lamp_of_one_colour_is_known_less_well_than_a_blunt_one() -> None:
    """It falls between the pixels of its colour in the sensor's mosaic."""
    rng = np.random.default_rng(4)
    places = np.array([(60.0, 80.0), (80.0, 80.0)])
    sharp, blunt = (
        refined(frame, places, 4, seen(frame), np.full(2, 0.01))
        for frame in (frame_with(places, radius, 1.0, rng) for radius in (0.2, 3.0))
    )
    assert sharp is not None and blunt is not None
    assert sharp[0].sigma[0] > 1.5 * blunt[0].sigma[0]


def test_where_no_lamp_is_near_there_is_no_place() -> None:
    """On light that rises ever more steeply towards a corner."""
    y, x = np.mgrid[0:160, 0:240]
    rising = np.minimum(np.exp((x + y - 300) / 12), 1.0)
    frame = np.rint(255 * rising[..., None].repeat(3, axis=2) ** (1 / 2.2)).astype(np.uint8)
    places = np.array([(180.0, 90.0), (210.0, 60.0)])
    assert refined(frame, places, 4, seen(frame), np.ones(2)) is None


@pytest.mark.parametrize("cell", [8, 16])
def test_the_corner_of_bright_bars_is_no_sure_place_of_the_lamp_that_stands_on_it(
    cell: int,
) -> None:
    """Smoothed as wide as coarse cells, the corner's own light is what is seen of it."""
    rng = np.random.default_rng(8)
    y, x = np.mgrid[0:320, 0:420].astype(float)
    places = np.array([(100.0, 100.0), (320.0, 100.0)])
    light = np.tile(np.array([0.5, 0.3, 0.02]), (320, 420, 1))
    half = cell / 4
    across = (np.abs(y - 100) < half) & (x > 100 - half) & (x < 320 + half)
    down = (np.minimum(np.abs(x - 100), np.abs(x - 320)) < half) & (y > 100 - half)
    light[across | down] = 0.4
    for px, py in places:
        core = np.exp(-0.5 * (np.hypot(x - px, y - py) / LENS_PX) ** 2)
        light += 0.2 * core[..., None] * np.array([0.05, 0.1, 1.0])
    encoded = 255 * np.clip(light, 0, 1) ** (1 / 2.2) + rng.normal(0, 2, light.shape)
    frame = np.clip(np.rint(encoded), 0, 255).astype(np.uint8)
    found = refined(frame, places, cell, seen(frame), np.ones(2) * 0.1)
    assert found is not None
    off = [np.linalg.norm(tops.xy[0] - p) for tops, p in zip(found, places, strict=True)]
    sigma = [np.hypot(tops.sigma[0], tops.drift[0]) for tops in found]
    assert min(off) > 1
    assert max(np.array(off) / sigma) < 4


@pytest.mark.parametrize(("way", "stands"), [(0.5, True), (2.0, False)])
def test_what_moves_by_more_than_a_step_with_the_smoothing_is_no_lamp(
    way: float, stands: bool
) -> None:
    y, x = np.mgrid[-10:11, -10:11].astype(float)
    narrow = np.exp(-0.5 * (x**2 + y**2) / 2**2)
    wide = 0.2 * np.exp(-0.5 * ((x - way) ** 2 + y**2) / 4**2)
    nothing = np.zeros_like(x)
    smoothed = np.stack([narrow, wide, nothing, nothing]).astype(np.float32)
    tops = _tops(np.array([50.0, 60.0]), smoothed, 4.0, 1, 0.01, np.ones(3, np.float32))
    assert (tops is not None) == stands
    if tops is not None:
        assert tops.xy[0] == pytest.approx([50.0, 60.0])
