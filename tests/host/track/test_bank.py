from __future__ import annotations

from dataclasses import replace
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from track_truth import CAMERA, DOCK, Course, Pose, pixels, rotation, sight

from chromadock.geometry.pose import Sighting, estimates, refined
from chromadock.mounting import Mounting
from chromadock.track.attitude import Attitude, expected
from chromadock.track.bank import FORGOTTEN, MAX_HYPOTHESES, REBORN, Bank, Hypothesis
from chromadock.track.motion import turn_between
from chromadock.track.sight import Sight
from chromadock.track.states import MOST_ELSEWHERE

FAR_M = 5.0
TILT_DEG = 18.0


def tilted(tilt_deg: float = TILT_DEG, range_m: float = FAR_M) -> Pose:
    """Straight ahead and turned aside: from afar the dock might be turned the other way."""
    return rotation(0, tilt_deg), np.array([0.0, 0.0, range_m])


def undecided(pose: Pose, noise: np.ndarray) -> Sight:
    """What was seen, with both poses told to fit alike."""
    at = pixels(pose, np.random.default_rng(0)) * 0 + CAMERA.project(
        DOCK.points @ pose[0].T + pose[1]
    )
    poses = estimates(Sighting(DOCK.points, at + noise, np.full(4, 0.3), CAMERA))
    markers = dict(zip(DOCK.names, map(tuple, at + noise), strict=True))
    made = Sight.of(markers, [0.3] * 4, poses, DOCK, CAMERA)
    assert made is not None
    return made


def angle_deg(bank: Bank, R: np.ndarray) -> float:
    return float(np.degrees(np.linalg.norm(turn_between(bank.hypotheses[0].state.R, R))))


def followed(course: Course, seconds: float, seed: int) -> Bank:
    rng = np.random.default_rng(seed)
    bank = Bank.of(sight(course(0.0), rng))
    for k in range(1, round(10 * seconds) + 1):
        bank = bank.after(0.1).seen(sight(course(0.1 * k), rng)) or bank
    return bank


def test_a_far_dock_leaves_two_poses_and_both_are_kept() -> None:
    bank = Bank.of(sight(tilted(), np.random.default_rng(1)))
    assert len(bank.hypotheses) == 2
    turns = [np.degrees(turn_between(np.eye(3), h.state.R))[1] for h in bank.hypotheses]
    assert min(turns) < -8 and max(turns) > 8
    assert sum(h.weight for h in bank.hypotheses) == pytest.approx(1.0)


def test_what_cannot_be_decided_is_not_decided() -> None:
    """The same picture over and over, a vehicle that stands: no data, no decision."""
    seen = undecided(tilted(), np.random.default_rng(2).normal(0, 0.1, (4, 2)))
    bank = Bank.of(seen)
    odds = bank.hypotheses[0].weight / bank.hypotheses[1].weight
    for _ in range(100):
        bank = bank.after(0.1).seen(seen.worth(1e-3)) or bank
    assert len(bank.hypotheses) == 2
    assert bank.hypotheses[0].weight / bank.hypotheses[1].weight == pytest.approx(odds, rel=0.5)


def test_three_markers_face_on_bring_the_true_pose_back() -> None:
    """They leave four poses open, each of which fits; the true one had been dropped."""
    pose: Pose = (rotation(1, 5, -3), np.array([0.1, 0.0, 1.8]))
    seen = sight(pose, np.random.default_rng(0), DOCK.names[1:])
    poses = sorted(seen.poses, key=lambda p: np.linalg.norm(turn_between(p.R, pose[0])))
    assert len(poses) == 4
    bank = Bank.of(replace(seen, poses=tuple(poses[1:])))
    assert all(np.linalg.norm(turn_between(h.state.R, pose[0])) > 0.3 for h in bank.hypotheses)
    back = bank.doubting(seen)
    assert len(back.hypotheses) == 4
    nearest = min(np.linalg.norm(turn_between(h.state.R, pose[0])) for h in back.hypotheses)
    assert np.degrees(nearest) < 5


