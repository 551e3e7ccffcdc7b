"""Which of the poses that four markers leave open is told."""

from __future__ import annotations

import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.many import rotations
from chromadock.geometry.pose import Estimate, Sighting, estimates
from chromadock.robust.frame.flux import Fluxes
from chromadock.robust.weigh.placement import PosePrior, placement
from chromadock.robust.weigh.shape import ATTITUDE_RAD
from chromadock.robust.weigh.told import told

CAMERA = CameraModel.nominal(640, 480)
DOCK = DockGeometry.default()
POINTS = DOCK.points - DOCK.centre
PRIOR = PosePrior(500.0, 640 * 480.0, 3.0, np.eye(3), np.diag(ATTITUDE_RAD**2))
CENTRE, NO_DRIFT = np.zeros(3), np.zeros(4)


def turned(yaw_deg: float) -> np.ndarray:
    return rotations(np.radians([[0.0, yaw_deg, 0.0]]))[0]


def far_dock(yaw_deg: float) -> Sighting:
    """At 6 m, known to a pixel: the other pose fits about as well."""
    pixels = CAMERA.project(POINTS @ turned(yaw_deg).T + np.array([0.1, 0.0, 6.0]))
    return Sighting(POINTS, pixels, np.full(4, 1.0), CAMERA)


def first(sighting: Sighting, fluxes: Fluxes | None) -> tuple[Estimate, float]:
    poses = estimates(sighting)
    assert len(poses) == 2
    placed = placement(sighting, poses, PRIOR)
    _, poses, doubt = told(sighting, poses, placed, NO_DRIFT, fluxes, PRIOR, CENTRE)
    return poses[0], doubt


@pytest.mark.parametrize("yaw_deg", [-20.0, 20.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_brightness_says_to_which_side_a_far_dock_is_turned(yaw_deg: float, side: float) -> None:
    """Whichever it says: places do not contradict."""
    sighting = far_dock(yaw_deg)
    seen = turned(side * 20.0)
    range_m = np.linalg.norm(POINTS @ seen.T + np.array([0.1, 0.0, 6.0]), axis=1)
    bright = Fluxes(-2.5 * np.log(range_m), np.full(4, 0.02))
    pose, _ = first(sighting, bright)
    assert np.sign(pose.R[0, 2]) == np.sign(seen[0, 2])


def test_errors_that_grow_make_poses_less_sure() -> None:
    sighting = far_dock(20.0)
    poses = estimates(sighting)
    placed = placement(sighting, poses, PRIOR)
    as_told, sure, _ = told(sighting, poses, placed, NO_DRIFT, None, PRIOR, CENTRE)
    drawn, unsure, _ = told(sighting, poses, placed, np.full(4, 3.0), None, PRIOR, CENTRE)
    assert (drawn.sigma_px > as_told.sigma_px).all()
    assert np.trace(unsure[0].covariance) > np.trace(sure[0].covariance)
