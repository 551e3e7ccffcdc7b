from __future__ import annotations

import math
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from search_reference import log_looks, log_normal

from chromadock import CameraModel, DockGeometry
from chromadock.geometry.many import rotations
from chromadock.geometry.pose import Estimate, Sighting, estimates, projected
from chromadock.robust.find.guided import HIDDEN, Expectation, Guess
from chromadock.robust.frame.peaks import Peaks
from chromadock.robust.weigh.evidence import PlacedPeaks, placed_along

CAMERA = CameraModel.nominal(640, 480)
POINTS = DockGeometry.default().points
R, T = np.eye(3), np.array([0.2, -0.1, 3.0])
SURE = np.diag([1 / 0.05**2] * 2 + [1 / 0.1**2] + [1 / 0.1**2] * 3)
PRIOR = Estimate(R, T + np.array([0.03, 0.02, 0.05]), 0.0, 0.0, SURE)


def peaks(*, shown: list[int], specks: int, seed: int = 0) -> Peaks:
    """Markers ``shown`` and specks, the strongest first: the markers are all 12."""
    rng = np.random.default_rng(seed)
    markers = CAMERA.project(POINTS @ R.T + T)[shown] + rng.normal(0, 0.5, (len(shown), 2))
    xy = np.concatenate([markers, rng.uniform((0, 0), (640, 480), (specks, 2))])
    snr = np.concatenate([np.full(len(shown), 12.0), np.sort(rng.uniform(3, 11, specks))[::-1]])
    nothing, every = np.zeros(len(xy)), np.arange(len(xy))
    chroma = np.zeros((len(xy), 2))
    return Peaks(xy, snr, np.ones(len(xy)), chroma, nothing, every, np.ones(len(xy)))


def expectation(points: np.ndarray, prior: Estimate) -> Expectation:
    return Expectation(points, placed_along(points), prior, CAMERA)


def guided(points: np.ndarray, prior: Estimate, peaks: Peaks, sigma_px: float) -> Guess | None:
    placed = PlacedPeaks(peaks.xy, peaks, float(CAMERA.width * CAMERA.height))
    return expectation(points, prior).guess(placed, sigma_px)


def plainly(prior: Estimate, peaks: Peaks, sigma_px: float) -> dict[tuple[int, ...], float]:
    """Evidence of all ways to take peaks for all markers, or for all but one (-1)."""
    seen = projected(POINTS, prior.R, prior.t, CAMERA)
    assert seen is not None
    places, jacobian = seen[0], seen[1].reshape(-1, 6)
    covariance = jacobian @ np.linalg.inv(prior.information) @ jacobian.T
    covariance += sigma_px**2 * np.eye(len(covariance))
    z, along = peaks.xy @ [1, 1j], placed_along(POINTS)
    evidence = {}
    for members in permutations(range(-1, len(z)), len(places)):
        markers = [m for m, member in enumerate(members) if member >= 0]
        taken = tuple(members[m] for m in markers)
        rows = np.ravel([(2 * m, 2 * m + 1) for m in markers])
        off = (peaks.xy[list(taken)] - places[markers]).ravel()
        evidence[members] = (
            math.log(1 - HIDDEN if len(markers) == len(places) else HIDDEN)
            + log_normal(off, covariance[np.ix_(rows, rows)])
            + log_looks(z, peaks, 640.0 * 480.0, taken, along[markers])
        )
    return evidence


@pytest.mark.parametrize(
    ("shown", "seed"), [([0, 1, 2, 3], 1), ([0, 1, 2], 2), ([1, 2, 3], 3), ([0, 2, 3], 4)]
)
def test_the_best_set_is_that_of_the_plain_way(shown: list[int], seed: int) -> None:
    seen = peaks(shown=shown, specks=2, seed=seed)
    rng = np.random.default_rng(seed)
    likeness, chroma = rng.normal(0, 1, len(seen.snr)), rng.normal(0, 0.2, (len(seen.snr), 2))
    seen = replace(seen, likeness=likeness, chroma=chroma)
    evidence = plainly(PRIOR, seen, 1.5)
    best = max(evidence, key=lambda members: evidence[members])
    guess = guided(POINTS, PRIOR, seen, 1.5)
    assert guess is not None
    assert guess.markers.tolist() == [m for m in range(4) if best[m] >= 0]
    assert guess.members.tolist() == [member for member in best if member >= 0]
    assert guess.evidence == pytest.approx(evidence[best], abs=1e-3)


def test_all_markers_are_taken_where_the_pose_expects_them() -> None:
    guess = guided(POINTS, PRIOR, peaks(shown=[0, 1, 2, 3], specks=20), 1.0)
    assert guess is not None
    assert guess.markers.tolist() == guess.members.tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize("missing", [0, 1, 2, 3])
def test_three_of_four_are_enough(missing: int) -> None:
    shown = [m for m in range(4) if m != missing]
    guess = guided(POINTS, PRIOR, peaks(shown=shown, specks=15), 1.0)
    assert guess is not None
    assert guess.markers.tolist() == shown
    assert guess.members.tolist() == [0, 1, 2]
    assert guess.evidence > np.log(30)


