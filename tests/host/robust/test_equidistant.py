"""A dock before a fisheye: poses from its markers, and the detector on pictures."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from robust_composites import in_plain_water

from chromadock import CameraModel, Detector, DockGeometry
from chromadock.geometry.pose import Sighting, epnp, estimates, refined
from chromadock.overlay import draw_overlay
from chromadock.rotation import matrix_from_quaternion

DOCK = DockGeometry.default()
FIVE = np.vstack([DOCK.points, (0.0, 0.0, -0.3)])
MATRIX = np.array([[300.0, 0, 319.5], [0, 300.0, 239.5], [0, 0, 1]])
BENT = np.array([-0.031, 0.0064, -0.0079, 0.0022])
FISHEYE = CameraModel(640, 480, MATRIX, BENT, "150 degrees", "equidistant")
AS_PINHOLE = CameraModel(640, 480, MATRIX, name="pinhole")
PANORAMA = CameraModel(640, 480, np.diag([0.6, 0.6, 1]) @ MATRIX, BENT / 9, lens="equidistant")


def turned(yaw_deg: float, pitch_deg: float = 3.0, roll_deg: float = -4.0) -> np.ndarray:
    yaw, pitch, roll = (
        cv2.Rodrigues(np.radians(angle) * axis)[0]
        for angle, axis in zip((yaw_deg, pitch_deg, roll_deg), np.eye(3)[[1, 0, 2]], strict=True)
    )
    return yaw @ pitch @ roll


def towards(bearing_deg: float, range_m: float) -> np.ndarray:
    """A place so far to the right of the axis, and a little below."""
    bearing = np.radians(bearing_deg)
    ahead = np.array([np.sin(bearing), 0.1, np.cos(bearing)])
    return range_m * ahead / np.linalg.norm(ahead)


def sighting(points: np.ndarray, R: np.ndarray, t: np.ndarray, camera: CameraModel) -> Sighting:
    pixels = camera.project(points @ R.T + t)
    assert np.isfinite(pixels).all()
    return Sighting(points, pixels, np.full(len(points), 0.1), camera)


@pytest.mark.parametrize("bearing_deg", [0, 30, 60, 75, 90, 110])
@pytest.mark.parametrize("points", [DOCK.points, FIVE, FIVE[1:4]])
def test_a_pose_comes_back_from_pixels_to_a_millionth(
    points: np.ndarray, bearing_deg: float
) -> None:
    camera = FISHEYE if bearing_deg <= 75 else PANORAMA
    for range_m in (0.9, 3.0):
        R, t = turned(0.7 * bearing_deg + 10), towards(bearing_deg, range_m)
        seen = sighting(points, R, t, camera)
        found = estimates(seen)
        pose = min(found, key=lambda e: float(np.abs(e.t - t).max()))
        if len(points) >= 4:  # three leave open poses that are very close together
            again = refined(seen, turned(0.7 * bearing_deg + 14), 1.05 * t)
            assert again is not None and np.abs(pose.t - t).max() < 1e-4 * range_m
            pose = again
        np.testing.assert_allclose(pose.t, t, atol=1e-6 * range_m)
        np.testing.assert_allclose(pose.R, R, atol=1e-5)
        if len(points) >= 4:
            rough = epnp(points, seen.pixels, camera)
            assert rough is not None and rough.t == pytest.approx(tuple(t), abs=0.02 * range_m)


def test_pixels_that_no_ray_comes_to_give_no_pose() -> None:
    """Around the circle of a fisheye whose formula turns back before the corners."""
    camera = CameraModel(
        640, 480, np.diag([0.5, 0.5, 1]) @ MATRIX, np.array([0, 0, -0.02, 0]), lens="equidistant"
    )
    pixels = np.array([[600.0, 440], [639, 440], [600, 479], [639, 479]])
    assert estimates(Sighting(DOCK.points, pixels, np.full(4, 0.1), camera)) == ()
    assert epnp(DOCK.points, pixels, camera) is None


def picture(camera: CameraModel, R: np.ndarray, t: np.ndarray, seed: int = 0) -> np.ndarray:
    """The dock in plain water, wholly within the frame."""
    points = DOCK.points @ R.T + t
    pixels = camera.project(points)
    assert (pixels > 10).all() and (pixels < np.array([630, 470])).all()
    return in_plain_water(points, camera, seed)


@pytest.mark.parametrize(
    ("camera", "bearing_deg", "range_m"),
    [
        (FISHEYE, 0, 1.5),
        (FISHEYE, 25, 1.0),
        (FISHEYE, 40, 2.0),
        (FISHEYE, 52, 2.5),
        (PANORAMA, 70, 1.5),
        (PANORAMA, 92, 1.5),
    ],
)
def test_a_dock_is_found_through_a_fisheye_and_misplaced_by_a_pinhole(
    camera: CameraModel, bearing_deg: float, range_m: float
) -> None:
    R, t = turned(0.5 * bearing_deg + 6), towards(bearing_deg, range_m)
    frame = picture(camera, R, t)
    seen = Detector(camera, DOCK, independent=True).process(frame, 0.0)
    assert seen.found and seen.pose is not None
    assert np.linalg.norm(seen.pose.t - t) < 0.03 * range_m
    poses = [seen.pose] + ([seen.pose.alternative] if seen.pose.alternative else [])
    off = [cv2.Rodrigues(matrix_from_quaternion(p.q_wxyz) @ R.T)[0] for p in poses]
    assert min(np.linalg.norm(turn) for turn in off) < np.radians(5)
    flat = CameraModel(640, 480, camera.matrix)
    wrong = Detector(flat, DOCK, independent=True).process(frame, 0.0)
    if wrong.pose is not None:
        assert np.linalg.norm(wrong.pose.t - t) > 0.035 * range_m


def test_a_dock_is_tracked_through_a_fisheye_as_it_comes_to_the_side() -> None:
    detector, detection, t = Detector(FISHEYE, DOCK), None, np.zeros(3)
    for k in range(8):
        R, t = turned(15 + 2 * k), towards(16 + 4 * k, 2.0)
        detection = detector.process(picture(FISHEYE, R, t, k), 0.1 * k)
    assert detection is not None and detection.track is not None
    assert detection.track.state == "tracking" and detection.track.pose is not None
    assert np.linalg.norm(detection.track.pose.t - t) < 0.03 * 2.0


def test_the_overlay_draws_the_axes_where_a_fisheye_has_them() -> None:
    R, t = turned(30), towards(35, 1.2)
    frame = picture(FISHEYE, R, t)
    detector = Detector(FISHEYE, DOCK, independent=True)
    detection = detector.process(frame, 0.0)
    drawn = draw_overlay(frame, detector.mask, detection, FISHEYE, DOCK)
    tips = FISHEYE.project(0.25 * 0.89 * np.eye(3)[:2] @ R.T + t)
    for (x, y), channel in zip(np.rint(tips).astype(int).tolist(), (2, 1), strict=True):
        around = drawn[y - 2 : y + 3, x - 2 : x + 3].reshape(-1, 3).mean(axis=0)
        assert around.argmax() == channel and around[channel] > 150  # x red, y green
