"""How surely the place of a dock with three markers is known, against how often it is wrong."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from chromadock import CameraModel
from chromadock.geometry.many import rotation_vectors, rotations
from chromadock.geometry.pose import Sighting, estimates
from chromadock.robust.frame.flux import Fluxes
from chromadock.robust.weigh.acceptance import MOST_DOUBT, PLACE_TOLERANCE
from chromadock.robust.weigh.placement import PosePrior, placement
from chromadock.robust.weigh.shape import ATTITUDE_RAD
from chromadock.robust.weigh.three import SAMPLES, Sample, sampled
from chromadock.robust.weigh.told import told

CAMERA = CameraModel.nominal(640, 480)
POINTS = 0.89 * np.array([(-0.5, -0.15, 0.0), (0.5, -0.15, 0.0), (-0.2, 0.3, 0.0)])
POINTS -= POINTS.mean(axis=0)
PRIOR = PosePrior(500.0, 640 * 480.0, 3.0, np.eye(3), np.diag(ATTITUDE_RAD**2))
CENTRE = np.zeros(3)
SIGMA_PX = 0.3
NO_DRIFT = np.zeros(3)


def seen(range_m: float, rng: np.random.Generator) -> tuple[Sighting, Fluxes, np.ndarray]:
    """A dock turned as the prior has it, its lamps somewhat unlike; where it is."""
    while True:
        R = rotations(rng.standard_normal((1, 3)) * ATTITUDE_RAD)[0]
        t = range_m * np.array([rng.uniform(-0.2, 0.2), rng.uniform(-0.15, 0.15), 1.0])
        markers = POINTS @ R.T + t
        at = CAMERA.project(markers)
        if ((at > 0) & (at < (639, 479))).all():
            break
    sighting = Sighting(POINTS, at + rng.normal(0, SIGMA_PX, (3, 2)), np.full(3, SIGMA_PX), CAMERA)
    flux = -2 * np.log(np.linalg.norm(markers, axis=1)) + rng.normal(0, 0.2, 3)
    return sighting, Fluxes(flux, np.full(3, 0.02)), t


def judged(
    range_m: tuple[float, float], count: int, bright: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of so many docks: doubts, whether the place is wrong, standard deviations of the place in
    shares of the range."""
    rng, rows = np.random.default_rng(5), []
    for _ in range(count):
        sighting, flux, t = seen(rng.uniform(*range_m), rng)
        poses = estimates(sighting)
        placed = placement(sighting, poses, PRIOR)
        flux_or_none = flux if bright else None
        _, poses, doubt = told(sighting, poses, placed, NO_DRIFT, flux_or_none, PRIOR, CENTRE)
        off = np.linalg.norm(poses[0].t - t) / np.linalg.norm(t)
        sigma = np.sqrt(np.trace(poses[0].covariance[:3, :3])) / np.linalg.norm(t)
        rows.append((doubt, off > PLACE_TOLERANCE, sigma))
    doubts, wrong, sigmas = np.array(rows).T
    return doubts, wrong > 0, sigmas


@pytest.mark.parametrize("range_m", [(0.8, 1.2), (1.5, 4.0)])
def test_as_many_are_wrong_as_their_doubt_says(
    range_m: tuple[float, float], record_property: Any
) -> None:
    doubts, wrong, _ = judged(range_m, 250, bright=True)
    record_property(
        "figure",
        f"doubt of three markers, simulated, {range_m[0]:g} to {range_m[1]:g} m: of {len(doubts)} "
        f"docks {wrong.sum()} are wrong, and {doubts.sum():.1f} by doubt",
    )
    assert abs(wrong.sum() - doubts.sum()) < 3 * np.sqrt((doubts * (1 - doubts)).sum()) + 1
    sure = doubts <= MOST_DOUBT
    assert sure.mean() > 0.7
    assert wrong[sure].mean() < 0.03


def test_brightness_tells_docks_that_places_alone_leave_open() -> None:
    dark, _, _ = judged((0.8, 3.0), 150, bright=False)
    bright, wrong, _ = judged((0.8, 3.0), 150, bright=True)
    assert (bright <= MOST_DOUBT).mean() > (dark <= MOST_DOUBT).mean() + 0.03
    assert wrong.sum() <= 3


def test_where_two_poses_become_one_the_error_stays_finite() -> None:
    """Of 250 near docks some are as good as on the dangerous cylinder, where the normal equations
    make the error as large as one likes."""
    _, _, sigmas = judged((0.8, 1.2), 250, bright=True)
    assert np.quantile(sigmas, 0.98) < 0.15


def test_the_sample_is_about_the_truth() -> None:
    rng = np.random.default_rng(1)
    sighting, flux, t = seen(2.0, rng)
    sample = sampled(sighting, np.full((SAMPLES, 3), SIGMA_PX), PRIOR, flux)
    assert sample is not None
    assert sample.weights.sum() == pytest.approx(1)
    fits = CAMERA.project((POINTS @ sample.R.transpose(0, 2, 1) + sample.t[:, None]).reshape(-1, 3))
    apart = np.linalg.norm(fits.reshape(-1, 3, 2) - sighting.pixels, axis=2)
    assert np.sqrt((apart**2).mean()) == pytest.approx(SIGMA_PX * np.sqrt(2), rel=0.15)
    assert np.linalg.norm(sample.weights @ sample.t - t) < 0.1


def test_moments_of_the_sample_become_the_covariance() -> None:
    rng = np.random.default_rng(2)
    sighting, _, _ = seen(2.0, rng)
    pose = estimates(sighting)[0]
    off = rng.multivariate_normal(np.zeros(6), np.diag([1, 4, 9, 1, 4, 9]) * 1e-6, 4000)
    R, t = rotations(off[:, 3:]) @ pose.R, pose.t + off[:, :3]
    sample = Sample(POINTS, R, t, np.full(4000, 1 / 4000))
    (known,) = sample.known((pose,))
    assert np.diag(known.covariance) == pytest.approx(np.array([1, 4, 9, 1, 4, 9]) * 1e-6, rel=0.1)
    assert rotation_vectors(known.R[None] @ pose.R.T) == pytest.approx(np.zeros((1, 3)))
    few = Sample(POINTS, R[:5], t[:5], np.full(5, 0.2))
    assert few.known((pose,))[0] is pose
