from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.pose import epnp
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
