from __future__ import annotations

from itertools import combinations

import cv2
import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.pose import Estimate, Sighting, estimates, projected, refined
from chromadock.geometry.profile import widened

CAMERA = CameraModel.nominal(640, 480)
RECTANGLE = DockGeometry.default().points
FIVE = np.vstack([RECTANGLE, (0.0, 0.0, -0.3)])
THREE = RECTANGLE[:3]
COVERED = 12.59  # chi-square with six degrees of freedom, 95%


def rotation(pitch: float, yaw: float, roll: float) -> np.ndarray:
    return cv2.Rodrigues(np.radians([pitch, yaw, roll]).astype(float))[0]


def sighting(
    points: np.ndarray,
    R: np.ndarray,
    t: np.ndarray,
    sigma_px: float = 0.2,
    rng: np.random.Generator | None = None,
    camera: CameraModel = CAMERA,
) -> Sighting:
    pixels = camera.project(points @ R.T + t)
    if rng is not None:
        pixels = pixels + rng.normal(0, sigma_px, pixels.shape)
    return Sighting(points, pixels, np.full(len(points), sigma_px), camera)


@pytest.mark.parametrize("points", [RECTANGLE, FIVE, THREE])
@pytest.mark.parametrize("yaw", [-30, -12, 8, 25])
@pytest.mark.parametrize("t", [(0, 0, 1.2), (0.3, -0.2, 3.0), (-0.5, 0.4, 5.0)])
def test_exact_pixels_give_the_pose_back(
    points: np.ndarray, yaw: float, t: tuple[float, ...]
) -> None:
    R = rotation(6, yaw, -4)
    found = estimates(sighting(points, R, np.array(t)))
    nearest = min(found, key=lambda e: float(np.abs(e.R - R).max()))
    assert nearest.t == pytest.approx(t, abs=1e-3)
    assert pytest.approx(R, abs=2e-3) == nearest.R
    assert nearest.chi_square == pytest.approx(0, abs=1e-3)


def test_a_lens_that_bends_is_seen_through() -> None:
    distortion = np.array([-0.28, 0.09, 0.001, -0.0005, -0.01])
    camera = CameraModel(640, 480, CAMERA.matrix, distortion)
    R, t = rotation(5, 20, -6), np.array([0.35, -0.25, 1.3])
    best, *_ = estimates(sighting(RECTANGLE, R, t, camera=camera))
    assert best.t == pytest.approx(t, abs=1e-3)
    assert pytest.approx(R, abs=2e-3) == best.R


def test_from_afar_a_plane_has_two_poses_and_a_dock_with_depth_one() -> None:
    R, t = rotation(3, 18, 2), np.array([0.4, 0.1, 5.0])
    rng = np.random.default_rng(3)
    # At 5 m noise leaves no second minimum in a third of the views.
    far = np.array([0.4, 0.1, 7.0])
    both = [len(estimates(sighting(RECTANGLE, R, far, 0.3, rng))) for _ in range(40)]
    assert np.mean(np.array(both) == 2) > 0.8
    ways = []
    for _ in range(40):
        best, *others = estimates(sighting(FIVE, R, t, 0.3, rng))
        ways.append(np.degrees(np.linalg.norm(cv2.Rodrigues(best.R @ R.T)[0])))
        assert all(other.chi_square > best.chi_square + 10 for other in others)
    assert np.median(ways) < 2


def test_a_dock_with_depth_straight_ahead_always_has_a_pose() -> None:
    """And none that fits worse than that downhill of the truth; much noise."""
    rng = np.random.default_rng(24)
    for _ in range(300):
        R, t = rotation(0, rng.uniform(-20, 20), 0), np.array([0, 0, rng.uniform(1, 7)])
        seen = sighting(FIVE, R, t, rng.choice([0.2, 0.5, 1.0]), rng)
        found, best = estimates(seen), refined(seen, R, t)
        assert found and best is not None
        assert found[0].chi_square < best.chi_square + 0.1


