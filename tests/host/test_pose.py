from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.pose import Estimate, Sighting, epnp, estimates, refined
from chromadock.rotation import matrix_from_quaternion, quaternion_from_matrix

CAMERA = CameraModel.nominal(640, 480)
DOCK = DockGeometry.default()


def rotation(yaw: float, pitch: float, roll: float) -> np.ndarray:
    return cv2.Rodrigues(np.radians([pitch, yaw, roll]).astype(float))[0]


@pytest.mark.parametrize("yaw", [-30, -12, 5, 25])
@pytest.mark.parametrize("t", [(0, 0, 1.2), (0.3, -0.2, 3.0), (-0.5, 0.4, 5.0)])
def test_the_pose_comes_back_from_exact_pixels(yaw: float, t: tuple[float, ...]) -> None:
    R = rotation(yaw, 6, -4)
    pixels = CAMERA.project(DOCK.points @ R.T + t)
    pose = epnp(DOCK.points, pixels, CAMERA)
    assert pose is not None
    assert pose.t == pytest.approx(t, abs=0.01)
    assert matrix_from_quaternion(pose.q_wxyz) == pytest.approx(R, abs=0.05)
    assert pose.reprojection_px < 0.1


def test_directions_are_the_camera_frames() -> None:
    """Known signs: a dock right of the axis has x > 0, below it y > 0, and z is forward."""
    for t, axis in (((0.3, 0.0, 2.0), 0), ((0.0, 0.3, 2.0), 1)):
        pixels = CAMERA.project(DOCK.points + t)
        pose = epnp(DOCK.points, pixels, CAMERA)
        assert pose is not None
        assert pose.t[axis] == pytest.approx(0.3, abs=0.01)
        assert pose.t[2] == pytest.approx(2.0, abs=0.02)
        assert pose.q_wxyz[0] == pytest.approx(1.0, abs=1e-3)


def test_each_rotated_axis_has_the_right_sign() -> None:
    for axis in range(3):
        angle = np.zeros(3)
        angle[axis] = np.radians(20)
        R = cv2.Rodrigues(angle)[0]
        pixels = CAMERA.project(DOCK.points @ R.T + (0.1, 0.05, 2.0))
        pose = epnp(DOCK.points, pixels, CAMERA)
        assert pose is not None
        assert pose.q_wxyz[1 + axis] == pytest.approx(np.sin(np.radians(10)), abs=0.01)


def test_the_error_is_the_rms_of_the_reprojection() -> None:
    pixels = CAMERA.project(DOCK.points @ rotation(10, 5, 0).T + (0, 0, 2.0))
    noise = np.random.default_rng(1).normal(0, 1, pixels.shape)
    pose = epnp(DOCK.points, pixels + noise, CAMERA)
    assert pose is not None
    R, t = matrix_from_quaternion(pose.q_wxyz), np.array(pose.t)
    error = CAMERA.project(DOCK.points @ R.T + t) - (pixels + noise)
    assert pose.reprojection_px == pytest.approx(np.sqrt((error**2).sum(1).mean()))


def test_quaternions_go_to_matrices_and_back() -> None:
    rng = np.random.default_rng(2)
    for _ in range(200):
        q = rng.normal(size=4)
        q *= np.sign(q[0]) / np.linalg.norm(q)
        R = matrix_from_quaternion(q)
        assert np.linalg.det(R) == pytest.approx(1)
        assert quaternion_from_matrix(R) == pytest.approx(q)
    for half_turn in ((0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)):
        R = matrix_from_quaternion(half_turn)
        assert np.abs(quaternion_from_matrix(R)) == pytest.approx(half_turn)


FAR_ORIGINS = [(0.0, -2.0, 0.0), (0.0, 0.0, -1.0), (-2.0, 0.3, 1.0), (50.0, 0.0, 0.0)]


def same(a: Estimate, b: Estimate, shift: np.ndarray) -> None:
    """Of a dock, and of the same with its origin moved by -``shift``."""
    back = b.about(shift)
    assert a.distance(back.R, back.t) < 1e-2  # a tenth of an error: where the search ends
    assert back.chi_square == pytest.approx(a.chi_square, abs=1e-3)
    assert back.distance(a.R, a.t) < 1e-2
    assert b.distance(b.R, b.t) == 0.0


@pytest.mark.parametrize("shift", FAR_ORIGINS)
@pytest.mark.parametrize("count", [3, 4])
def test_all_poses_are_found_wherever_the_dock_has_its_origin(
    count: int, shift: tuple[float, ...]
) -> None:
    """From afar, where the markers leave two open, or of three up to four."""
    rng = np.random.default_rng(3)
    points, several = DOCK.points[:count], 0
    for _ in range(20):
        R, t = rotation(*rng.normal(0, (20, 10, 10))), np.array([0.2, -0.1, rng.uniform(1.5, 6)])
        seen = CAMERA.project(points @ R.T + t) + rng.normal(0, 0.3, (count, 2))
        near = Sighting(points, seen, np.full(count, 0.3), CAMERA)
        far = Sighting(points + shift, seen, np.full(count, 0.3), CAMERA)
        poses, others = estimates(near), estimates(far)
        assert len(poses) == len(others)
        several += len(poses) > 1
        for a, b in zip(poses, others, strict=True):
            same(a, b, np.array(shift))
        begun = refined(near, np.eye(3), t)
        again = refined(far, np.eye(3), t - np.array(shift))
        assert begun is not None and again is not None
        same(begun, again, np.array(shift))
    assert several >= 10


def test_what_is_known_of_a_pose_is_carried_to_another_point() -> None:
    """By drawing errors and moving each pose."""
    rng = np.random.default_rng(4)
    R, t, point = rotation(20, -10, 5), np.array([0.1, 0.2, 3.0]), np.array([0.5, -2.0, 0.4])
    spread = rng.normal(0, 0.01, (6, 6))
    covariance = spread @ spread.T + 1e-5 * np.eye(6)
    moved = Estimate(R, t, 0.0, 0.0, np.linalg.inv(covariance)).about(point)
    ends = []
    for step in rng.multivariate_normal(np.zeros(6), covariance, 20_000):
        turned = cv2.Rodrigues(step[3:])[0] @ R
        ends.append(np.concatenate([t + step[:3] + turned @ point - moved.t, step[3:]]))
    found = np.cov(np.array(ends).T)
    scale = np.sqrt(np.outer(np.diag(found), np.diag(found)))
    np.testing.assert_allclose(moved.covariance / scale, found / scale, atol=0.03)
