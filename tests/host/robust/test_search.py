"""The search against the same written the plain way, ``search_reference``; and what it promises."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from search_reference import log_looks, sets_of
from track_truth import rotation

from chromadock import CameraModel, DockGeometry
from chromadock.robust.find import search
from chromadock.robust.find.search import Candidates, Search, SearchedPeaks
from chromadock.robust.frame.peaks import MAX_PEAKS, MAX_PROMISING, MIN_SNR, Peaks
from chromadock.robust.weigh import clutter
from chromadock.robust.weigh.evidence import (
    SLOPE,
    SPREAD,
    STRONGEST,
    PlacedPeaks,
    evidence_of_sets,
    placed_along,
)
from chromadock.robust.weigh.shape import ShapeModel

CAMERA = CameraModel.nominal(640, 480)
RECTANGLE = DockGeometry.default().points
TURNS = np.arange(8) * np.pi / 4
DOCKS = {
    3: RECTANGLE[:3],
    4: RECTANGLE,
    5: np.vstack([RECTANGLE, (0.0, 0.0, -0.3)]),
    8: np.column_stack([0.4 * np.cos(TURNS), 0.4 * np.sin(TURNS), np.zeros(8)]),
}
AREA = 640.0 * 480.0
SIGMA_PX = 1.0
MODELS = {count: ShapeModel.learn(points, CAMERA) for count, points in DOCKS.items()}


def frame(
    points: np.ndarray | None, specks: int, rng: np.random.Generator, strength: float = 15.0
) -> tuple[np.ndarray, Peaks, list[int]]:
    """Places of a dock's markers among specks, and where each marker went.

    Specks' strengths fall off as a square; markers are of one strength and colour.
    """
    xy = rng.uniform((0, 0), (640, 480), (specks, 2))
    snr, chroma = MIN_SNR * rng.random(specks) ** -0.5, rng.normal(0, 0.6, (specks, 2))
    count = 0
    if points is not None:
        count = len(points)
        markers = seen(points, rng) + rng.normal(0, 0.3, (count, 2))
        xy = np.concatenate([markers, xy])
        snr = np.concatenate([strength * np.exp(rng.normal(0, 0.1, count)), snr])
        same = rng.normal(0, 0.3, 2) + rng.normal(0, 0.1, (count, 2))
        chroma = np.concatenate([same, chroma])
    order = np.argsort(-snr, kind="stable")
    peaks = peaks_of(xy[order], snr[order], chroma[order], rng.normal(0, 0.5, len(xy)))
    return xy[order] @ np.array([1, 1j]), peaks, np.argsort(order)[:count].tolist()


def seen(points: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Pixels of a dock at a likely pose."""
    range_m, yaw = rng.uniform(1.5, 4), np.radians(rng.uniform(-20, 20))
    turn = np.array([[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]])
    return CAMERA.project(points @ turn.T + (0.05 * range_m, 0.02 * range_m, range_m))


def peaks_of(xy: np.ndarray, snr: np.ndarray, chroma: np.ndarray, likeness: np.ndarray) -> Peaks:
    """The first MAX_PROMISING of them promising, their neighbourhoods more and less in view."""
    promising = np.arange(min(len(xy), MAX_PROMISING))
    inside = 0.6 + 0.4 * np.sin(np.arange(len(xy))) ** 2
    return Peaks(xy, snr, np.ones(len(xy)), chroma, likeness, promising, inside)


def look(count: int, z: np.ndarray, peaks: Peaks, least: float) -> Candidates:
    return Search(MODELS[count], SIGMA_PX).find(SearchedPeaks(z, peaks, AREA), least)


@pytest.mark.parametrize(
    ("count", "specks", "least"), [(3, 7, -25.0), (4, 5, -25.0), (5, 3, -30.0), (8, 0, -60.0)]
)
def test_it_finds_all_sets_and_their_evidence(count: int, specks: int, least: float) -> None:
    rng, total = np.random.default_rng(count), 0
    for _ in range(5):
        z, peaks, _ = frame(DOCKS[count], specks, rng)
        found = look(count, z, peaks, least)
        expected = sets_of(MODELS[count], SIGMA_PX, AREA, z, peaks, least)
        assert {tuple(m) for m in found.members.tolist()} == set(expected)
        evidence = [expected[tuple(m)] for m in found.members.tolist()]
        assert found.evidence == pytest.approx(evidence, rel=1e-6, abs=1e-5)
        assert found.evidence.tolist() == sorted(found.evidence, reverse=True)
        total += len(expected)
    assert total >= 5


def test_only_promising_peaks_are_markers_but_all_are_clutter() -> None:
    rng = np.random.default_rng(12)
    z, peaks, places = frame(RECTANGLE, 8, rng)
    promising = np.array(sorted([*places, 2 if 2 not in places else 3]))
    some = peaks_of(peaks.xy, peaks.snr, peaks.chroma, peaks.likeness)
    some = replace(some, promising=promising)
    found = look(4, z, some, -25.0)
    evidence = dict(zip(map(tuple, found.members.tolist()), found.evidence.tolist(), strict=True))
    expected = sets_of(MODELS[4], SIGMA_PX, AREA, z, some, -25.0)
    assert evidence == pytest.approx(expected, abs=1e-5)
    assert tuple(places) in expected


