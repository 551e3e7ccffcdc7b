"""What counts as tracked, wrong and covered on the way to a dock, and as a lock without one."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice
from pathlib import Path

import cv2
import numpy as np
import pytest
from approaches_frames import Seen, alike_after_a_turn, seen
from approaches_pictures import Pictures
from approaches_runs import run_row, still_trial
from approaches_tables import MISSES, by_run, in_sum, of_no_dock

from chromadock import Detection, Track
from chromadock.results.detection import Background, Marker
from chromadock.results.track import TrackedPose
from chromadock.rotation import quaternion_from_matrix
from chromadock.track.motion import rotation
from chromadock.variety import Backdrops, Moment, Scene, approach, draw, render
from chromadock.variety.docks import ORIGINAL_WIDTH_M, dock_geometry

FIXED = {"camera": "small", "dock": "five", "backdrop": "procedural"}
SIGMA_M, SIGMA_RAD = 0.02, 0.05


@pytest.fixture(scope="module")
def first() -> tuple[Scene, Moment]:
    return next(iter(islice(approach(1, 1, Backdrops(), **FIXED), 1)))


def pose(moment: Moment, farther: float = 1.0, turned: float = 0.0) -> TrackedPose:
    """The true pose but for a factor of its place and a turn about the camera's y axis."""
    x, y, z = (moment.truth.t * farther).tolist()
    q = quaternion_from_matrix(rotation(np.array([0.0, turned, 0.0])) @ moment.truth.R)
    covariance = np.diag([SIGMA_M**2] * 3 + [SIGMA_RAD**2] * 3)
    return TrackedPose((x, y, z), q, tuple(covariance.ravel().tolist()), 1.0)


def judged(
    first: tuple[Scene, Moment],
    tracked: TrackedPose | None,
    other: TrackedPose | None = None,
    state: str = "tracking",
    markers_off_px: float | None = None,
) -> Seen:
    scene, moment = first
    places = None
    if markers_off_px is not None:
        assert moment.truth.dock is not None
        pixels = (moment.truth.pixels + np.array([markers_off_px, 0.0])).tolist()
        places = {n: (x, y) for n, (x, y) in zip(moment.truth.dock.names, pixels, strict=True)}
    detection = Detection(
        state="not_found",
        background=Background((0, 0, 0), None, 0.0),
        marker=Marker((0, 0, 0), 0.0),
        observed=(0, 0, 0),
        passed_fraction=0.0,
        markers=places,
        track=Track(state, moment.time_s, tracked, other),
    )
    return seen(moment, detection, scene.width_m)


def test_a_track_is_wrong_that_is_a_twentieth_off(first: tuple[Scene, Moment]) -> None:
    near, far = (judged(first, pose(first[1], f)) for f in (1.04, 1.06))
    assert near.tracked and not near.wrong and near.error == pytest.approx(0.04)
    assert far.tracked and far.wrong and far.error == pytest.approx(0.06)
    assert judged(first, pose(first[1], 0.94), state="recently_lost").wrong
    assert not judged(first, None, state="acquiring").wrong


def test_the_distance_is_that_of_a_dock_as_wide_as_the_original(
    first: tuple[Scene, Moment],
) -> None:
    assert first[0].width_m != pytest.approx(ORIGINAL_WIDTH_M, rel=0.01)
    assert judged(first, None).distance_m == pytest.approx(7.0)


def test_the_region_holds_what_is_within_chi_square(first: tuple[Scene, Moment]) -> None:
    """12.59 is 3.55 standard deviations along one axis."""
    range_m = float(np.linalg.norm(first[1].truth.t))
    by_place = {n: 1 + n * SIGMA_M / range_m for n in (3.4, 3.7)}
    assert judged(first, pose(first[1], by_place[3.4])).covered
    assert not judged(first, pose(first[1], by_place[3.7])).covered
    assert judged(first, pose(first[1], turned=3.4 * SIGMA_RAD)).covered
    off = pose(first[1], turned=3.7 * SIGMA_RAD)
    assert not judged(first, off).covered
    # The alternative counts as well.
    assert judged(first, off, other=pose(first[1])).covered
    assert judged(first, None).covered is None


@pytest.mark.parametrize(
    ("dock", "alike"),
    [
        ("rectangle", False),
        ("five", False),
        ("three", False),
        ("line", False),
        ("square", True),
        ("ring", True),
    ],
)
def test_of_a_dock_that_is_alike_after_a_turn_the_place_counts(dock: str, alike: bool) -> None:
    assert alike_after_a_turn(dock_geometry(dock, 0.7).points) is alike
    given = next(approach(1, 1, Backdrops(), **{**FIXED, "dock": dock}))
    turned = judged(given, pose(given[1], turned=np.pi / 4))
    assert turned.covered is alike


