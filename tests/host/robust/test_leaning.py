"""What may be wrong with all markers together, in a pose's covariance."""

from __future__ import annotations

import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.many import rotations
from chromadock.geometry.pose import Sighting, estimates
from chromadock.robust.weigh.leaning import leaning
from chromadock.robust.weigh.placement import PosePrior
from chromadock.robust.weigh.shape import ATTITUDE_RAD

CAMERA = CameraModel.nominal(640, 480)
POINTS = DockGeometry.default().points
PRIOR = PosePrior(500.0, 640 * 480.0, 3.0, np.eye(3), np.diag(ATTITUDE_RAD**2))
R = rotations(np.radians([[0.0, 20.0, 0.0]]))[0]


@pytest.mark.parametrize("count", [3, 4])
@pytest.mark.parametrize("range_m", [1.5, 4.0])
def test_what_may_make_the_dock_smaller_makes_its_range_less_sure(
    count: int, range_m: float
) -> None:
    """Of markers that may all be nearer to the middle by 4 %, one standard error: the range by
    about as much, for a tilt may take a part of it or add to it."""
    points = POINTS[:count] - POINTS[:count].mean(axis=0)
    pixels = CAMERA.project(points @ R.T + np.array([0.1, 0.0, range_m]))
    lean = -0.04 * (pixels - pixels.mean(axis=0))
    sighting = Sighting(points, pixels, np.full(count, 0.1), CAMERA, lean)
    for pose, unsure in zip(
        estimates(sighting), leaning(sighting, estimates(sighting), PRIOR), strict=True
    ):
        more = unsure.covariance - pose.covariance
        along = pose.t / np.linalg.norm(pose.t)
        assert np.sqrt(along @ more[:3, :3] @ along) == pytest.approx(0.04 * range_m, rel=0.4)
        # One error more, and no other.
        assert np.linalg.eigvalsh(more)[:-1] == pytest.approx(0, abs=1e-6)


def test_a_sighting_without_such_an_error_leaves_poses_as_they_are() -> None:
    points = POINTS - POINTS.mean(axis=0)
    pixels = CAMERA.project(points @ R.T + np.array([0.1, 0.0, 3.0]))
    sighting = Sighting(points, pixels, np.full(len(points), 0.1), CAMERA)
    poses = estimates(sighting)
    assert leaning(sighting, poses, PRIOR) is poses