def test_coming_nearer_decides(record_property: Any) -> None:
    """Perspective grows: at two metres only the true pose is left."""

    def course(time_s: float) -> Pose:
        return tilted(range_m=FAR_M - 0.5 * time_s)

    right, begun = 0, 0
    for seed in range(10):
        begun += len(Bank.of(sight(course(0.0), np.random.default_rng(seed))).hypotheses) == 2
        bank = followed(course, 6.0, seed)
        assert bank.hypotheses[0].weight > 0.99
        right += angle_deg(bank, course(6.0)[0]) < 5
    record_property("figure", f"track: approach decides rightly {right} of 10 times, {begun} open")
    assert begun >= 5
    assert right == 10


@pytest.mark.parametrize("mirrored", [False, True])
def test_an_attitude_decides_at_once_between_poses_pitched_up_and_down(mirrored: bool) -> None:
    """The dock hangs level; the vehicle's nose is down by 16 degrees."""
    R, t = rotation(-16.0, 0.0), np.array([0.0, 0.0, 4.0])
    attitude = Attitude(0.0, np.radians(16.0))
    level, covariance = expected(attitude, Mounting())
    assert np.allclose(level, R)
    seen = sight((R, t), np.random.default_rng(3))
    poses = seen.poses if len(seen.poses) == 2 else ()
    assert poses, "this view must be ambiguous"
    if mirrored:  # as if the wrong one fitted better
        poses = (replace(poses[1], chi_square=0.0), replace(poses[0], chi_square=1.0))
    bank = Bank.of(replace(seen, poses=poses)).facing(level, covariance)
    pitch = np.degrees(turn_between(bank.hypotheses[0].state.R, R))[0]
    assert abs(pitch) < 4
    assert bank.hypotheses[0].weight > 0.95


def test_the_first_stays_the_first_while_the_others_are_about_as_likely() -> None:
    seen = sight(tilted(), np.random.default_rng(1))
    first, second = seen.poses
    bank = Bank.of(
        replace(seen, poses=(replace(first, chi_square=0.0), replace(second, chi_square=0.0)))
    )
    leader = bank.hypotheses[0].state.R
    swaps = 0
    rng = np.random.default_rng(4)
    for _ in range(50):
        noise = rng.normal(0, 0.02, (4, 2))
        bank = bank.after(0.1).seen(undecided(tilted(), noise).worth(0.05)) or bank
        swaps += np.linalg.norm(turn_between(leader, bank.hypotheses[0].state.R)) > 0.3
        leader = bank.hypotheses[0].state.R
    assert swaps <= 1


def test_a_pose_that_was_dropped_comes_back_when_a_frame_shows_it() -> None:
    """Locked on the wrong pose of three markers, which fits as well as the true one."""
    R, t = rotation(0, 10), np.array([0.1, 0.0, 1.5])
    rng = np.random.default_rng(5)
    seen = sight((R, t), rng, names=DOCK.names[:3])
    downhill = [refined(seen.markers, rotation(0, yaw), t) for yaw in range(-60, 61, 20)]
    others = [p for p in downhill if p is not None and np.linalg.norm(turn_between(p.R, R)) > 0.3]
    assert others, "three markers must leave another pose open"
    assert others[0].chi_square < 0.1
    wrong = Bank.of(replace(seen, poses=(others[0],)))
    doubted = wrong.doubting(seen)
    assert any(np.linalg.norm(turn_between(h.state.R, R)) < 0.1 for h in doubted.hypotheses)
    assert angle_deg(doubted, R) > 10  # doubted, not believed yet
    assert len(Bank.of(seen).doubting(seen).hypotheses) == len(Bank.of(seen).hypotheses)