@pytest.mark.parametrize("missing", [0, 1, 2, 3])
def test_a_peak_beside_a_marker_that_is_out_is_not_taken_for_it(missing: int) -> None:
    """The other three have it to a pixel or two, the pose expected only to twenty."""
    others = [m for m in range(4) if m != missing]
    all_four = peaks(shown=[0, 1, 2, 3], specks=0)
    beside = all_four.xy + np.where(np.arange(4) == missing, 1.0, 0.0)[:, None] * [18.0, 12.0]
    guess = guided(POINTS, PRIOR, replace(all_four, xy=beside), 1.0)
    assert guess is not None
    assert guess.markers.tolist() == guess.members.tolist() == others


def test_two_of_four_are_not() -> None:
    assert guided(POINTS, PRIOR, peaks(shown=[0, 3], specks=0), 1.0) is None


def test_specks_about_the_expected_places_say_little() -> None:
    evidence = []
    for seed in range(40):
        guess = guided(POINTS, PRIOR, peaks(shown=[], specks=60, seed=seed), 1.0)
        evidence.append(-np.inf if guess is None else guess.evidence)
    assert np.mean(np.array(evidence) > np.log(30)) <= 1 / 30 + 0.05


def test_the_less_sure_the_pose_the_less_the_same_peaks_say() -> None:
    seen = peaks(shown=[0, 1, 3], specks=5)
    vague = Estimate(R, PRIOR.t, 0.0, 0.0, SURE / 9)
    sure, unsure = (guided(POINTS, p, seen, 1.0) for p in (PRIOR, vague))
    assert sure is not None and unsure is not None
    assert sure.evidence > unsure.evidence


def test_a_pose_behind_the_camera_expects_nothing() -> None:
    behind = Estimate(R, -T, 0.0, 0.0, SURE)
    assert guided(POINTS, behind, peaks(shown=[0, 1, 2, 3], specks=0), 1.0) is None


def test_a_speck_at_the_border_is_no_marker_that_is_beyond_it() -> None:
    """Two markers to the right are out of the picture; two specks at its edge stand in for them."""
    beyond = replace(PRIOR, t=np.array([2.05, -0.1, 3.0]))
    places = CAMERA.project(POINTS @ R.T + beyond.t)
    outside = places[:, 0] > 639
    assert outside.sum() == 2
    shown = np.where(outside[:, None], np.column_stack([np.full(4, 637.0), places[:, 1]]), places)
    four = replace(peaks(shown=[0, 1, 2, 3], specks=0), xy=shown)
    assert guided(POINTS, beyond, four, 1.0) is None


def test_a_lamp_of_a_marker_that_is_expected_beyond_the_border_is_no_other_marker() -> None:
    """The left ones are at the border, the upper of them out.  Unsure as the pose is, the lower
    one, just in view, might be the upper one by its place alone."""
    near = Estimate(
        rotations(np.array([[0.0, 0.0, 0.05]]))[0],
        np.array([-0.102, 0.03, 0.88]),
        0.0,
        0.0,
        np.diag([1 / 0.04**2] * 3 + [1 / 0.03**2] * 3),
    )
    places = CAMERA.project(POINTS @ near.R.T + near.t)
    assert places[0, 0] > 0 > places[2, 0] > -10
    seen = peaks(shown=[0, 1, 2], specks=0)
    lower_left = places[2] + [8.0, -15.0]
    there = replace(seen, xy=np.stack([places[1], lower_left, places[3]]))
    assert guided(POINTS, near, there, 1.0) is None
    upper_left = replace(seen, xy=np.stack([places[0], places[1], places[3]]))
    guess = guided(POINTS, near, upper_left, 1.0)
    assert guess is not None and guess.markers.tolist() == [0, 1, 3]


def test_both_poses_of_a_plane_expect_the_markers_at_the_same_places() -> None:
    """And a pose a hand's breadth aside expects them elsewhere."""
    [turned] = rotations(np.array([[0.0, 0.35, 0.0]]))
    far = CAMERA.project(POINTS @ turned.T + np.array([0.1, 0.0, 6.0]))
    sighting = Sighting(POINTS, far, np.full(4, 0.3), CAMERA)
    first, second = (expectation(POINTS, pose) for pose in estimates(sighting))
    assert first.like(second)
    aside = replace(PRIOR, t=PRIOR.t + np.array([0.1, 0.0, 0.0]))
    assert not expectation(POINTS, aside).like(expectation(POINTS, PRIOR))


def test_the_spacing_is_that_of_the_closest_markers() -> None:
    pixels = CAMERA.project(POINTS @ R.T + PRIOR.t)
    apart = [np.linalg.norm(a - b) for k, a in enumerate(pixels) for b in pixels[:k]]
    assert expectation(POINTS, PRIOR).spacing_px == pytest.approx(min(apart))
    behind = replace(PRIOR, t=-PRIOR.t)
    assert expectation(POINTS, behind).spacing_px == 0.0
