from __future__ import annotations

import cv2
import numpy as np
import pytest

from chromadock import CameraModel, ChromadockError, DockGeometry
from chromadock.paper.constellation import (
    CORNERS,
    Rectangle,
    corners,
    four_blobs,
    right_triangles,
)

RATIO = 0.890 / 0.127


def dock_pixels(
    range_m: float = 2.0, yaw: float = 0.0, pitch: float = 0.0, roll: float = 0.0
) -> np.ndarray:
    """The default dock's corners as a 640 x 480 camera sees them, in CORNERS' order."""
    R = cv2.Rodrigues(np.radians([pitch, yaw, roll]))[0]
    points = DockGeometry.default().points @ R.T + (0, 0, range_m)
    return CameraModel.nominal(640, 480).project(points)


def test_the_default_dock_is_a_rectangle_with_the_papers_ratio() -> None:
    rectangle = Rectangle.of(DockGeometry.default())
    assert rectangle.ratio == pytest.approx(RATIO)
    names = [DockGeometry.default().names[rectangle.corner[c]] for c in CORNERS]
    assert tuple(names) == CORNERS


@pytest.mark.parametrize(
    "text",
    [
        [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
        [(0, 0, 0), (1, 0, 0), (0, 0.2, 0), (1, 0.2, 0.3)],
        [(0, 0, 0), (1, 0, 0), (0.3, 0.2, 0), (1.3, 0.2, 0)],
        [(0, 0, 0), (1, 0, 0), (0, 0.2, 0), (1, 0.5, 0)],
    ],
    ids=["three markers", "out of plane", "parallelogram", "trapezium"],
)
def test_other_shapes_are_refused(text: list[tuple[float, float, float]]) -> None:
    dock = DockGeometry(tuple(f"m{i}" for i in range(len(text))), np.array(text, float))
    with pytest.raises(ChromadockError, match="rectangle"):
        Rectangle.of(dock)


@pytest.mark.parametrize("roll", [-10, 0, 7])
@pytest.mark.parametrize("yaw", [-15, 0, 15])
def test_the_dock_is_found_among_other_spots(yaw: float, roll: float) -> None:
    pixels = dock_pixels(yaw=yaw, roll=roll)
    clutter = np.array([(50, 60), (400, 90), (77, 400), (590, 333), (300, 20)])
    points = np.concatenate([clutter[:3], pixels, clutter[3:]])
    chosen = four_blobs(right_triangles(points, RATIO))
    assert chosen is not None
    assert sorted(chosen) == [3, 4, 5, 6]
    seen = corners(points[list(chosen)])
    assert seen is not None
    assert [chosen[seen[c]] for c in CORNERS] == [3, 4, 5, 6]


def test_three_corners_are_not_enough() -> None:
    error = right_triangles(dock_pixels()[:3], RATIO)
    assert np.isfinite(error).any()
    assert four_blobs(error) is None


def test_a_rectangle_of_another_ratio_is_none() -> None:
    points = np.array([(0, 0), (100, 0), (0, 50), (100, 50)], float)
    assert not np.isfinite(right_triangles(points, RATIO)).any()


def test_no_points_and_equal_points_are_no_constellation() -> None:
    assert four_blobs(right_triangles(np.empty((0, 2)), RATIO)) is None
    assert four_blobs(right_triangles(np.zeros((1, 2)), RATIO)) is None


def test_points_that_would_be_two_corners_are_refused() -> None:
    assert corners(np.array([(0, 0), (1, 1), (2, 2), (3, 3)], float)) is None
