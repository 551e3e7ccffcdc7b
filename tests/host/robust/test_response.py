from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock.robust.frame.layout import BORDER, FINE_CELL
from chromadock.robust.frame.peaks import MAX_PEAKS, MIN_SNR, find_peaks
from chromadock.robust.frame.response import Response, linear, respond

FOCAL_PX = 512.0
RED = 0  # hue


def water(seed: int = 0, shape: tuple[int, int] = (480, 640)) -> np.ndarray:
    """Blue-green, brighter above, with a camera's noise; channels correlate like water's."""
    rng = np.random.default_rng(seed)
    light = np.linspace(1.2, 0.8, shape[0])[:, None, None] * np.array([190.0, 140.0, 40.0])
    common = rng.normal(0, 2, (*shape, 1)) * np.array([1, 0.8, 0.3])
    return np.clip(light + common + rng.normal(0, 1.5, (*shape, 3)), 0, 255).astype(np.uint8)


def with_lamps(frame: np.ndarray, places: np.ndarray, light: float = 0.5) -> np.ndarray:
    """Red points blurred by the lens, ``light`` full scales of a pixel each, in linear light."""
    y, x = np.mgrid[0 : frame.shape[0], 0 : frame.shape[1]]
    shine = linear(frame).astype(np.float64)
    for px, py in places:
        spot = light * np.exp(-0.5 * ((x - px) ** 2 + (y - py) ** 2)) / (2 * np.pi)
        shine += spot[..., None] * np.array([0.02, 0.08, 1.0])
    return np.rint(255 * np.clip(shine, 0, 1) ** (1 / 2.2)).astype(np.uint8)


def finest(response: Response) -> np.ndarray:
    """Peaks of the finest scale, (N, 2)."""
    return find_peaks(response)[response.layout.cells[0]].xy


def test_of_plain_water_each_filter_hears_noise_of_one_and_few_cells_stand_out() -> None:
    response = respond(water(), RED, FOCAL_PX)
    inside = response.layout.inside(1)
    heard = np.tensordot(response.weights, response.added[:, inside[0], inside[1]], 1)
    assert heard.mean(axis=(1, 2)) == pytest.approx(0, abs=0.1)
    assert heard.std(axis=(1, 2)) == pytest.approx(1, abs=0.2)
    # The largest of a few correlated normal variables: of one it would be 0.0013.
    assert np.mean(response.snr[inside] > MIN_SNR) == pytest.approx(0.003, abs=0.003)


def test_no_other_filter_hears_the_markers_colour_better() -> None:
    frame = water()
    response = respond(frame, RED, FOCAL_PX)
    signature = np.array([0.0, 0.0, 1.0])
    rows, columns = response.layout.inside(1)
    light = np.ascontiguousarray(np.moveaxis(response.light[:, rows, columns], 0, 2))
    flat = light - cv2.blur(light, (9, 9))

    def heard(weights: np.ndarray) -> float:
        return float(signature @ weights / (flat @ weights).std())

    best = heard(response.weights[0])
    rng = np.random.default_rng(1)
    assert max(heard(w) for w in rng.normal(size=(200, 3))) < 1.03 * best
    assert heard(signature) < best


def test_exposure_does_not_change_what_is_seen() -> None:
    dark = np.rint(water().astype(float) * 0.5 ** (1 / 2.2)).astype(np.uint8)
    places = np.array([(200.3, 150.8)])
    both = [
        find_peaks(respond(frame, RED, FOCAL_PX))[FINE_CELL].snr[0]
        for frame in (with_lamps(water(), places, 4), with_lamps(dark, places, 2))
    ]
    assert both[0] == pytest.approx(both[1], rel=0.35)


def test_lamps_are_found_to_half_a_cell_wherever_they_are() -> None:
    rng = np.random.default_rng(2)
    places = np.array([(x, y) for x in range(40, 620, 60) for y in range(40, 460, 60)], float)
    places += rng.uniform(-4, 4, places.shape)
    peaks = find_peaks(respond(with_lamps(water(), places, 3), RED, FOCAL_PX))[FINE_CELL]
    apart = np.linalg.norm(places[:, None] - peaks.xy[None, : len(places)], axis=2)
    assert apart.min(axis=0).max() < 2
    assert len(set(apart.argmin(axis=0).tolist())) == len(places)
    # Cells that a lamp falls between share its light; the peaks' strengths hardly tell.
    assert np.log(peaks.snr[: len(places)]).std() < 0.2


