"""Attitudes that come slower than frames, rounded, late, or not at all."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from vehicle_truth import Outcome, Yawing, followed, telemetry

from chromadock import Attitude
from chromadock.mounting import R_BODY_CAMERA_FORWARD as FORWARD
from chromadock.track.telemetry import (
    COARSE_RAD,
    LONGEST_S,
    NOISE_RAD,
    RATE_FLOOR,
    UNHEARD,
    WORTH_RAD_S,
    Telemetry,
)


def told(readings: list[tuple[float, float | None]]) -> list[Telemetry]:
    """Of (time, yaw in degrees or None for no attitude)."""
    heard, after = UNHEARD, []
    for time_s, yaw_deg in readings:
        attitude = None if yaw_deg is None else Attitude(0.0, 0.0, float(np.radians(yaw_deg)))
        heard = heard.heard(time_s, attitude, FORWARD)
        after.append(heard)
    return after


def rates(readings: list[tuple[float, float | None]]) -> list[float | None]:
    """Degrees a second about the camera's y, to the right."""
    return [None if t.turn is None else float(np.degrees(t.turn.rate[1])) for t in told(readings)]


def test_an_attitude_of_each_frame_tells_the_rate_since_the_last() -> None:
    fine = [(0.1 * k, 2.0 * k + 0.0001 * (k % 2)) for k in range(5)]
    assert rates(fine)[2:] == pytest.approx([20.0] * 3, abs=0.01)


