from __future__ import annotations

from itertools import permutations
from typing import Any

import numpy as np
import pytest

from chromadock import CameraModel, DockGeometry
from chromadock.pose import Sighting, estimates
from chromadock.robust.acceptance import rigid
from chromadock.robust.chroma import Colours
from chromadock.robust.clutter import Clutter
from chromadock.robust.evidence import (
    SLOPE,
    SPREAD,
    STRONGEST,
    log_alike,
    log_unlike,
    placed_along,
)
from chromadock.robust.method import MAX_TRIALS
from chromadock.robust.peaks import MIN_SNR
from chromadock.robust.search import Search
from chromadock.robust.shape import ShapeModel

CAMERA = CameraModel.nominal(640, 480)
RECTANGLE = DockGeometry.default().points
FIVE = np.vstack([RECTANGLE, (0.0, 0.0, -0.3)])
AREA = 640.0 * 480.0
SIGMA_PX = 1.0
MODELS = {len(points): ShapeModel.learn(points, CAMERA) for points in (RECTANGLE, FIVE)}


def search(markers: int) -> Search:
    return Search(MODELS[markers], SIGMA_PX, AREA)


def clutter(count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Places and strengths of specks, the strongest first; strengths fall off as a square."""
    z = rng.uniform(-320, 320, count) + 1j * rng.uniform(-240, 240, count)
    return z, np.sort(MIN_SNR * rng.random(count) ** -0.5)[::-1]


def dock(points: np.ndarray, range_m: float, rng: np.random.Generator) -> np.ndarray:
    """Places of the markers, (n,)."""
    yaw = np.radians(rng.uniform(-20, 20))
    turn = np.array([[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]])
    seen = points @ turn.T + (0.05 * range_m, 0.02 * range_m, range_m)
    return 512 * (seen[:, 0] + 1j * seen[:, 1]) / seen[:, 2]


def among(
    markers: np.ndarray, strength: float, z: np.ndarray, snr: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Markers among specks, strongest first, and where each marker went."""
    both = np.concatenate([markers, z])
    strengths = np.concatenate([np.full(len(markers), strength), snr])
    order = np.argsort(-strengths, kind="stable")
    return both[order], strengths[order], np.argsort(order)[: len(markers)]


def colours(
    snr: np.ndarray, rng: np.random.Generator, markers: np.ndarray | None = None
) -> np.ndarray:
    """Chroma: of all kinds for specks, of one for ``markers`` among them."""
    chroma = rng.normal(0, 0.6, (len(snr), 2))
    if markers is not None:
        chroma[markers] = rng.normal(0, 0.3, 2) + rng.normal(0, 0.1, (len(markers), 2))
    return chroma


@pytest.mark.parametrize("points", [RECTANGLE, FIVE])
@pytest.mark.parametrize("range_m", [1.5, 3.0, 4.0])
def test_the_dock_is_the_best_rigid_candidate_among_specks(
    points: np.ndarray, range_m: float
) -> None:
    """Where a marker out of the plane stands depends on the view: a speck there may look
    as likely, and is told by the pose, as in the method."""
    rng = np.random.default_rng(1)
    for _ in range(5):
        noise = rng.normal(0, 0.3, (len(points), 2)) @ np.array([1, 1j])
        markers = dock(points, range_m, rng) + noise
        z, snr, places = among(markers, 15.0, *clutter(40, rng))
        found = search(len(points)).find(z, snr, colours(snr, rng, places), 0.0)
        rigid_ones = [m for m in found.members[:MAX_TRIALS] if is_rigid(points, z[m], 0.3)]
        assert rigid_ones[0].tolist() == places.tolist()
        assert found.evidence[0] > np.log(100)


def is_rigid(points: np.ndarray, z: np.ndarray, sigma_px: float) -> bool:
    pixels = np.column_stack([z.real, z.imag]) + CAMERA.matrix[:2, 2]
    poses = estimates(Sighting(points, pixels, np.full(len(points), sigma_px), CAMERA))
    return bool(poses) and rigid(poses[0], len(points))


def test_nothing_better_is_overlooked() -> None:
    """Against all ways to name four of nine peaks."""
    rng = np.random.default_rng(2)
    model = MODELS[4]
    for _ in range(6):
        markers = dock(RECTANGLE, rng.uniform(2, 4), rng)
        z, snr, places = among(markers, 8.0, *clutter(5, rng))
        chroma = colours(snr, rng, places)
        found = search(4).find(z, snr, chroma, -20.0)
        near = Clutter.of(np.abs(z[:, None] - z), snr, AREA)
        alike = Colours.of(chroma, snr, near.near)
        order = list(model.order)
        every = np.array([p for p in permutations(range(len(z)), 4)])
        base = z[every[:, order[1]]] - z[every[:, order[0]]]
        size = (base / model.base.direction).real > 0
        best = max(
            (
                model.log_base(z[m[order[1]]] - z[m[order[0]]])
                + model.log_shape(z[m][order][None], np.full((1, 4), SIGMA_PX))[0]
                + log_alike(snr[m][order][None], model.along)[0]
                + near.rarity_of(m[None])[0]
                + alike.log_common(m[None])[0]
                - np.log(AREA),
                m.tolist(),
            )
            for m in every[size]
        )
        assert found.members[0].tolist() == best[1]
        assert found.evidence[0] == pytest.approx(best[0], abs=1.0)


def test_clutter_is_taken_for_the_dock_no_more_often_than_stated(record_property: Any) -> None:
    rng = np.random.default_rng(3)
    frames, evidence = 400, []
    for _ in range(frames):
        z, snr = clutter(int(rng.integers(10, 60)), rng)
        found = search(4).find(z, snr, colours(snr, rng), np.log(3))
        evidence.append(found.evidence[0] if len(found.evidence) else -np.inf)
    for ratio in (3, 10, 30):
        share = np.mean(np.array(evidence) >= np.log(ratio))
        record_property(
            "figure", f"Poisson clutter: {share:.4f} of frames reach a ratio of {ratio}"
        )
        # Three standard deviations of a count on top of the bound.
        assert share <= 1 / ratio + 3 * np.sqrt(1 / ratio / frames)


@pytest.mark.parametrize("count", [0, 1, 3, 4])
def test_few_peaks_are_no_error(count: int) -> None:
    rng = np.random.default_rng(count)
    z, snr = clutter(count, rng)
    assert len(search(4).find(z, snr, colours(snr, rng), 0.0).evidence) == 0


def test_a_dock_upside_down_is_none() -> None:
    rng = np.random.default_rng(4)
    tall = RECTANGLE + np.array([(0.2, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0)])  # no symmetry
    model = ShapeModel.learn(tall, CAMERA)
    upright, mirrored = dock(tall, 2.0, rng), dock(tall * (1, -1, 1), 2.0, rng)
    one = Search(model, SIGMA_PX, AREA)
    for places, least in ((upright, 1), (mirrored, 0)):
        z, snr, markers = among(places, 20.0, *clutter(10, rng))
        found = one.find(z, snr, colours(snr, rng, markers), np.log(300))
        assert min(1, len(found.evidence)) == least


def test_likeness_is_the_integral_over_the_common_strength_and_the_slope() -> None:
    rng = np.random.default_rng(5)
    common = np.linspace(np.log(MIN_SNR) - 4, np.log(STRONGEST) + 4, 2_001)[:, None, None]
    slope = np.linspace(-6 * SLOPE, 6 * SLOPE, 401)[:, None]
    cell = float((common[1] - common[0]).item() * (slope[1] - slope[0]).item())
    along = placed_along(RECTANGLE)
    prior = np.exp(-0.5 * (slope[:, 0] / SLOPE) ** 2) / (SLOPE * np.sqrt(2 * np.pi))
    for _ in range(5):
        snr = rng.uniform(4, 60, 4)
        spread = np.sqrt(SPREAD**2 + 1 / snr**2)
        off = (np.log(snr) - common - slope * along) / spread
        densities = (np.exp(-0.5 * off**2) / (spread * np.sqrt(2 * np.pi))).prod(axis=2)
        expected = np.log((densities * prior).sum() * cell / np.log(STRONGEST / MIN_SNR))
        assert log_alike(snr[None], along)[0] == pytest.approx(expected, abs=1e-3)


def test_the_dimmer_end_of_a_dock_is_no_sign_of_clutter() -> None:
    along = placed_along(RECTANGLE)
    left_dim, mixed = np.exp(0.4 * along), np.exp(0.4 * np.array([1, 1, -1, -1]) * np.abs(along))
    assert log_alike(20 * left_dim[None], along)[0] > log_alike(20 * mixed[None], along)[
        0
    ] + np.log(2)


def test_places_along_a_dock_are_one_at_its_ends() -> None:
    assert np.abs(placed_along(RECTANGLE)) == pytest.approx(1)
    assert sorted(np.sign(placed_along(RECTANGLE))) == [-1, -1, 1, 1]


def test_rarity_is_one_over_the_density_of_clutter() -> None:
    """An even scatter of a known density, at the strength that all but a few exceed."""
    rng = np.random.default_rng(6)
    totals = []
    for _ in range(30):
        z, snr = clutter(64, rng)
        near = Clutter.of(np.abs(z[:, None] - z), snr, AREA)
        expected = 2 * 64 / AREA * (MIN_SNR / snr) ** 2  # the tail's derivative by log strength
        totals.append(np.exp(-near.rarity(0))[32:] / expected[32:])
    assert np.mean(totals) == pytest.approx(1, abs=0.25)


def test_members_are_not_each_others_clutter() -> None:
    z, snr = clutter(6, np.random.default_rng(7))
    close = np.concatenate([np.zeros(4), z])
    near = Clutter.of(np.abs(close[:, None] - close), np.append(np.full(4, snr[0]), snr), AREA)
    alone = Clutter.of(np.zeros((1, 1)), np.array([MIN_SNR]), AREA)
    together = near.rarity_of(np.array([[0, 1, 2, 3]]))
    assert together == pytest.approx(4 * alone.rarity(0))


def test_what_outshines_all_clutter_is_the_rarer_for_it_to_a_limit() -> None:
    z, _ = clutter(6, np.random.default_rng(8))
    apart = np.abs(z[:, None] - z)
    rarity = [
        Clutter.of(apart, np.array([10.0 * times, 10, 9, 8, 7, 6]), AREA).rarity_of(ONE)[0]
        for times in (1, 2, 100, 1000)
    ]
    assert rarity[1] - rarity[0] == pytest.approx(np.log(4), abs=0.2)
    assert rarity[0] < rarity[1] < rarity[2] == pytest.approx(rarity[3])


ONE = np.array([[0]])


@pytest.mark.parametrize("points", [RECTANGLE, FIVE])
def test_two_markers_bound_how_alike_a_set_with_them_can_be(points: np.ndarray) -> None:
    rng = np.random.default_rng(11)
    along = placed_along(points)
    snr = MIN_SNR * 10 ** rng.uniform(0, 2, (2000, len(points)))
    alike = log_alike(snr, along)
    most = log_alike(np.full((1, len(points)), STRONGEST), along)
    for a, b in permutations(range(len(points)), 2):
        bound = most + log_unlike(snr[:, a], snr[:, b], float(along[b] - along[a]))
        assert (alike <= bound + 1e-9).all()
        # It is no idle bound: the others can do what they like.
        assert np.median(bound) < most - 0.5
