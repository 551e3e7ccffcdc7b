from __future__ import annotations

import cv2
import numpy as np
import pytest
from composites import CAMERA, DOCK, compose

from chromadock import CameraModel, ChromadockError, Detector
from chromadock.colour.hsv import rgb_from_hsv

WATER_BGR = (200, 150, 52)


def water(shape: tuple[int, int] = (480, 640)) -> np.ndarray:
    rng = np.random.default_rng(0)
    noise = rng.normal(0, 2, (*shape, 3))
    return np.clip(np.array(WATER_BGR) + noise, 0, 255).astype(np.uint8)


def test_a_composited_dock_is_found_where_it_is() -> None:
    detector = Detector(CAMERA, DOCK, independent=True)
    seen = compose(water(), 2.0, np.random.default_rng(4))
    detection = detector.process(seen.frame_bgr, 0.0)
    assert detection.found
    assert detection.markers is not None
    for name, pixel in zip(DOCK.names, seen.pixels, strict=True):
        assert np.hypot(*(np.array(detection.markers[name]) - pixel)) < 1.5
    assert detection.pose is not None
    assert detection.pose.t == pytest.approx(seen.t, abs=0.06)
    assert detector.mask.shape == (480, 640)
    assert detection.passed_fraction == pytest.approx(detector.mask.mean())


def test_plain_water_holds_no_dock_and_the_ternary_colour() -> None:
    detection = Detector(None, DOCK, independent=True).process(water(), 0.0)
    assert not detection.found
    assert detection.pose is None
    assert detection.markers is None
    assert detection.background.rgb == pytest.approx((52, 150, 200), abs=2)
    assert detection.background.hue_deg == pytest.approx(200.3, abs=1)
    assert detection.marker.hue_deg == pytest.approx(320.3, abs=1)


def test_the_complement_is_half_a_turn_away() -> None:
    detection = Detector(None, DOCK, mapping="complement").process(water(), 0.0)
    assert detection.marker.hue_deg == pytest.approx(20.3, abs=1)


def test_grey_water_has_no_hue_and_takes_the_fallback() -> None:
    detection = Detector(None, DOCK).process(np.full((60, 80, 3), 120, np.uint8), 0.0)
    assert detection.background.hue_deg is None
    assert detection.marker.rgb == (0, 255, 0)


def test_the_marker_colour_is_averaged_over_two_seconds() -> None:
    detector = Detector(None, DOCK)
    blue, green = (np.full((60, 80, 3), c, np.uint8) for c in ((200, 100, 0), (0, 200, 100)))
    alone = Detector(None, DOCK, independent=True)
    before, after = (alone.process(f, 0).marker.hue_deg for f in (blue, green))
    for i in range(30):
        detector.process(blue, i / 15)
    assert detector.process(green, 2.0).marker.hue_deg == pytest.approx(before, abs=6)
    for i in range(31, 62):
        last = detector.process(green, i / 15)
    assert last.marker.hue_deg == pytest.approx(after, abs=0.3)


def test_a_frame_of_another_size_than_the_calibration_is_refused() -> None:
    with pytest.raises(ChromadockError, match=r"640x480.*320x240"):
        Detector(CAMERA, DOCK).process(water((240, 320)), 0.0)


@pytest.mark.parametrize(
    "frame",
    [
        np.zeros((4, 4), np.uint8),
        np.zeros((4, 4, 4), np.uint8),
        np.zeros((4, 4, 3), np.float32),
        np.zeros((0, 4, 3), np.uint8),
        np.zeros((2, 5121, 3), np.uint8),
    ],
)
def test_frames_of_another_shape_or_type_are_refused(frame: np.ndarray) -> None:
    with pytest.raises(ChromadockError, match="frame"):
        Detector(None, DOCK).process(frame, 0.0)


@pytest.mark.parametrize("shape", [(1, 1), (1, 700), (61, 81), (1080, 1920)])
@pytest.mark.parametrize("level", [0, 255, (10, 200, 90)])
def test_frames_of_one_colour_of_any_size_hold_no_dock(shape: tuple[int, int], level) -> None:
    frame = np.empty((*shape, 3), np.uint8)
    frame[:] = level
    assert not Detector(None, DOCK).process(frame, 0.0).found


def test_noise_of_the_markers_colour_costs_bounded_time_and_is_no_crash() -> None:
    rng = np.random.default_rng(5)
    frame = rng.integers(0, 256, (480, 640, 3), dtype=np.uint8)
    detection = Detector(None, DOCK).process(frame, 0.0)
    assert len(detection.blobs) <= 64


def test_every_stage_is_timed() -> None:
    timing = Detector(None, DOCK).process(water(), 0.0).timing_ms
    assert list(timing) == ["total", "colour", "response", "peaks", "search", "pose", "track"]
    assert timing["total"] >= sum(v for k, v in timing.items() if k != "total") * 0.99


def test_unknown_names_are_refused_with_the_known_ones() -> None:
    with pytest.raises(ChromadockError, match="ternary, complement"):
        Detector(None, DOCK, mapping="triad")
    with pytest.raises(ChromadockError, match="paper"):
        Detector(None, DOCK, method="robst")


def test_the_papers_hue_examples() -> None:
    """Blue water takes a red marker, green water a blue one."""
    for water_hue, marker_rgb in ((1024, (255, 0, 0)), (512, (0, 0, 255))):
        frame = np.full((60, 80, 3), rgb_from_hsv(water_hue, 200, 200)[::-1], np.uint8)
        assert Detector(None, DOCK).process(frame, 0).marker.rgb == marker_rgb


def test_pixels_are_read_as_bgr() -> None:
    frame = cv2.cvtColor(water(), cv2.COLOR_BGR2RGB)
    assert Detector(None, DOCK).process(frame, 0.0).background.rgb[0] == pytest.approx(200, abs=2)


def test_the_nominal_camera_follows_the_frames_size() -> None:
    detector = Detector(None, DOCK, independent=True)
    assert isinstance(CameraModel.nominal(5, 5), CameraModel)
    for shape in ((48, 64), (480, 640), (30, 20)):
        detector.process(water(shape), 0.0)
        assert detector.mask.shape == shape
