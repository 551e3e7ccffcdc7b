"""A dock is found and followed alike wherever its frame has its origin."""

from __future__ import annotations

from functools import cache

import cv2
import numpy as np
import pytest
from robust_composites import in_plain_water

from chromadock import CameraModel, Detector, DockGeometry
from chromadock.results.detection import Detection
from chromadock.rotation import matrix_from_quaternion

CAMERA = CameraModel.nominal(640, 480)
DOCK = DockGeometry.default()
FRAMES = 10
HIDDEN = 6
"""The frame with a marker out."""


def pose(k: int) -> tuple[np.ndarray, np.ndarray]:
    R = cv2.Rodrigues(np.radians([3.0, 12.0 - k, 2.0]))[0]
    return R, np.array([0.2 - 0.01 * k, 0.1, 3.0 - 0.05 * k])


@cache
def picture(k: int) -> np.ndarray:
    R, t = pose(k)
    points = DOCK.points[1:] if k == HIDDEN else DOCK.points
    return in_plain_water(points @ R.T + t, CAMERA, k)


def moved(origin: np.ndarray, largest_range_m: float | None = None) -> DockGeometry:
    """The same markers, of a frame with its origin there."""
    points = DOCK.points - origin
    return DockGeometry(DOCK.names, points, largest_range_m=largest_range_m)


def followed(dock: DockGeometry) -> list[Detection]:
    detector = Detector(CAMERA, dock)
    return [detector.process(picture(k), 0.1 * k) for k in range(FRAMES)]


@cache
def followed_about_the_centre() -> list[Detection]:
    return followed(DOCK)


@pytest.mark.parametrize("origin", [(5, 0, 0), (0, 20, 0), (0, 0, -20), (-300, 40, 500)])
def test_a_dock_is_followed_alike_wherever_its_origin_is(origin: tuple[float, ...]) -> None:
    """To a micrometre, with the track, through a frame with a marker out."""
    shift, told = np.array(origin, float), 0
    pairs = zip(followed_about_the_centre(), followed(moved(shift)), strict=True)
    for k, (near, far) in enumerate(pairs):
        assert near.state == far.state == ("partial" if k == HIDDEN else "found")
        assert near.markers == far.markers
        assert far.evidence == pytest.approx(near.evidence, abs=1e-6)
        assert near.track is not None and far.track is not None
        assert near.track.state == far.track.state
        for one, other in ((near.pose, far.pose), (near.track.pose, far.track.pose)):
            assert (one is None) == (other is None)
            if one is None or other is None:
                continue
            told += 1
            R = matrix_from_quaternion(one.q_wxyz)
            np.testing.assert_allclose(matrix_from_quaternion(other.q_wxyz), R, atol=1e-6)
            np.testing.assert_allclose(
                other.t, one.t + R @ shift, atol=1e-6 * (1 + abs(shift).max())
            )
    assert told >= FRAMES + 5
    assert near.track.state == "tracking"


@pytest.mark.parametrize("origin", [(5, 0, 0), (0, 20, 0), (0, 0, -20)])
def test_the_papers_method_finds_it_alike_too(origin: tuple[float, ...]) -> None:
    frame, shift = picture(2), np.array(origin, float)
    near, far = (
        Detector(CAMERA, dock, "paper", independent=True).process(frame, 0.0).pose
        for dock in (DOCK, moved(shift))
    )
    assert near is not None and far is not None
    R = matrix_from_quaternion(near.q_wxyz)
    np.testing.assert_allclose(far.t, near.t + R @ shift, atol=1e-6)
    assert far.reprojection_px == pytest.approx(near.reprojection_px)


@pytest.mark.parametrize("origin", [(0, 0, 0), (0, 0, -20), (0, 0, 2.9)])
@pytest.mark.parametrize("method", ["robust", "paper"])
def test_the_largest_range_is_to_the_markers(origin: tuple[float, ...], method: str) -> None:
    frame = picture(2)
    for largest_range_m, there in ((3.2, True), (2.6, False)):
        dock = moved(np.array(origin, float), largest_range_m)
        seen = Detector(CAMERA, dock, method, independent=True).process(frame, 0.0)
        assert seen.found == there


def test_a_track_does_not_go_beyond_the_largest_range() -> None:
    """A vehicle that backs off: frames 2.9 m, then 3.3 m, from a dock of 3.1 m."""
    detector = Detector(CAMERA, moved(np.zeros(3), 3.1))
    states = []
    for k in range(10):
        R, t = pose(2)
        far = t * ((2.9 if k < 6 else 3.3) / np.linalg.norm(t))
        frame = in_plain_water(DOCK.points @ R.T + far, CAMERA, k)
        states.append(detector.process(frame, 0.1 * k).state)
    assert states == ["found"] * 6 + ["not_found"] * 4
