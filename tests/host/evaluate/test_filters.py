from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from composites import CAMERA, DOCK, compose

from chromadock import Detector
from chromadock.choices import MAPPINGS
from chromadock.evaluate.filters import ADAPTIVE, MASKS, filter_mask
from chromadock.evaluate.finders import Finders
from chromadock.evaluate.tuned import Box, Tuned
from chromadock.evaluate.tuning import Example, tune
from chromadock.evaluate.view import Vehicle
from chromadock.mounting import R_BODY_CAMERA_FORWARD, Mounting

ANY = Tuned({"pool": Box((150, 20, 30), (200, 90, 250)), "lake": Box((1, 2, 3), (4, 5, 6))}, 99, {})


def water(share: float, rng: np.random.Generator) -> np.ndarray:
    """From pool blue to lake green, noisy, BGR."""
    level = (1 - share) * np.array((200, 150, 52)) + share * np.array((70, 150, 90))
    return np.clip(rng.normal(level, 4, (480, 640, 3)), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("name", list(ADAPTIVE))
def test_an_adaptive_filter_is_the_detector_with_its_mapping(name: str) -> None:
    rng = np.random.default_rng(1)
    detector, vehicle = Detector(CAMERA, DOCK, method="paper", mapping=ADAPTIVE[name]), Vehicle()
    passed = 0
    for i in range(12):
        frame = compose(water(i / 12, rng), 2.0, rng).frame_bgr
        detector.process(frame, 0.3 * i)
        mask = filter_mask(name, vehicle.view(frame, 0.3 * i), ANY)
        np.testing.assert_array_equal(mask > 0, detector.mask)
        passed += np.count_nonzero(mask)
    assert passed > 0


@pytest.mark.parametrize("mapping", MAPPINGS)
def test_robust_is_the_detector_with_the_runs_own_mapping(mapping: str) -> None:
    rng = np.random.default_rng(3)
    detector, vehicle = Detector(CAMERA, DOCK, method="robust", mapping=mapping), Vehicle()
    finders = Finders(DOCK, CAMERA, ANY)
    found = 0
    for i in range(4):
        frame = compose(water(i / 4, rng), 2.0, rng, mapping=mapping).frame_bgr
        expected = detector.process(frame, 0.3 * i)
        got, mask = finders.find("robust", vehicle.view(frame, 0.3 * i), mapping)
        np.testing.assert_array_equal(mask > 0, detector.mask)
        assert (got.state, got.markers, got.pose) == (
            expected.state,
            expected.markers,
            expected.pose,
        )
        found += got.state == "found"
    assert found > 0


@pytest.mark.parametrize(
    ("colour", "mounted"), [("white", False), ("#FF00AA", False), (None, True)]
)
def test_robust_is_told_what_the_detector_is_told(colour: str | None, mounted: bool) -> None:
    rng = np.random.default_rng(5)
    dock = replace(DOCK, colour=colour)
    mounting = Mounting(R_BODY_CAMERA_FORWARD @ np.diag([-1.0, -1.0, 1.0])) if mounted else None
    detector = Detector(CAMERA, dock, method="robust", mounting=mounting, independent=True)
    finders, vehicle = Finders(dock, CAMERA, ANY, mounting), Vehicle()
    for i in range(2):
        frame = compose(water(0.0, rng), 2.0, rng).frame_bgr
        if mounted:
            frame = np.ascontiguousarray(frame[::-1, ::-1])
        # Alone: a rolling mean of one frame is that frame's.
        expected = detector.process(frame, 3.0 * i)
        got, mask = finders.find("robust", vehicle.view(frame, 3.0 * i), "ternary")
        np.testing.assert_array_equal(mask > 0, detector.mask)
        assert (got.state, got.markers, got.pose) == (
            expected.state,
            expected.markers,
            expected.pose,
        )
        assert got.markers is not None
        upright = got.markers["top_left"][1] < got.markers["bottom_left"][1]
        assert upright != mounted


def test_a_static_filter_passes_what_is_in_its_box_round_the_end_of_the_hues() -> None:
    rng = np.random.default_rng(2)
    frame = rng.integers(0, 256, (480, 640, 3), np.uint8)
    mask = filter_mask("static pool", Vehicle().view(frame, 0.0), ANY)
    h, s, v = np.moveaxis(cv2.cvtColor(frame, cv2.COLOR_BGR2HSV).astype(int), -1, 0)
    inside = ((h >= 150) | (h <= 20)) & (s >= 20) & (s <= 90) & (v >= 30) & (v <= 250)
    np.testing.assert_array_equal(mask, np.where(inside, 255, 0))
    assert inside.any()


def test_the_intensity_filter_passes_what_is_bright() -> None:
    frame = np.repeat(np.arange(256, dtype=np.uint8)[None, :, None], 3, axis=2).repeat(64, axis=0)
    mask = filter_mask("intensity", Vehicle().view(frame, 0.0), ANY)
    assert not mask[:, :98].any()
    assert mask[:, 101:].all()


def example(marker_hsv: tuple, water_hsv: tuple, spread: int, seed: int) -> Example:
    """A disc of one colour in water of another, each of some spread."""
    rng = np.random.default_rng(seed)
    marker = np.zeros((120, 160), np.uint8)
    cv2.circle(marker, (80, 60), 6, 1, -1)
    outside = np.ones_like(marker)
    cv2.circle(outside, (80, 60), 12, 0, -1)
    colours = np.where(marker[..., None] > 0, marker_hsv, water_hsv)
    colours = colours + rng.integers(-spread, spread + 1, colours.shape)
    colours[..., 0] %= 180
    hsv = np.clip(colours, 0, 255).astype(np.uint8)
    return Example(hsv, np.ascontiguousarray(hsv[..., 2]), marker > 0, outside > 0)


def test_a_tuned_box_holds_its_markers_and_not_their_water() -> None:
    pool = [example((2, 120, 200), (100, 180, 120), 5, seed) for seed in range(3)]
    lake = [example((110, 200, 150), (70, 100, 90), 5, seed) for seed in range(3)]
    tuned = tune({"pool": pool, "lake": lake})
    for scene, examples in (("pool", pool), ("lake", lake)):
        assert tuned.evidence[scene]["f1"] > 0.95
        mask = np.concatenate([masked(tuned, scene, e) for e in examples])
        assert mask[np.concatenate([e.marker for e in examples])].mean() > 0.9
        assert not mask[np.concatenate([e.outside for e in examples])].any()
    assert 150 <= tuned.boxes["pool"].low[0] <= 179  # 2 - 5 is beyond the end of the hues
    assert tuned.boxes["pool"].high[0] - tuned.boxes["pool"].low[0] <= 10
    assert 125 < tuned.grey < 146
    assert Tuned.from_dict(tuned.to_dict()) == tuned


def masked(tuned: Tuned, scene: str, e: Example) -> np.ndarray:
    view = Vehicle().view(cv2.cvtColor(e.hsv, cv2.COLOR_HSV2BGR), 0.0)
    view = type(view)(view.frame_bgr, e.hsv, e.grey, view.background, view.marker_hues)
    return filter_mask(f"static {scene}", view, tuned) > 0


def test_tails_that_reach_into_the_water_are_trimmed() -> None:
    clean = example((2, 120, 200), (100, 180, 120), 5, 0)
    clipped = clean.marker.copy()
    clipped[60:62] = False
    hsv = clean.hsv.copy()
    hsv[clean.marker & ~clipped] = (100, 180, 120)  # two rows of marker look like the water
    tuned = tune({"pool": [Example(hsv, clean.grey, clean.marker, clean.outside)]})
    assert tuned.evidence["pool"]["trim_percent"] > 1
    assert tuned.evidence["pool"]["precision"] == 1


def test_markers_that_are_not_to_be_seen_leave_a_box_that_nothing_passes() -> None:
    blank = example((2, 120, 200), (100, 180, 120), 5, 0)
    unseen = Example(blank.hsv, blank.grey, np.zeros_like(blank.marker), blank.outside)
    tuned = tune({"pool": [unseen]})
    assert not masked(tuned, "pool", unseen).any()


def test_every_filter_gives_a_mask_of_the_frames_size() -> None:
    view = Vehicle().view(np.zeros((30, 40, 3), np.uint8), 0.0)
    for name in MASKS:
        mask = filter_mask(name, view, ANY)
        assert mask.shape == (30, 40)
        assert mask.dtype == np.uint8
