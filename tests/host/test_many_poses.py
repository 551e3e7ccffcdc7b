"""What is computed of many poses at once, against OpenCV and against differences."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.many import errors, rotations
from chromadock.geometry.pose import Sighting

POINTS = DockGeometry.default().points
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
def test_errors_and_their_derivatives_are_those_of_the_projection(lens: str) -> None:
    rng = np.random.default_rng(1)
    matrix = np.array([[500.0, 0, 320], [0, 510, 240], [0, 0, 1]])
    camera = CameraModel(640, 480, matrix, LENSES[lens], lens=lens)
    R, t = rotations(rng.normal(0, 0.3, (5, 3))), rng.normal((0, 0, 3), 0.2, (5, 3))
    sigma_px = rng.uniform(0.2, 2, len(POINTS))
    sighting = Sighting(POINTS, rng.uniform(100, 300, (len(POINTS), 2)), sigma_px, camera)

    def off(R: np.ndarray, t: np.ndarray) -> np.ndarray:
        seen = np.array(
            [camera.project(POINTS @ one.T + place) for one, place in zip(R, t, strict=True)]
        )
        return ((seen - sighting.pixels) / sigma_px[:, None]).reshape(len(R), -1)

    error, jacobian = errors(sighting, R, t)
    assert error == pytest.approx(off(R, t), rel=1e-9)
    for k, step in enumerate(1e-6 * np.eye(6)):
        turn = rotations(step[None, 3:])[0]
        ahead, behind = off(turn @ R, t + step[:3]), off(turn.T @ R, t - step[:3])
        slope = (ahead - behind) / 2e-6
        assert jacobian[:, :, k] == pytest.approx(slope, rel=1e-4, abs=1e-3)