@pytest.mark.parametrize("size", [1, 3, 4, 8])
def test_the_evidence_of_given_sets_is_that_of_the_formulas(size: int) -> None:
    rng = np.random.default_rng(size)
    for specks in (size, 12, 40, MAX_PEAKS):
        z, peaks, _ = frame(None, specks, rng)
        along = rng.uniform(-1, 1, size)
        sets = np.array([rng.permutation(specks)[:size] for _ in range(5)])
        expected = [log_looks(z, peaks, AREA, tuple(m), along) for m in sets.tolist()]
        found = evidence_of_sets(PlacedPeaks(z, peaks, AREA), sets, along)
        assert found == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("yaw_deg", [38, 40])
def test_a_dock_that_is_near_and_turned_far_is_found(yaw_deg: float) -> None:
    """One side of it is much nearer than the other, and so larger: few of the views that shapes
    are learnt from show as much."""
    R = rotation(-11, yaw_deg, 12)
    markers = CAMERA.project(RECTANGLE @ R.T + (-0.24, -0.16, 0.7))
    rng = np.random.default_rng(5)
    xy = np.concatenate([markers, rng.uniform((0, 0), (640, 480), (10, 2))])
    snr = np.concatenate([np.full(4, 100.0), MIN_SNR * rng.random(10) ** -0.5])
    chroma = np.concatenate([np.zeros((4, 2)), rng.normal(0, 0.6, (10, 2))])
    found = look(4, xy @ np.array([1, 1j]), peaks_of(xy, snr, chroma, np.zeros(14)), np.log(300))
    assert [0, 1, 2, 3] in found.members.tolist()


@pytest.mark.parametrize("count", [4, 5, 8])
def test_the_dock_is_the_best_candidate_among_specks(count: int) -> None:
    """But for a marker out of the plane: where it stands depends on the view, and a speck there
    may look as likely."""
    rng, first = np.random.default_rng(1), 0
    for _ in range(10):
        z, peaks, places = frame(DOCKS[count], 40, rng)
        found = look(count, z, peaks, np.log(100))
        assert places in found.members.tolist()
        first += found.members[0].tolist() == places
    assert first >= 8


def test_clutter_is_taken_for_the_dock_no_more_often_than_stated(record_property: Any) -> None:
    rng = np.random.default_rng(3)
    frames, evidence = 1000, []
    for _ in range(frames):
        z, peaks, _ = frame(None, int(rng.integers(10, 60)), rng)
        peaks.likeness[:] = 0  # of clutter, it averages to a ratio of one by itself
        found = look(4, z, peaks, np.log(3))
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
    z, peaks, _ = frame(None, count, np.random.default_rng(count))
    assert look(4, z, peaks, 0.0).members.shape == (0, 4)


def test_too_many_peaks_are_an_error() -> None:
    z, peaks, _ = frame(None, 200, np.random.default_rng(0))
    with pytest.raises(ValueError, match="200 peaks"):
        PlacedPeaks(z, peaks, AREA)


