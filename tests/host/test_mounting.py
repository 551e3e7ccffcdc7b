"""The extrinsics that a user gives, and rotations in general."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from track_truth import rotation

from chromadock import ChromadockError, Mounting
from chromadock.mounting import R_BODY_CAMERA_FORWARD, mounting_or_default
from chromadock.rotation import checked_rotation, matrix_from_quaternion

TILTED = rotation(12, -31, 170)
NO_ROTATIONS = {
    "scaled": (2 * np.eye(3), "not orthonormal"),
    "sheared": (np.eye(3) + 0.01 * np.eye(3)[[1, 0, 2]], "not orthonormal"),
    "reflected": (np.diag([1.0, 1.0, -1.0]), "reflection"),
    "of no number": (np.full((3, 3), np.nan), "finite"),
    "infinite": (np.diag([1.0, np.inf, 1.0]), "finite"),
    "a vector": (np.ones(3), "shape"),
    "a transform": (np.eye(4), "shape"),
    "a scalar": (1.0, "shape"),
    "a word": ("forward", "no matrix of numbers"),
    "ragged": ([[1, 0, 0], [0, 1], [0, 0, 1]], "no matrix of numbers"),
    "singular": (np.zeros((3, 3)), "not orthonormal"),
}


@pytest.mark.parametrize("what", NO_ROTATIONS)
@pytest.mark.parametrize("which", ["R_body_camera", "R_level_dock"])
def test_what_is_no_rotation_is_refused_in_one_line(which: str, what: str) -> None:
    matrix, fault = NO_ROTATIONS[what]
    with pytest.raises(ChromadockError, match=fault) as error:
        Mounting(**{which: matrix})  # type: ignore[arg-type]
    words = str(error.value)
    assert which in words and "give a 3x3 rotation" in words
    assert "\n" not in words


def test_a_rotation_written_with_four_digits_is_taken_and_made_exact() -> None:
    R = Mounting(np.round(TILTED, 4)).R_body_camera
    np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(R, TILTED, atol=1e-4)
    assert np.linalg.det(R) == pytest.approx(1.0)


def test_what_a_mounting_is_made_of_cannot_change_it() -> None:
    given = TILTED.copy()
    mounting = Mounting(R_level_dock=given)
    given[:] = 0.0
    np.testing.assert_allclose(mounting.R_level_dock, TILTED, atol=1e-12)
    with pytest.raises(ValueError, match="read-only"):
        mounting.R_level_dock[0, 0] = 2.0


def test_none_is_a_camera_ahead_and_a_level_dock() -> None:
    mounting = mounting_or_default(None)
    np.testing.assert_array_equal(mounting.R_body_camera, R_BODY_CAMERA_FORWARD)
    np.testing.assert_array_equal(mounting.R_level_dock, np.eye(3))


def test_a_rotation_is_named_where_it_is_refused() -> None:
    with pytest.raises(ChromadockError, match=r"^R_left_right is a reflection"):
        checked_rotation(-np.eye(3), "R_left_right")


@pytest.mark.parametrize("q", [(0, 0, 0, 0), (1, 0, 0), (np.nan, 0, 0, 1), (np.inf, 0, 0, 1)])
def test_what_is_no_quaternion_is_refused(q: Any) -> None:
    with pytest.raises(ChromadockError, match="quaternion"):
        matrix_from_quaternion(q)