@pytest.mark.parametrize("range_m", [1.0, 2.0, 4.0])
def test_a_nearly_straight_line_of_markers_always_has_a_pose(range_m: float) -> None:
    """Its markers lie in a plane that is seen from its edge, where solvers for planes fail."""
    line = np.array([(-0.45, 0, 0.09), (-0.15, 0, 0), (0.15, 0, 0), (0.45, 0, 0.09)])
    rng = np.random.default_rng(1)
    for _ in range(60):
        R = rotation(*rng.uniform(-1, 1, 3) * (15, 40, 20))
        t = np.array([*rng.uniform(-0.1, 0.1, 2), 1.0]) * range_m
        poses = estimates(sighting(line, R, t, 0.2, rng))
        assert poses
        assert min(pose.distance(R, t) for pose in poses) < 30


@pytest.mark.parametrize("points", [RECTANGLE, THREE])
def test_one_pose_is_not_told_twice(points: np.ndarray) -> None:
    """Of a far plane that looks face on, and of three markers, searches end in a flat valley."""
    rng = np.random.default_rng(6)
    for _ in range(300):
        R = rotation(*rng.normal(0, (10, 23, 10)))
        t = np.array([*rng.uniform(-0.2, 0.2, 2), 1.0]) * rng.uniform(0.8, 6)
        poses = estimates(sighting(points, R, t, 0.3, rng))
        for one, other in combinations(poses, 2):
            assert max(one.distance(other.R, other.t), other.distance(one.R, one.t)) > 0.2


def test_a_search_that_was_cut_short_is_no_second_pose() -> None:
    """It would stand close to the first, and fit worse."""
    rng = np.random.default_rng(31)
    for _ in range(300):
        R = rotation(*rng.uniform(-1, 1, 3) * (8, 20, 8))
        t = np.array([rng.uniform(-0.4, 0.4), rng.uniform(-0.3, 0.3), 1])
        first, *others = estimates(sighting(FIVE, R, t, 0.2, rng))
        for other in others:
            assert np.linalg.norm(cv2.Rodrigues(first.R @ other.R.T)[0]) > np.radians(1)


def test_the_second_pose_is_the_first_tilted_the_other_way() -> None:
    R, t = rotation(0, 25, 0), np.array([0.0, 0.0, 4.0])
    first, second = estimates(sighting(RECTANGLE, R, t, 0.3, np.random.default_rng(5)))
    normals = first.R[:, 2], second.R[:, 2]
    assert normals[0][0] * normals[1][0] < 0
    assert first.chi_square <= second.chi_square


def test_both_are_minima() -> None:
    rng = np.random.default_rng(6)
    for _ in range(20):
        R, t = rotation(*rng.uniform(-15, 15, 3)), np.array([0.2, -0.1, rng.uniform(1, 6)])
        seen = sighting(RECTANGLE, R, t, 0.3, rng)
        for estimate in estimates(seen):
            for step in rng.normal(0, 1e-3, (20, 6)):
                moved = chi_square(
                    seen, cv2.Rodrigues(step[3:])[0] @ estimate.R, estimate.t + step[:3]
                )
                assert moved > estimate.chi_square - 1e-2


def test_derivatives_are_those_of_the_projection() -> None:
    R, t = rotation(7, -20, 11), np.array([0.3, -0.2, 1.4])
    seen = projected(FIVE, R, t, CAMERA)
    assert seen is not None
    for axis, step in enumerate(1e-6 * np.eye(6)):
        turned, moved = cv2.Rodrigues(step[3:])[0] @ R, t + step[:3]
        ahead = CAMERA.project(FIVE @ turned.T + moved)
        assert seen[1][:, :, axis] == pytest.approx((ahead - seen[0]) / 1e-6, rel=1e-3, abs=0.02)


@pytest.mark.parametrize(("points", "range_m"), [(RECTANGLE, 1.5), (FIVE, 1.5), (FIVE, 5.0)])
def test_the_covariance_is_that_of_repeated_measurements(
    points: np.ndarray, range_m: float
) -> None:
    rng = np.random.default_rng(7)
    R, t = rotation(4, 20, -3), np.array([0.1, 0.05, range_m])
    best = [estimates(sighting(points, R, t, 0.2, rng))[0] for _ in range(400)]
    errors = np.array([[*(e.t - t), *cv2.Rodrigues(e.R @ R.T)[0].ravel()] for e in best])
    expected = refined(sighting(points, R, t, 0.2), R, t)
    assert expected is not None
    # In units of the expected errors and their correlations the scatter is a unit matrix.
    whitened = errors @ np.linalg.cholesky(expected.information)
    assert whitened.T @ whitened / len(errors) == pytest.approx(np.eye(6), abs=0.3)


