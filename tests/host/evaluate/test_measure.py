from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from chromadock.evaluate.measure import hue_difference_deg, measured
from chromadock.evaluate.target import Target
from chromadock.look import Found
from chromadock.results.pose import Pose
from chromadock.rotation import quaternion_from_matrix

NAMES = ("a", "b", "c", "d")
PIXELS = np.array([(100.0, 100), (300, 100), (100, 130), (300, 130)])
TARGET = Target(NAMES, PIXELS, np.eye(3), np.array([0.0, 0, 4]), 15.0)
EMPTY = np.zeros((480, 640), np.uint8)


def found(shift: np.ndarray, t=(0.0, 0, 4), R=None) -> Found:
    places = PIXELS + shift
    markers = {name: (float(x), float(y)) for name, (x, y) in zip(NAMES, places, strict=True)}
    rotation = np.eye(3) if R is None else R
    return Found("found", 0.0, (), markers, Pose(t, quaternion_from_matrix(rotation), 0.1))


def off(marker: int, pixels: float) -> np.ndarray:
    shift = np.zeros((4, 2))
    shift[marker, 0] = pixels
    return shift


@pytest.mark.parametrize(
    ("pixels", "correct", "false"),
    [(0, True, False), (2.9, True, False), (3.1, False, False), (15.1, False, True)],
)
def test_one_marker_decides_whether_a_dock_is_right_or_false(
    pixels: float, correct: bool, false: bool
) -> None:
    row = measured(found(off(2, pixels)), EMPTY, TARGET)
    assert row["found"]
    assert (row["correct"], row["false_dock"]) == (correct, false)
    assert (row["range_error"] is None) == (not correct)


def test_a_pose_is_wrong_with_a_marker_where_none_is_or_in_another_place() -> None:
    assert not measured(found(off(2, 3.1), (0.0, 0, 4.19)), EMPTY, TARGET)["wrong_pose"]
    assert measured(found(off(2, 15.1)), EMPTY, TARGET)["wrong_pose"]
    assert measured(found(off(2, 0.0), (0.0, 0, 4.21)), EMPTY, TARGET)["wrong_pose"]
    untold = replace(found(off(2, 15.1)), state="uncertain", pose=None)
    assert not measured(untold, EMPTY, TARGET)["wrong_pose"]


def test_no_dock_is_neither_right_nor_false() -> None:
    row = measured(Found("not_found", 0.0), EMPTY, TARGET)
    assert not (row["found"] or row["correct"] or row["false_dock"] or row["wrong_pose"])
    assert row["range_true_m"] == 4


def test_errors_of_a_pose_are_its_range_direction_and_turn() -> None:
    turn = cv2.Rodrigues(np.array([0, np.radians(7.0), 0]))[0]
    t = 4.2 * np.array([np.sin(np.radians(3)), 0, np.cos(np.radians(3))])
    row = measured(found(np.zeros((4, 2)), tuple(t), turn), EMPTY, TARGET)
    assert row["range_error"] == pytest.approx(0.05)
    assert row["bearing_error_deg"] == pytest.approx(3)
    assert row["attitude_error_deg"] == pytest.approx(7)


def test_passed_pixels_count_outside_the_markers_circles_alone() -> None:
    mask = EMPTY.copy()
    mask[130, 90:111] = 255  # within 15 px of marker c
    mask[400, 0:10] = 255
    row = measured(Found("not_found", 0.0), mask, TARGET)
    assert row["passed"] == pytest.approx(31 / mask.size)
    assert row["passed_outside"] == pytest.approx(10 / mask.size)


def test_markers_behind_the_camera_or_far_aside_have_no_circle() -> None:
    pixels = np.array([(np.nan, np.nan), (1e9, 0), (-1e9, 3), (100, 100)])
    target = Target(NAMES, pixels, np.eye(3), np.array([0.0, 0, -4]), 15.0)
    row = measured(Found("not_found", 0.0), EMPTY + np.uint8(255), target)
    assert 0.99 < row["passed_outside"] < row["passed"] == 1


@pytest.mark.parametrize(
    ("a", "b", "apart"), [(10, 350, 20), (0, 180, 180), (90, 90, 0), (359.5, 0.5, 1)]
)
def test_hues_differ_round_the_circle(a: float, b: float, apart: float) -> None:
    assert hue_difference_deg(a, b) == pytest.approx(apart)
    assert hue_difference_deg(b, a) == pytest.approx(apart)
