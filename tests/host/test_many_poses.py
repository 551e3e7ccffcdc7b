"""What is computed of many poses at once, against OpenCV and against differences."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.many import normal_equations, rotations
from chromadock.geometry.pose import Sighting, projected

POINTS = DockGeometry.default().points
CAMERA = CameraModel.nominal(640, 480)
LENSES = {
    "plumb_bob": np.array([-0.2, 0.05, 0.001, -0.002, 0.01]),
    "equidistant": np.array([-0.02, 0.003, 0.001, -0.0005]),
}


def test_rotations_are_those_of_opencv() -> None:
    turns = np.random.default_rng(0).normal(0, 1.5, (20, 3))
    turns[0], turns[1] = 0, 1e-9
    expected = [cv2.Rodrigues(turn)[0] for turn in turns]
    assert rotations(turns) == pytest.approx(np.array(expected), abs=1e-14)


@pytest.mark.parametrize("lens", LENSES)
def test_normal_equations_are_those_of_the_projection(lens: str) -> None:
    rng = np.random.default_rng(1)
    matrix = np.array([[500.0, 0, 320], [0, 510, 240], [0, 0, 1]])
    camera = CameraModel(640, 480, matrix, LENSES[lens], lens=lens)
    R, t = rotations(rng.normal(0, 0.3, (5, 3))), rng.normal((0, 0, 3), 0.2, (5, 3))
    sigma_px = rng.uniform(0.2, 2, (5, len(POINTS)))
    pixels = rng.uniform(100, 300, (len(POINTS), 2))
    sighting = Sighting(POINTS, pixels, sigma_px[0], camera)

    def off(R: np.ndarray, t: np.ndarray) -> np.ndarray:
        seen = np.array(
            [camera.project(POINTS @ one.T + place) for one, place in zip(R, t, strict=True)]
        )
        return ((seen - pixels) / sigma_px[:, :, None]).reshape(len(R), -1)

    slopes = []
    for step in 1e-6 * np.eye(6):
        turn = rotations(step[None, 3:])[0]
        ahead, behind = off(turn @ R, t + step[:3]), off(turn.T @ R, t - step[:3])
        slopes.append((ahead - behind) / 2e-6)
    error, jacobian = off(R, t), np.stack(slopes, axis=2)
    normal = normal_equations(sighting, R, t, sigma_px)
    assert normal.seen.all()
    assert normal.chi_square == pytest.approx((error**2).sum(axis=1), rel=1e-9)
    gradient = np.einsum("mni,mn->mi", jacobian, error)
    assert normal.gradient == pytest.approx(gradient, rel=1e-4, abs=np.abs(gradient).max() * 1e-5)
    information = jacobian.transpose(0, 2, 1) @ jacobian
    most = np.abs(information).max()
    assert normal.information == pytest.approx(information, rel=1e-4, abs=most * 1e-6)
    one = projected(POINTS, R[0], t[0], camera)
    assert one is not None
    by_pixel = jacobian[0].reshape(-1, 2, 6) * sigma_px[0][:, None, None]
    assert one[1] == pytest.approx(by_pixel, rel=1e-4, abs=1e-3)
    assert normal_equations(sighting, R[:1], t[:1]).chi_square == normal.chi_square[0]


def test_where_a_marker_is_behind_the_camera_its_normal_equations_are_finite() -> None:
    """A fit that runs away comes there, beside others that do not."""
    sighting = Sighting(POINTS, np.zeros((len(POINTS), 2)), np.ones(len(POINTS)), CAMERA)
    R, t = np.broadcast_to(np.eye(3), (2, 3, 3)), np.array([[0, 0, 2.0], [0, 0, -2.0]])
    normal = normal_equations(sighting, R, t)
    assert normal.seen.tolist() == [True, False]
    assert np.isfinite(normal.information).all()
