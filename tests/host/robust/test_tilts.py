"""How surely a far dock's place is known, against how often it is wrong."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.many import rotations
from chromadock.geometry.pose import Estimate, Sighting, estimates
from chromadock.robust.weigh.acceptance import PLACE_TOLERANCE
from chromadock.robust.weigh.placement import PosePrior
from chromadock.robust.weigh.shape import ATTITUDE_RAD
from chromadock.robust.weigh.tilts import doubt_over_tilts

CAMERA = CameraModel.nominal(640, 480)
POINTS = DockGeometry.default().points
PRIOR = PosePrior(500.0, 640 * 480.0, 3.0, np.eye(3), np.diag(ATTITUDE_RAD**2))
CENTRE = np.zeros(3)
SIGMA_PX = 0.3


def seen(
    range_m: float, rng: np.random.Generator, count: int = 4
) -> tuple[Sighting, Estimate, np.ndarray]:
    """A dock turned as the prior has it: its markers, the pose that fits best, where it is."""
    R = rotations(rng.standard_normal((1, 3)) * ATTITUDE_RAD)[0]
    t = range_m * np.array([rng.uniform(-0.3, 0.3), rng.uniform(-0.2, 0.2), 1.0])
    pixels = CAMERA.project(POINTS[:count] @ R.T + t) + rng.normal(0, SIGMA_PX, (count, 2))
    sighting = Sighting(POINTS[:count], pixels, np.full(count, SIGMA_PX), CAMERA)
    return sighting, estimates(sighting)[0], t


def test_of_far_docks_as_many_are_wrong_as_their_doubt_says(record_property: Any) -> None:
    rng, doubts, wrong = np.random.default_rng(0), [], []
    for _ in range(200):
        sighting, told, t = seen(rng.uniform(4, 8), rng)
        doubt = doubt_over_tilts(sighting, told, PRIOR, CENTRE)
        if doubt is not None:
            doubts.append(doubt)
            wrong.append(np.linalg.norm(told.t - t) > PLACE_TOLERANCE * np.linalg.norm(told.t))
    record_property(
        "figure",
        f"doubt over tilts, simulated: of {len(doubts)} far docks {sum(wrong)} are wrong, "
        f"and {sum(doubts):.1f} by doubt",
    )
    assert len(doubts) > 100
    spread = np.sqrt(sum(d * (1 - d) for d in doubts))
    assert abs(sum(wrong) - sum(doubts)) < 3 * spread
    sure = np.array(doubts) < np.median(doubts)
    assert np.mean(np.array(wrong)[sure]) < np.mean(np.array(wrong)[~sure])


def test_a_near_dock_is_too_well_known_for_the_lattice() -> None:
    sighting, told, _ = seen(0.8, np.random.default_rng(1))
    assert doubt_over_tilts(sighting, told, PRIOR, CENTRE) is None


def test_three_markers_leave_poses_open_between_which_no_tilts_lie() -> None:
    sighting, told, _ = seen(5.0, np.random.default_rng(2), count=3)
    assert doubt_over_tilts(sighting, told, PRIOR, CENTRE) is None


@pytest.mark.parametrize("farther", [1.12, 1.5])
def test_a_pose_told_at_another_place_is_doubted_wholly(farther: float) -> None:
    sighting, told, t = seen(6.0, np.random.default_rng(4))
    doubt = doubt_over_tilts(sighting, replace(told, t=farther * t), PRIOR, CENTRE)
    assert doubt is not None and doubt > 0.99


def test_a_point_before_the_dock_is_doubted_by_how_far_the_tilt_moves_it() -> None:
    """Of four far markers the centroid's place is better known than that of a point a metre off,
    which goes aside with each turn of the dock."""
    sighting, told, _ = seen(5.0, np.random.default_rng(1))
    centre = doubt_over_tilts(sighting, told, PRIOR, CENTRE)
    before = doubt_over_tilts(sighting, told, PRIOR, np.array([0.0, 0.0, -2.0]))
    assert centre is not None and before is not None
    assert centre < 0.05
    assert before > 0.5