def test_the_ways_to_one_pose_count_once() -> None:
    """Downhill from several places one comes to the same pose, but for where the steps end; three
    markers that stand still before a vehicle that does leave their poses open."""
    pose = rotation(2, 25, 1), np.array([0.2, 0.1, 3.0])
    open_still = 0
    for seed in range(4):
        rng = np.random.default_rng(seed)
        bank = Bank.of(sight(pose, rng, DOCK.names[:3]))
        for _ in range(40):
            seen = sight(pose, rng, DOCK.names[:3]).worth(0.1)
            bank = bank.after(0.1).seen(seen) or bank
        open_still += bank.hypotheses[0].weight < 0.9
    assert open_still >= 3


def test_what_is_elsewhere_is_what_other_poses_have_beyond_5_percent_of_the_range() -> None:
    first, *_ = Bank.of(sight(tilted(), np.random.default_rng(1))).hypotheses
    for off, elsewhere in ((0.03, 0.0), (0.1, 0.2)):
        there = replace(first.state, t=(1 + off) * first.state.t)
        bank = Bank((Hypothesis(first.state, 0.8), Hypothesis(there, 0.2)))
        assert bank.elsewhere == elsewhere
    assert MOST_ELSEWHERE > FORGOTTEN


def test_what_shows_the_dock_only_where_it_hardly_can_be_is_not_believed_at_once() -> None:
    """A hypothesis that has just come up, far from the likeliest, and a frame that only it fits."""
    rng = np.random.default_rng(1)
    first = Bank.of(sight(tilted(), rng)).hypotheses[0]
    there: Pose = (rotation(0, TILT_DEG), np.array([1.2, 0.3, FAR_M]))
    other = Bank.of(sight(there, rng)).hypotheses[0]
    bank = Bank((Hypothesis(first.state, 1 - REBORN), Hypothesis(other.state, REBORN)))
    seen = [bank]
    for _ in range(3):
        seen.append(seen[-1].after(0.1).seen(sight(there, rng)) or seen[-1])
    leads = [np.linalg.norm(b.hypotheses[0].state.t - there[1]) < 0.5 for b in seen]
    assert [b.missed for b in seen[1:]] == [True, False, False]
    assert leads == [False, False, True, True]
    assert seen[1].hypotheses[0].weight == pytest.approx(0.5, abs=0.1)
    assert seen[3].hypotheses[0].weight > 0.99  # if frame after frame shows it there, it is there


def test_a_frame_beyond_the_gate_of_all_is_refused() -> None:
    bank = Bank.of(sight(tilted(), np.random.default_rng(1)))
    elsewhere = (rotation(0, TILT_DEG), np.array([1.2, 0.3, FAR_M]))
    assert bank.after(0.1).seen(sight(elsewhere, np.random.default_rng(2))) is None
    assert bank.after(3.0).seen(sight(elsewhere, np.random.default_rng(2))) is not None


@given(
    seed=st.integers(0, 10_000),
    tilt=st.floats(-25, 25),
    range_m=st.floats(1, 7),
    markers=st.sampled_from([DOCK.names, DOCK.names[:3], DOCK.names[1:]]),
)
def test_a_bank_is_a_distribution_whatever_it_sees(
    seed: int, tilt: float, range_m: float, markers: tuple[str, ...]
) -> None:
    rng = np.random.default_rng(seed)
    bank = Bank.of(sight(tilted(tilt, range_m), rng))
    for _ in range(4):
        seen = sight(tilted(tilt, range_m), rng, markers)
        bank = bank.after(0.1).seen(seen) or bank
        bank = bank.doubting(seen)
        weights = [h.weight for h in bank.hypotheses]
        assert 1 <= len(weights) <= MAX_HYPOTHESES
        assert sum(weights) == pytest.approx(1.0)
        assert min(weights) > FORGOTTEN / 2
        for h in bank.hypotheses:
            assert np.linalg.eigvalsh(h.state.covariance).min() > 0
            assert cv2.determinant(h.state.R) == pytest.approx(1.0)