def test_what_a_lamp_adds_is_told_from_the_water_behind_it() -> None:
    """Equal lamps before water that turns from dark blue to bright green."""
    places = np.array([(x, 240.0) for x in range(52, 640, 64)])
    across = np.linspace(0, 1, 640)[None, :, None]
    colour = (1 - across) * np.array([90.0, 60.0, 20.0]) + across * np.array([90.0, 170.0, 60.0])
    noise = np.random.default_rng(5).normal(0, 1.0, (480, 640, 3))
    frame = with_lamps((colour + noise).astype(np.uint8), places, 3)
    response = respond(frame, RED, FOCAL_PX)
    column, row = np.floor((places + 0.5) / FINE_CELL).astype(np.intp).T
    added = response.added_at(response.layout.at(1, row, column))
    assert added[:, 2] == pytest.approx(np.median(added[:, 2]), rel=0.15)
    assert np.abs(added[:, :2]).max() < 0.3 * added[:, 2].min()
    assert np.ptp(response.chroma(added), axis=0).max() < 0.3


def test_a_speck_of_light_looks_like_a_lamp_but_a_pole_and_a_shadow_do_not() -> None:
    frame = water()
    cv2.line(frame, (300, 40), (308, 440), (150, 110, 120), 5, cv2.LINE_AA)
    cv2.circle(frame, (450, 300), 5, (100, 60, 20), -1, cv2.LINE_AA)
    cv2.circle(frame, (520, 120), 3, (255, 200, 40), -1, cv2.LINE_AA)
    frame = with_lamps(frame, np.array([(120.0, 240.0)]), 6)
    peaks = find_peaks(respond(frame, RED, FOCAL_PX))[FINE_CELL]
    likest = peaks.xy[np.argsort(-peaks.likeness)[:2]]
    for light in ((120, 240), (520, 120)):
        assert np.linalg.norm(likest - light, axis=1).min() < 2
    # A pole's ends are rounder than the rest of it.
    of_the_pole = np.abs(peaks.xy[:, 0] - (300 + (peaks.xy[:, 1] - 40) / 50)) < 6
    assert of_the_pole.any()
    assert peaks.likeness[of_the_pole].max() < 0
    assert np.linalg.norm(peaks.xy - (450, 300), axis=1).min() > 8


def test_a_frame_full_of_specks_gives_no_more_peaks_than_the_limit() -> None:
    rng = np.random.default_rng(3)
    frame = with_lamps(water(), rng.uniform((20, 20), (620, 460), (300, 2)), 3)
    assert len(finest(respond(frame, RED, FOCAL_PX))) == MAX_PEAKS


@pytest.mark.parametrize("shape", [(64, 64), (65, 97), (479, 641), (720, 1280)])
def test_any_size_will_do(shape: tuple[int, int]) -> None:
    frame = water(shape=shape)
    place = np.array([(0.55 * shape[1], 0.45 * shape[0])])
    response = respond(with_lamps(frame, place, 8), RED, 0.8 * shape[1])
    assert np.linalg.norm(finest(response)[0] - place[0]) < 3


@pytest.mark.parametrize("value", [0, 90, 255])
def test_a_frame_of_one_value_has_no_peaks(value: int) -> None:
    frame = np.full((480, 640, 3), value, np.uint8)
    response = respond(frame, RED, FOCAL_PX)
    layout = response.layout
    for scale in range(len(layout.cells)):
        assert np.isfinite(response.snr[layout.inside(scale)]).all()
    assert not any(len(peaks.snr) for peaks in find_peaks(response).values())


def test_each_cell_of_the_image_of_all_scales_is_where_its_index_says() -> None:
    layout = respond(water(), RED, FOCAL_PX).layout
    assert layout.cells == (FINE_CELL // 2, FINE_CELL, 2 * FINE_CELL, 4 * FINE_CELL)
    index = np.arange(np.prod(layout.shape)).reshape(layout.shape)
    for scale, (height, width) in enumerate(layout.shapes):
        row, column = (i.ravel() for i in np.mgrid[:height, :width])
        at = layout.at(scale, row, column)
        assert np.array_equal(index[layout.inside(scale)].ravel(), at)


def test_the_border_of_each_scale_repeats_its_outermost_cells() -> None:
    response = respond(water(), RED, FOCAL_PX)
    for image in (*response.light, response.snr):
        for scale in range(len(response.layout.cells)):
            rows, columns = response.layout.inside(scale)
            framed = image[
                rows.start - BORDER : rows.stop + BORDER,
                columns.start - BORDER : columns.stop + BORDER,
            ]
            assert np.array_equal(framed, np.pad(image[rows, columns], BORDER, mode="edge"))