def test_a_run_tells_why_near_frames_are_not_tracked(first: tuple[Scene, Moment]) -> None:
    scene, moment = first
    right = pose(moment)
    looks = [
        judged(first, None, state="acquiring", markers_off_px=0.0),
        replace(judged(first, None, state="never_seen"), standing_out=True),
        replace(judged(first, None, state="never_seen"), standing_out=False),
        judged(first, right),
        judged(first, pose(moment, 1.2)),
        judged(first, right, state="recently_lost", markers_off_px=0.0),
        judged(first, right, state="recently_lost", markers_off_px=30.0),
    ]
    distances = [5.5, 4.5, 4.2, 4.0, 3.5, 3.0, 2.5]
    frames = [
        replace(f, time_s=k / 10, distance_m=d, shown=True)
        for k, (f, d) in enumerate(zip(looks, distances, strict=True))
    ]
    row = run_row(scene, True, frames)
    assert row["lock_s"] == pytest.approx(0.3) and row["lock_m"] == 4.0
    assert (row["near"], row["near_tracked"]) == (6, 2)
    assert [row[n] for n in MISSES] == [1, 1, 1, 0, 1]
    assert (row["posed"], row["wrong"], row["tracked"], row["covered"]) == (4, 1, 2, 1)
    assert row["worst"] == pytest.approx(0.2)
    assert run_row(scene, True, [replace(frames[0], distance_m=4.9)])["unlocked"] == 1
    # Sums are of frames: two runs, of which one is tracked in 2 of 6 and the other in 1 of 1.
    other = run_row(scene, True, frames[3:4])
    assert " 0.429 " in next(line for line in in_sum([row, other]) if line.startswith("  att"))
    assert len(list(by_run([row, other]))) == 2


def test_any_pose_is_a_lock_where_there_is_no_dock(first: tuple[Scene, Moment]) -> None:
    scene, moment = first
    nothing = replace(
        moment.truth, dock=None, R=np.full((3, 3), np.nan), t=np.full(3, np.nan),
        pixels=np.zeros((0, 2)), in_view=np.zeros(0, bool),
    )  # fmt: skip
    empty = (scene, replace(moment, truth=nothing))
    locked = judged(empty, pose(moment))
    assert locked.wrong and not locked.shown and locked.covered is None
    assert judged(empty, None).error is None
    rows = [run_row(scene, False, [f]) for f in (locked, judged(empty, None))]
    assert next(of_no_dock(rows)).startswith("no dock: 1 locked in 2 approaches")


def test_pictures_of_what_went_wrong_are_few(tmp_path: Path, first: tuple[Scene, Moment]) -> None:
    moment = first[1]
    pictures = Pictures(tmp_path, "run")
    wrong = judged(first, pose(moment, 1.2))
    near = replace(judged(first, None, state="acquiring"), distance_m=3.0, shown=True)
    detection = Detection(
        "not_found", Background((0, 0, 0), None, 0.0), Marker((0, 0, 0), 0.0), (0, 0, 0), 0.0
    )
    for k in range(40):
        then = replace(moment, time_s=k / 10)
        pictures.add(then, detection, wrong)
        pictures.add(then, detection, near)
        pictures.add(then, detection, judged(first, pose(moment)))
    names = sorted(file.name for file in tmp_path.iterdir())
    assert [n.split("-")[1] for n in names] == ["untracked"] * 3 + ["wrong"] * 3


def test_a_held_photograph_of_water_does_not_lock(tmp_path: Path) -> None:
    water = np.full((120, 160, 3), (120, 140, 60), np.uint8)
    cv2.imwrite(str(tmp_path / "water.png"), water)
    row = still_trial(tmp_path / "water.png", "ternary")
    assert row["locked"] == 0 and row["photograph"] == "water.png"


def test_a_photograph_of_a_dock_locks(tmp_path: Path) -> None:
    """So that none locked says something."""
    clear = {"radiance": 15.0, "attenuation": 0.25, "unlikeness": 0.0, "colour": "mapped"}
    scene = draw(3, 1, Backdrops(), camera="vga", dock="rectangle", distance="1.5", **clear)
    cv2.imwrite(str(tmp_path / "dock.png"), render(scene)[0])
    assert still_trial(tmp_path / "dock.png", scene.mapping)["locked"] > 10