def test_a_frame_full_of_rings_takes_bounded_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Seven rings of eight lamps, alike in all, and any set wanted: more than can be weighed."""
    rng = np.random.default_rng(9)
    rings = np.concatenate([seen(DOCKS[8], rng) for _ in range(7)])
    specks = rng.uniform((0, 0), (640, 480), (MAX_PEAKS - 56, 2))
    xy = np.concatenate([rings, specks])
    flat = np.zeros((MAX_PEAKS, 2))
    peaks = peaks_of(xy, np.full(MAX_PEAKS, 9.0), flat, flat[:, 0])
    z = xy @ np.array([1, 1j])
    found = look(8, z, peaks, -1000.0)
    assert found.weighed == search.MAX_WEIGHED
    assert len(found.evidence) == search.MAX_SETS
    assert len(np.unique(found.members, axis=0)) == search.MAX_SETS
    monkeypatch.setattr(search, "MAX_WEIGHED", 100)
    assert look(8, z, peaks, -1000.0).weighed == 100


def test_searches_that_share_what_is_taken_from_the_peaks_find_what_each_finds_alone() -> None:
    z, peaks, _ = frame(RECTANGLE, 20, np.random.default_rng(13))
    shared = SearchedPeaks(z, peaks, AREA)
    for count in (4, 3, 5, 4):
        together = Search(MODELS[count], SIGMA_PX).find(shared, -30.0)
        alone = look(count, z, peaks, -30.0)
        assert len(alone.evidence) > 0
        assert together.members.tolist() == alone.members.tolist()
        assert together.evidence.tolist() == alone.evidence.tolist()


def test_of_more_sets_than_are_kept_the_best_are(monkeypatch: pytest.MonkeyPatch) -> None:
    z, peaks, _ = frame(RECTANGLE, 20, np.random.default_rng(11))
    every = look(4, z, peaks, -30.0)
    assert 4 < len(every.evidence) < search.MAX_SETS
    monkeypatch.setattr(search, "MAX_SETS", 4)
    best = look(4, z, peaks, -30.0)
    assert best.members.tolist() == every.members[:4].tolist()
    assert best.evidence.tolist() == every.evidence[:4].tolist()
    assert best.looks.tolist() == every.looks[:4].tolist()


def test_a_dock_upside_down_is_none() -> None:
    tall = RECTANGLE + np.array([(0.2, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0)])  # no symmetry
    one = Search(ShapeModel.learn(tall, CAMERA), SIGMA_PX)
    for points, least in ((tall, 1), (tall * (1, -1, 1), 0)):
        z, peaks, _ = frame(points, 10, np.random.default_rng(4), strength=20.0)
        assert min(1, len(one.find(SearchedPeaks(z, peaks, AREA), np.log(300)).evidence)) == least


def alike(snr: np.ndarray, along: np.ndarray) -> float:
    """What is left of the evidence of a set that is all there is in the frame."""
    count = len(snr)
    order = np.argsort(-snr)
    flat = np.zeros((count, 2))
    peaks = peaks_of(flat, snr[order], flat, flat[:, 0])
    z, sets = flat[:, 0] + 0j, np.arange(count)[None]
    placed = PlacedPeaks(z, peaks, AREA)
    looks = evidence_of_sets(placed, sets, along[order])
    return float(looks[0] - evidence_of_sets(placed, sets, 0 * along)[0])


def test_strengths_are_integrated_over_the_common_one_and_the_slope() -> None:
    """Their density with places along the dock over that with none."""
    rng = np.random.default_rng(5)
    common = np.linspace(np.log(MIN_SNR) - 4, np.log(STRONGEST) + 4, 2_001)[:, None, None]
    slope = np.linspace(-6 * SLOPE, 6 * SLOPE, 401)[:, None]
    along = placed_along(RECTANGLE)
    prior = np.exp(-0.5 * (slope[:, 0] / SLOPE) ** 2)

    def integral(snr: np.ndarray, along: np.ndarray) -> float:
        off = (np.log(snr) - common - slope * along) / np.sqrt(SPREAD**2 + 1 / snr**2)
        return float((np.exp(-0.5 * (off**2).sum(axis=2)) * prior).sum())

    for _ in range(5):
        snr = rng.uniform(4, 60, 4)
        expected = np.log(integral(snr, along) / integral(snr, 0 * along))
        assert alike(snr, along) == pytest.approx(expected, abs=1e-3)


def test_the_dimmer_end_of_a_dock_is_no_sign_of_clutter() -> None:
    along = placed_along(RECTANGLE)
    left_dim, mixed = np.exp(0.4 * along), np.exp(0.4 * np.array([1, 1, -1, -1]) * np.abs(along))
    assert alike(20 * left_dim, along) > alike(20 * mixed, along) + np.log(2)


def test_places_along_a_dock_are_one_at_its_ends() -> None:
    assert np.abs(placed_along(RECTANGLE)) == pytest.approx(1)
    assert sorted(np.sign(placed_along(RECTANGLE))) == [-1, -1, 1, 1]


def rarity(xy: np.ndarray, snr: np.ndarray, member: int) -> float:
    """Of one peak: all but the density of its strength, which depends on nothing else."""
    flat = np.zeros((len(xy), 2))
    peaks = peaks_of(xy, snr, flat, flat[:, 0])
    placed = PlacedPeaks(xy @ np.array([1, 1j]), peaks, AREA)
    own = evidence_of_sets(placed, np.array([[member]]), np.zeros(1))[0]
    return float(own + np.log(np.log(STRONGEST / MIN_SNR)))


def test_rarity_is_one_over_the_density_of_clutter() -> None:
    """An even scatter of a known density, at the strength that all but a few exceed."""
    rng = np.random.default_rng(6)
    ratios = []
    for _ in range(30):
        xy = rng.uniform((0, 0), (640, 480), (64, 2))
        snr = np.sort(MIN_SNR * rng.random(64) ** -0.5)[::-1]
        for member in range(32, 64):
            expected = 2 * 64 / AREA * (MIN_SNR / snr[member]) ** 2  # the tail's derivative
            ratios.append(np.exp(-rarity(xy, snr, member)) / expected)
    assert np.mean(ratios) == pytest.approx(1, abs=0.25)


def test_what_outshines_all_clutter_is_the_rarer_for_it_to_a_limit() -> None:
    xy = np.random.default_rng(8).uniform((0, 0), (640, 480), (20, 2))
    others = np.linspace(10, 3, 19)
    times = [
        rarity(xy, np.concatenate([[10.0 * times], others]), 0) for times in (1, 1.5, 1e3, 1e6, 1e9)
    ]
    assert times[0] < times[1] < times[2] - np.log(4)
    # The share beyond falls no further; only its derivative by log strength does.
    assert times[2] - times[0] < np.log(1 / clutter.MOST_FALL) + 2
    assert times[4] - times[3] < 0.5