def test_the_same_attitude_again_is_no_news_and_takes_no_time() -> None:
    """10 Hz at 30 frames a second: the turn between two readings over the time between them."""
    held = [(k / 30, 3.0 * (k // 3) + 0.0001 * (k // 6)) for k in range(16)]
    found = rates(held)
    assert [r is not None for r in found[6:]] == [k % 3 == 0 for k in range(6, 16)]
    assert [r for r in found[6:] if r is not None] == pytest.approx([30.0] * 4, abs=0.1)


def test_no_attitude_with_some_frames_is_the_same_as_a_held_one() -> None:
    held: list[tuple[float, float | None]] = [(k / 30, 3.0 * (k // 3)) for k in range(16)]
    now_and_then = [(t, yaw if k % 3 == 0 else None) for k, (t, yaw) in enumerate(held)]
    assert rates(held) == rates(now_and_then)


def test_the_errors_of_two_readings_count_over_the_time_between_them() -> None:
    fine = [(0.0, 0.0), (0.1, 1.0), (0.2, 1.0001), (0.3, 3.0)]
    turn = told(fine)[-1].turn
    assert turn is not None
    assert turn.variance == pytest.approx(RATE_FLOOR**2 + 2 * (NOISE_RAD / 0.1) ** 2, rel=0.01)


def test_a_reading_that_may_be_older_than_its_frame_is_less_sure_of_a_fast_turn() -> None:
    each = told([(0.1 * k, 4.0 * k + 0.0001 * (k % 2)) for k in range(4)])[-1].turn
    held = told([(k / 20, 4.0 * (k // 2) + 0.0001 * (k // 4)) for k in range(7)])[-1].turn
    assert each is not None and held is not None
    assert each.rate == pytest.approx(held.rate, abs=1e-3)
    late = np.radians(40.0) * 0.05 / np.sqrt(6) / 0.1
    assert held.variance - each.variance == pytest.approx(late**2, rel=0.01)


def test_a_rounded_step_is_not_taken_for_a_jump() -> None:
    """Steps of a degree at a boundary, up and down with each frame: no rate is told before it is
    known to WORTH_RAD_S, and then it is about zero."""
    toggling = [(k / 30, float(k % 2)) for k in range(60)]
    turns = [t.turn for t in told(toggling) if t.turn is not None]
    assert 3 < len(turns) < 20
    for turn in turns:
        assert turn.variance < WORTH_RAD_S**2 + RATE_FLOOR**2 + 0.01
        assert np.linalg.norm(turn.rate) < 2 * np.sqrt(turn.variance)


def test_the_step_of_rounded_readings_is_learnt() -> None:
    steps = told([(0.1 * k, float(np.round(2.5 * np.sin(k) * 2) / 2)) for k in range(30)])
    assert steps[0].error_rad == pytest.approx(np.hypot(NOISE_RAD, COARSE_RAD / 2))
    assert np.degrees(steps[-1].step_rad[2]) == pytest.approx(0.5)
    assert steps[-1].error_rad == pytest.approx(np.hypot(NOISE_RAD, np.radians(0.25)))


def test_coarse_readings_that_stay_are_a_vehicle_at_rest() -> None:
    turns = [t.turn for t in told([(0.1 * k, 7.0) for k in range(12)])]
    resting = round(10 * LONGEST_S)
    assert all(turn is None for turn in turns[:resting])
    for turn in turns[resting + 1 :]:
        assert turn is not None and not turn.rate.any()
        assert RATE_FLOOR < np.sqrt(turn.variance) < 0.05


def test_fine_readings_that_stay_are_a_telemetry_that_has_stopped() -> None:
    live = [(0.1 * k, np.sin(k) + 0.001 * k) for k in range(40)]
    live += [(4.0 + 0.1 * k, live[-1][1] + 0.004) for k in range(12)]
    after = told(live)
    assert after[39].turn is not None
    assert all(t.turn is None and t.fresh is None for t in after[41:])
    assert not after[43].silent(4.3) and after[-1].silent(5.1)


def test_a_gap_tells_no_rate() -> None:
    gap = [(0.0, 0.0), (0.1, 1.0), (0.2, 2.2), (0.2 + 1.5 * LONGEST_S, 20.0), (1.1, 22.0)]
    assert rates(gap)[3] is None
    assert rates(gap)[4] is not None


def test_the_heading_passes_north() -> None:
    north = [(0.1 * k, (356.0 + 2.0 * k) % 360 + 0.0001 * (k % 2)) for k in range(5)]
    assert rates(north)[2:] == pytest.approx([20.0] * 3, abs=0.01)


def test_roll_and_pitch_alone_tell_no_rate() -> None:
    heard = UNHEARD
    for k in range(5):
        heard = heard.heard(0.1 * k, Attitude(0.01 * k, 0.02 * k), FORWARD)
        assert heard.turn is None and heard.fresh is not None


KINDS = {
    "10 Hz": (10.0, 0.0),
    "10 Hz in steps of 1 degree": (10.0, 1.0),
    "4 Hz": (4.0, 0.0),
    "each frame": (30.0, 0.0),
    "each frame in steps of 1 degree": (30.0, 1.0),
}


def swaying(seed: int) -> Yawing:
    """Yaw within 10 degrees in 4 s."""
    return Yawing(10.0, 4.0, 1.3 * seed)


@cache
def without_attitude(seed: int) -> Outcome:
    """What every kind of telemetry is compared with."""
    return followed(swaying(seed), 30, 6.0, None, seed)


@pytest.mark.parametrize("kind", KINDS)
def test_telemetry_however_slow_never_makes_the_prediction_worse(
    kind: str, record_property: Any
) -> None:
    """30 frames a second, yaw within 10 degrees in 4 s; the pose 0.15 s ahead, against that of a
    tracker without any attitude."""
    rate_hz, step_deg = KINDS[kind]
    covered, with_it, without = [], [], []
    for seed in range(2):
        vehicle = swaying(seed)
        told = followed(vehicle, 30, 6.0, telemetry(vehicle, rate_hz, step_deg), seed)
        alone = without_attitude(seed)
        assert told.tracked.all() and alone.tracked.all()
        covered.append(told.covered)
        with_it.append(told.predicted_off_m)
        without.append(alone.predicted_off_m)
    share = float(np.mean(covered))
    told_mm, alone_mm = (1000 * float(np.quantile(v, 0.95)) for v in (with_it, without))
    record_property(
        "figure",
        f"track: attitude {kind} at 30 frames a second, yaw within 10 degrees: "
        f"the truth in the 95% region {share:.2f}, predicted 0.15 s ahead to {told_mm:.0f} mm "
        f"(95%), {alone_mm:.0f} mm without attitude",
    )
    assert share >= 0.9
    assert told_mm < 1.1 * alone_mm
    assert np.median(with_it) < 1.1 * np.median(without)
