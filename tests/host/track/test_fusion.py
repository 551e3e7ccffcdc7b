from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from track_truth import CAMERA, DOCK, approach, rotation, sight

from chromadock.mounting import R_BODY_CAMERA_FORWARD as FORWARD
from chromadock.mounting import Mounting
from chromadock.robust.weigh.shape import ATTITUDE_RAD
from chromadock.track.attitude import Attitude, expected
from chromadock.track.bank import Bank
from chromadock.track.fusion import with_attitude, with_markers, with_turn_rate
from chromadock.track.motion import POSE, met, turn_between
from chromadock.track.sight import FLOOR_PX, Sight


def nees(state: Any, pose: tuple[np.ndarray, np.ndarray]) -> float:
    off = np.concatenate([pose[1] - state.t, turn_between(state.R, pose[0])])
    return float(off @ np.linalg.solve(state.covariance[POSE, POSE], off))


def test_the_true_pose_lies_where_the_covariance_says(record_property: Any) -> None:
    """Normalised errors squared of 60 runs, independent noise, against chi-square with 6."""
    squares = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        bank = Bank.of(sight(approach(0.0), rng))
        for k in range(1, 31):
            after = bank.after(0.1).seen(sight(approach(0.1 * k), rng))
            assert after is not None
            bank = after
        squares.append(min(nees(h.state, approach(3.0)) for h in bank.hypotheses))
    share = float(np.mean(np.array(squares) < 12.59))
    record_property(
        "figure",
        f"track: the truth is in the 95% region in {share:.2f} of {len(squares)} synthetic runs, "
        f"mean of the normalised errors squared {np.mean(squares):.1f}, of 6",
    )
    # The floor is added to noise that is all there is here, so errors are smaller than told.
    assert share >= 0.9
    assert 1.5 < np.mean(squares) < 7.5


def test_a_filtered_place_is_better_than_those_of_single_frames() -> None:
    """Far away, where a frame knows the distance to some percent."""
    R, t = rotation(5, 15), np.array([0.2, 0.0, 6.0])
    single, filtered = [], []
    for seed in range(15):
        rng = np.random.default_rng([1, seed])
        bank = Bank.of(sight((R, t), rng))
        for _ in range(30):
            seen = sight((R, t), rng)
            bank = bank.after(0.1).seen(seen) or bank
            single.append(np.linalg.norm(seen.poses[0].t - t))
        filtered.append(np.linalg.norm(bank.hypotheses[0].state.t - t))
    assert np.mean(filtered) < 0.7 * np.mean(single)


def test_three_markers_correct_a_prediction() -> None:
    R, t = approach(2.0)
    rng = np.random.default_rng(3)
    begun = met(R, t + np.array([0.05, -0.04, 0.1]), np.diag([0.01] * 3 + [0.01] * 3))
    seen = sight((R, t), rng, names=DOCK.names[:3])
    fused = with_markers(begun, seen.markers, begun.R, begun.t)
    assert fused is not None and fused.within_gate
    assert fused.freedom == 6
    assert np.linalg.norm(fused.state.t - t) < 0.5 * np.linalg.norm(begun.t - t)
    assert nees(fused.state, (R, t)) < 20


@pytest.mark.parametrize(
    ("off_m", "within"), [(0.0, True), (0.1, True), (0.6, False), (1.5, False)]
)
def test_a_dock_elsewhere_is_beyond_the_gate(off_m: float, within: bool) -> None:
    R, t = approach(2.0)
    begun = met(R, t + np.array([off_m, 0.0, 0.0]), np.diag([0.08**2] * 3 + [0.1**2] * 3))
    seen = sight((R, t), np.random.default_rng(5))
    fused = with_markers(begun, seen.markers, begun.R, begun.t)
    assert fused is not None
    assert fused.within_gate == within


def test_true_measurements_are_gated_out_once_in_a_thousand() -> None:
    rng = np.random.default_rng(6)
    R, t = approach(2.0)
    spread = np.diag([0.02**2] * 3 + [0.03**2] * 3)
    out = 0
    for _ in range(400):
        off = rng.multivariate_normal(np.zeros(6), spread)
        begun = met(rotation(*np.degrees(off[3:])) @ R, t + off[:3], spread)
        seen = sight((R, t), rng)
        fused = with_markers(begun, seen.markers, begun.R, begun.t)
        assert fused is not None
        out += not fused.within_gate
    assert out <= 3


def test_a_pose_behind_the_camera_is_no_measurement() -> None:
    R, t = approach(0.0)
    seen = sight((R, t), np.random.default_rng(0))
    assert with_markers(met(R, t, np.eye(6)), seen.markers, R, -t) is None


def test_an_attitude_turns_the_dock_and_what_is_correlated() -> None:
    R, t = rotation(10, 0), np.array([0.0, 0.0, 4.0])
    begun = met(R, t, np.diag([0.01] * 3 + [0.2**2] * 3))
    fused = with_attitude(begun, np.eye(3), np.eye(3) * 0.02**2)
    assert np.linalg.norm(turn_between(fused.state.R, np.eye(3))) < 0.1 * np.radians(10)
    assert fused.state.t == pytest.approx(t)
    assert with_attitude(begun, np.eye(3), np.eye(3)).log_likelihood != fused.log_likelihood


