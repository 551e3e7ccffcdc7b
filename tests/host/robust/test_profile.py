"""The covariance that admits what the markers do, on views with pixel noise of a known size."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.geometry import profile
from chromadock.geometry.many import Normal, normal_equations
from chromadock.geometry.pose import Estimate, Sighting, estimates
from chromadock.geometry.profile import widened

CAMERA = CameraModel.nominal(640, 480)
RECTANGLE = DockGeometry.default().points
COVERED = 12.59  # chi-square with six degrees of freedom, 95%
SIGMA_PX = 0.2


def view(range_m: float, rng: np.random.Generator) -> tuple[Sighting, np.ndarray, np.ndarray]:
    turns = np.radians(rng.uniform(-1, 1, 3) * (8, 20, 8))
    R = cv2.Rodrigues(turns)[0]
    t = np.array([*rng.uniform(-0.2, 0.2, 2), 1]) * range_m
    pixels = CAMERA.project(RECTANGLE @ R.T + t) + rng.normal(0, SIGMA_PX, (4, 2))
    return Sighting(RECTANGLE, pixels, np.full(4, SIGMA_PX), CAMERA), R, t


def share_inside(range_m: float, count: int, wide: bool) -> float:
    rng, inside = np.random.default_rng(8), []
    for _ in range(count):
        sighting, R, t = view(range_m, rng)
        poses: list[Estimate] = list(estimates(sighting))
        if wide:
            poses = [widened(sighting, pose) for pose in poses]
        inside.append(min(pose.distance(R, t) for pose in poses) < COVERED)
    return float(np.mean(inside))


@pytest.mark.parametrize("range_m", [1.0, 2.0, 3.0, 4.0, 5.0, 7.0])
def test_the_true_pose_is_in_the_region_of_one_of_the_two(
    range_m: float, record_property: Any
) -> None:
    inside = share_inside(range_m, 200, wide=True)
    record_property("figure", f"pose: {inside:.3f} inside the 95% region at {range_m:g} m")
    assert 0.9 <= inside <= 0.99


def test_the_curvature_alone_would_promise_too_much(record_property: Any) -> None:
    inside = share_inside(5.0, 200, wide=False)
    record_property("figure", f"pose: {inside:.3f} inside the linear 95% region at 5 m")
    assert inside < 0.85


def test_a_pose_that_is_well_known_stays_as_it_is() -> None:
    sighting, *_ = view(1.0, np.random.default_rng(1))
    (pose,) = estimates(sighting)
    assert widened(sighting, pose) is pose


def test_the_region_only_grows() -> None:
    rng = np.random.default_rng(2)
    for _ in range(20):
        sighting, *_ = view(4.0, rng)
        for pose in estimates(sighting):
            grown = widened(sighting, pose).covariance - pose.covariance
            scale = np.sqrt(np.diag(pose.covariance))
            assert np.linalg.eigvalsh(grown / np.outer(scale, scale)).min() > -1e-6


def test_a_refit_that_runs_into_the_lens_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    """Clutter that looks like a dock turned by 60 degrees may do that, one frame in a thousand: a
    marker comes so near to the lens that its derivatives by one place hide all others."""
    sighting, *_ = view(4.0, np.random.default_rng(3))
    pose, calls = estimates(sighting)[0], 0

    def run_away(*poses: Any) -> Normal:
        nonlocal calls
        normal = normal_equations(*poses)
        calls += 1
        if calls > 1:
            normal.information[0] = 0.0
            normal.information[0, :3, :3] = 1e28
        return normal

    monkeypatch.setattr(profile, "normal_equations", run_away)
    axes, angles = np.eye(3)[:2], np.array([0.2, 0.2])
    _, chi_square = profile._profile(sighting, pose, axes, angles)
    assert np.isinf(chi_square).tolist() == [True, False]