def test_three_markers_and_a_start_give_the_pose_nearby() -> None:
    R, t = rotation(3, 12, -5), np.array([0.2, 0.1, 2.5])
    near = rotation(5, 15, -4), t + np.array([0.05, -0.05, 0.1])
    pose = refined(sighting(THREE, R, t), *near)
    assert pose is not None
    assert pose.t == pytest.approx(t, abs=1e-3)


def test_one_of_the_poses_of_three_markers_is_near_the_true_one(record_property: object) -> None:
    points = np.array([(-0.5, 0.2, 0.0), (0.6, 0.1, 0.1), (0.0, -0.4, -0.2)])
    rng, inside, counts = np.random.default_rng(9), [], set()
    for _ in range(150):
        R = rotation(*rng.uniform(-1, 1, 3) * (8, 25, 8))
        t = np.array([rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), 1]) * rng.uniform(1, 6)
        found = estimates(sighting(points, R, t, 0.2, rng))
        inside.append(min(e.distance(R, t) for e in found) < COVERED)
        counts.add(len(found))
        turns = [np.trace(e.R) for e in found]
        assert turns == sorted(turns, reverse=True)
    record_property("figure", f"pose of three markers: {np.mean(inside):.3f} inside a 95% region")
    assert np.mean(inside) > 0.85
    assert counts <= {1, 2, 3, 4} and max(counts) > 2


def test_a_dock_behind_the_camera_is_no_pose() -> None:
    seen = sighting(RECTANGLE, np.eye(3), np.array([0, 0, 2.0]))
    assert refined(seen, np.eye(3), np.array([0.0, 0.0, -2.0])) is None
    assert projected(RECTANGLE, np.eye(3), np.array([0.0, 0.0, -2.0]), CAMERA) is None


def test_an_estimate_reads_as_a_pose() -> None:
    R, t = rotation(0, 10, 0), np.array([0.1, 0.2, 2.0])
    pose = Estimate(R, t, 0.5, 0.3, np.eye(6)).pose()
    assert pose.t == pytest.approx(t)
    assert pose.q_wxyz == pytest.approx((np.cos(np.radians(5)), 0, np.sin(np.radians(5)), 0))
    assert pose.alternative is None


def chi_square(seen: Sighting, R: np.ndarray, t: np.ndarray) -> float:
    off = seen.camera.project(seen.points_dock @ R.T + t) - seen.pixels
    return float(((off / seen.sigma_px[:, None]) ** 2).sum())


def test_places_that_fit_no_dock_give_no_pose_in_the_distance() -> None:
    """Any three places: a search that finds no dock nearby shrinks it to a point."""
    rng, count = np.random.default_rng(0), 0
    points = DockGeometry.default().points[:3]
    for _ in range(300):
        pixels = rng.uniform((200, 150), (440, 330), (3, 2))
        for pose in estimates(Sighting(points, pixels, rng.uniform(0.1, 0.4, 3), CAMERA)):
            count += 1
            assert 0 < pose.t[2] < 1e4
            wide = widened(Sighting(points, pixels, np.full(3, 0.3), CAMERA), pose)
            for spread in (pose.covariance, wide.covariance):
                assert np.isfinite(spread).all()
                assert np.linalg.eigvalsh(spread)[0] > 0
    assert count > 300


def test_what_a_pose_leaves_unknown_has_a_large_variance() -> None:
    information = np.diag([1.0, 1.0, 1.0, 1.0, 1.0, 0.0])
    variances = np.diag(
        Estimate(np.eye(3), np.array([0, 0, 1.0]), 0.0, 0.0, information).covariance
    )
    assert variances[:5] == pytest.approx(1.0)
    assert variances[5] > 1e9
