"""The compiled front end against the same steps in numpy: ``front_reference``."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cv2
import numpy as np
import pytest
from front_reference import (
    Scale,
    covariance_of,
    dark_of,
    lights_of,
    peaks_of,
    promising_of,
    scales_of,
    weighed,
)

from chromadock.colour.hsv import rgb_from_hsv
from chromadock.method import HUE_RANGE
from chromadock.robust.frame.likeness import inputs
from chromadock.robust.frame.native import lib, pointer
from chromadock.robust.frame.peaks import MIN_SNR, find_peaks
from chromadock.robust.frame.response import HUES, Response, linear, respond
from chromadock.variety import Backdrops, Half, draw, render

DATA = Path(__file__).resolve().parents[4] / "shared" / "data" / "transdec"
SIZES = [(640, 480), (320, 240), (1280, 720), (643, 481), (64, 64), (97, 65)]


def drawn(index: int) -> np.ndarray:
    return render(draw(index, Half.DEVELOP.seed(1), Backdrops()))[0]


def noise(width: int, height: int) -> np.ndarray:
    """Bluish noise with two bright spots, of which one clips."""
    rng = np.random.default_rng(width)
    frame = rng.normal((150, 110, 40), 9, (height, width, 3))
    spots = np.zeros((height, width), np.float32)
    cv2.circle(spots, (width // 3, height // 2), 6, 300.0, -1)
    cv2.circle(spots, (2 * width // 3, height // 3), 2, 120.0, -1)
    frame[..., 2] += cv2.GaussianBlur(spots, (0, 0), 2)
    return np.clip(frame, 0, 255).astype(np.uint8)


def held_against_the_reference(frame: np.ndarray, hue: int) -> None:
    response = respond(frame, hue, 0.85 * frame.shape[1])
    layout = response.layout
    lights = lights_of(frame, layout)
    covariance = covariance_of(lights[1])
    assert np.abs(response.covariance - covariance).max() < 1e-4 * np.abs(covariance).max()
    scales = scales_of(frame, response)
    assert response.dark is not None
    for k, expected in enumerate(scales):
        inside = layout.inside(k)
        light = np.moveaxis(response.light[:, inside[0], inside[1]], 0, 2)
        added = np.moveaxis(response.added[:, inside[0], inside[1]], 0, 2)
        assert np.abs(light - expected.light).max() < 1e-6
        assert np.abs(added - expected.added).max() < 1e-6
        snr = response.snr[inside]
        assert np.abs(snr - expected.snr).max() < 1e-3 * max(1.0, np.abs(expected.snr).max())
        assert np.mean(response.best[inside] != expected.best) < 1e-3
        cells = np.empty(snr.shape, np.uint8)
        count = lib.front_standing_out(response.native, k, pointer(cells))
        assert np.array_equal(cells, snr >= MIN_SNR)
        assert count == cells.sum()
        if k > 0:
            dark = response.dark.snr[inside]
            assert np.abs(dark - expected.dark).max() < 1e-3 * max(1.0, np.abs(expected.dark).max())
    held_against_peaks(response, scales)
    held_against_peaks(response.dark, dark_of(scales, response))


def held_against_peaks(response: Response, scales: list[Scale]) -> None:
    layout = response.layout
    found = find_peaks(response)
    for cell, expected in zip(layout.cells, peaks_of(scales, response), strict=True):
        peaks = found[cell]
        # Of one that takes just enough light away rounding decides.
        assert abs(len(peaks.snr) - len(expected)) <= (response.sense < 0)
        if not expected:
            continue
        # Of peaks as strong as one another any may come first, or be the last of a full list, and
        # of two cells as bright as one another either may be the top.
        places = np.array([p.xy for p in expected])
        apart = np.linalg.norm(peaks.xy[:, None] - places, axis=2)
        order, found_too = apart.argmin(axis=1), apart.min(axis=1) < 0.01
        # Of what is dark there are few.
        astray = max(0.02 * len(found_too), response.sense < 0)
        assert (~found_too).sum() <= astray
        order = order[found_too]
        assert len(set(order.tolist())) == len(order)
        assert np.abs(order - np.flatnonzero(found_too)).max() <= 1
        same = [expected[i] for i in order]
        assert peaks.snr[found_too] == pytest.approx(np.array([p.snr for p in same]), rel=1e-3)
        assert peaks.noise[found_too] == pytest.approx(np.array([p.noise for p in same]), rel=1e-3)
        assert np.abs(peaks.chroma[found_too] - [p.chroma for p in same]).max() < 1e-3
        assert peaks.inside[found_too] == pytest.approx([p.inside for p in same], abs=2e-3)
        # The way to a higher peak may lead over either of two cells; looks count from -2 to 2.
        own, theirs = peaks.looks[found_too], np.array([p.looks for p in same])
        looks = np.abs(np.clip(own, -2, 2) - np.clip(theirs, -2, 2)).max(axis=1)
        assert np.sum(looks >= 4e-3) <= astray
        likeness = np.abs(peaks.likeness[found_too] - [p.likeness for p in same])
        assert np.sum(likeness >= 4e-2) <= astray
        chosen = set(np.flatnonzero(np.isin(apart.argmin(axis=1), promising_of(expected))).tolist())
        assert len(chosen ^ set(peaks.promising.tolist())) <= 2


@pytest.mark.parametrize("hue", [0, 300, 700, 1100])
def test_filters_are_matched_to_their_hues_and_the_others_blind_to_the_first(hue: int) -> None:
    response = respond(noise(640, 480), hue, 512.0)
    hues = [(hue + HUE_RANGE * k // HUES) % HUE_RANGE for k in range(HUES)]
    pure = np.array([[rgb_from_hsv(h, 255, 255)[::-1] for h in hues]], np.uint8)
    signatures = linear(pure)[0].astype(np.float64)
    whitened = np.linalg.solve(response.covariance, signatures.T).T
    expected = whitened / np.sqrt((signatures * whitened).sum(axis=1, keepdims=True))
    assert response.weights == pytest.approx(expected, rel=1e-4, abs=1e-4)
    covariance = response.axes @ response.covariance @ response.axes.T
    assert covariance == pytest.approx(np.eye(3), abs=1e-5)
    assert response.axes[1:] @ np.ones(3) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_noise_and_lamps_of_any_size_give_what_the_reference_gives(size: tuple[int, int]) -> None:
    held_against_the_reference(noise(*size), 40)


@pytest.mark.parametrize("index", range(6))
def test_drawn_scenes_give_what_the_reference_gives(index: int) -> None:
    held_against_the_reference(drawn(index), 200 * index)


def test_a_large_frame_gives_what_the_reference_gives() -> None:
    held_against_the_reference(cv2.resize(drawn(0), (1920, 1080)), 700)


@pytest.mark.skipif(not DATA.is_dir(), reason="no photographs: ../shared/data is missing")
@pytest.mark.parametrize("size", SIZES, ids=str)
def test_photographs_give_what_the_reference_gives(size: tuple[int, int]) -> None:
    path = sorted(DATA.glob("*/*.jpg"))[7 * SIZES.index(size)]
    held_against_the_reference(cv2.resize(cv2.imread(str(path)), size), 900)


def test_the_inputs_of_the_network_are_what_the_likeness_is_made_of() -> None:
    found = find_peaks(respond(drawn(1), 0, 512.0))
    for scale, peaks in enumerate(found.values()):
        told = inputs(peaks.looks, peaks.snr, np.full(len(peaks.snr), scale))
        every = np.column_stack([told, np.ones(len(told))])
        assert weighed(every) == pytest.approx(peaks.likeness, abs=1e-3)


def test_a_mirrored_picture_has_peaks_of_the_same_looks() -> None:
    frame = noise(640, 480)
    seen, mirrored = (find_peaks(respond(f, 40, 512.0)) for f in (frame, frame[:, ::-1].copy()))
    for cell, peaks in seen.items():
        turned = [639, 0] + mirrored[cell].xy * [-1, 1]
        if len(peaks.xy) == 0:
            assert len(turned) == 0
            continue
        # Of peaks as strong as one another another one may be the last of a full list.
        apart = np.linalg.norm(peaks.xy[:, None] - turned, axis=2)
        same = apart.min(axis=1) < 0.01
        assert same.mean() > 0.95
        theirs = mirrored[cell].looks[apart.argmin(axis=1)]
        # The way to a higher peak is rounded to cells, to the other side where it is mirrored.
        others = np.delete(np.abs(peaks.looks - theirs), lib.FRONT_SADDLE, axis=1)
        assert others[same].max() < 1e-3


def test_frames_may_be_worked_on_at_once() -> None:
    frames = [noise(640 + 8 * k, 480) for k in range(8)]

    def strengths(frame: np.ndarray) -> list[float]:
        return [snr for peaks in find_peaks(respond(frame, 0, 512.0)).values() for snr in peaks.snr]

    alone = [strengths(frame) for frame in frames]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(strengths, frames * 4)) == alone * 4


@pytest.mark.parametrize(
    "frame",
    [
        np.zeros((63, 640, 3), np.uint8),
        np.zeros((480, 640), np.uint8),
        np.zeros((480, 640, 4), np.uint8),
        np.zeros((480, 640, 3), np.float32),
    ],
    ids=lambda frame: f"{frame.shape} {frame.dtype}",
)
def test_what_is_no_frame_is_refused(frame: np.ndarray) -> None:
    with pytest.raises(ValueError, match="a frame"):
        respond(frame, 0, 512.0)