def test_a_rate_of_turn_is_taken_in() -> None:
    begun = met(*approach(0.0), np.eye(6) * 1e-4)
    fused = with_turn_rate(begun, np.array([0.0, 0.3, 0.0]), 0.02**2)
    assert fused.state.turn_rate == pytest.approx([0.0, 0.3, 0.0], abs=0.01)
    vague = with_turn_rate(begun, np.array([0.0, 0.3, 0.0]), 0.3**2)
    assert vague.state.turn_rate == pytest.approx([0.0, 0.15, 0.0], abs=0.01)


def test_the_errors_of_markers_have_a_floor() -> None:
    seen = sight(approach(3.0), np.random.default_rng(0))
    assert seen.markers.sigma_px == pytest.approx(np.hypot(0.3, FLOOR_PX), rel=0.02)
    assert seen.worth(0.25).markers.sigma_px == pytest.approx(2 * seen.markers.sigma_px)
    assert isinstance(seen.worth(1.0), Sight)


def leaning(seen: Sight, share: float) -> Sight:
    """A sight whose markers are all nearer to the dock's middle by that, or one standard error so
    says."""
    pixels = seen.markers.pixels
    lean = -share * (pixels - pixels.mean(axis=0))
    return replace(seen, markers=replace(seen.markers, pixels=pixels + lean), smaller=share)


def test_what_all_frames_share_no_number_of_frames_makes_less() -> None:
    """A dock that seems 3 % smaller in each frame is taken for farther, and the track knows."""
    pose = rotation(5, 15), np.array([0.2, 0.0, 4.0])
    rng = np.random.default_rng(7)
    bank, known = Bank.of(leaning(sight(pose, rng), 0.03)), []
    for _ in range(60):
        bank = bank.after(0.1).seen(leaning(sight(pose, rng), 0.03)) or bank
        known.append(bank.hypotheses[0].state.as_told.covariance[2, 2] ** 0.5)
    state = bank.hypotheses[0].state
    assert state.t[2] - 4.0 == pytest.approx(0.12, abs=0.04)
    assert state.covariance[2, 2] ** 0.5 < 0.04
    assert known[-1] == pytest.approx(0.12, abs=0.03)
    assert nees(state.as_told, pose) < 12.59 < nees(state, pose)


def test_frames_without_a_shared_error_take_it_away() -> None:
    pose = rotation(5, 15), np.array([0.2, 0.0, 4.0])
    rng = np.random.default_rng(8)
    bank = Bank.of(sight(pose, rng))
    for share in (*[0.03] * 40, *[0.0] * 40):
        bank = bank.after(0.1).seen(leaning(sight(pose, rng), share)) or bank
        if share:
            drawn = bank.hypotheses[0].state.drawn[2]
    assert drawn > 0.08
    assert abs(bank.hypotheses[0].state.drawn[2]) < 0.2 * drawn


def test_a_level_forward_camera_sees_a_level_dock_as_it_is() -> None:
    R, covariance = expected(None, Mounting())
    assert pytest.approx(np.eye(3)) == R
    pitch, yaw, roll = ATTITUDE_RAD
    swims = max(pitch, roll)
    assert np.sqrt(np.diag(covariance)) == pytest.approx([swims, yaw, swims])


@pytest.mark.parametrize(
    ("attitude", "axis", "sign"),
    [(Attitude(0.2, 0.0), 2, -1), (Attitude(0.0, 0.2), 0, -1), (Attitude(0.0, 0.0, 0.2), 1, 0)],
)
def test_what_the_vehicle_turns_by_the_dock_turns_by_the_other_way(
    attitude: Attitude, axis: int, sign: int
) -> None:
    """Roll right: the dock turns left about z.  Nose up: about x.  A heading alone says nothing."""
    R, covariance = expected(attitude, Mounting())
    assert turn_between(np.eye(3), R) == pytest.approx(sign * 0.2 * np.eye(3)[axis])
    down = R @ [0, 1, 0]
    assert np.sqrt(down @ covariance @ down) == pytest.approx(ATTITUDE_RAD[1])


def test_a_camera_that_looks_down_expects_the_dock_before_it_turned() -> None:
    """Pitched down by 90 degrees: image up is ahead, so the dock's down is the camera's forward."""
    R_body_down = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    R, _ = expected(None, Mounting(R_body_down))
    assert pytest.approx([0, 0, 1]) == R @ [0, 1, 0]
    assert pytest.approx([0, -1, 0]) == R @ [0, 0, 1]


def test_the_rate_of_turn_of_a_camera_is_in_its_own_axes() -> None:
    before, after = Attitude(0.0, 0.0, 3.1), Attitude(0.0, 0.0, -3.1)
    turn = after.turn_since(before, FORWARD)
    assert turn == pytest.approx([0.0, 2 * np.pi - 6.2, 0.0])  # right: about the camera's y
    assert Attitude(0.0, 0.1, 0.0).turn_since(Attitude(0.0, 0.0, 0.0), FORWARD) == pytest.approx(
        [0.1, 0.0, 0.0]
    )
    assert Attitude(0.0, 0.0).turn_since(before, FORWARD) is None


def test_a_sight_knows_its_camera() -> None:
    assert sight(approach(0.0), np.random.default_rng(0)).markers.camera is CAMERA
