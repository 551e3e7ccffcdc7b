"""The vehicle's attitude and position at a frame's time, by our clock."""

from __future__ import annotations

import math

import numpy as np
import pytest

from chromadock import Attitude
from chromadock.autopilot.frame_times import FrameTimes
from chromadock.autopilot.history import AHEAD_S, GAP_S, Telemetry
from chromadock.stamps import WINDOW, Stamps

BOOTED_S = 1000.0
"""When the autopilot was switched on, by our clock; messages take at least 2 ms."""
FASTEST_S = 0.002


def delays(rng: np.random.Generator) -> float:
    return FASTEST_S + float(rng.exponential(0.02))


def heading(time_s: float) -> float:
    """Half a radian a second, across the step from 180 to -180 degrees."""
    return math.remainder(math.pi - 0.2 + 0.5 * (time_s - BOOTED_S), 2 * math.pi)


def heard(period_s: float, until_s: float, seed: int = 1) -> Telemetry:
    telemetry, rng = Telemetry(), np.random.default_rng(seed)
    for k in range(round(until_s / period_s)):
        made_s = BOOTED_S + k * period_s
        ms, arrival_s = round(k * period_s * 1000), made_s + delays(rng)
        angles = Attitude(0.05, -0.1, heading(made_s))
        # Of a level body that would be yaw alone; by pitch and roll it is shared.
        rates = np.array([0.0, 0.0, 0.5])
        R = Attitude(0.05, -0.1, 0.0).R_world_body
        rates = R.T @ rates
        telemetry.heard_attitude(ms, arrival_s, angles, tuple(rates.tolist()))
        position = (2.0 + 0.3 * k * period_s, 1.0, 0.5)
        telemetry.heard_position(ms, arrival_s, position, (0.3, 0.0, 0.0))
    return telemetry


@pytest.mark.parametrize("hz", [4, 10, 50])
def test_attitude_and_position_are_those_of_the_frames_time(hz: int) -> None:
    telemetry = heard(1 / hz, 5.0)
    for time_s in np.arange(BOOTED_S + 3.1, BOOTED_S + 4.7, 0.033).tolist():
        attitude, position = telemetry.attitude(time_s), telemetry.position(time_s)
        assert attitude is not None and position is not None
        # What is left is the fastest message's time on the way, which nobody can see.
        error = math.remainder(attitude.yaw_rad - heading(time_s), 2 * math.pi)
        assert abs(error) < 0.5 * (FASTEST_S + 0.004)
        assert (attitude.roll_rad, attitude.pitch_rad) == pytest.approx((0.05, -0.1), abs=2e-3)
        assert position[0] == pytest.approx(2.0 + 0.3 * (time_s - BOOTED_S), abs=2e-3)


def test_a_little_beyond_the_newest_it_is_run_on_by_its_rates_and_no_further() -> None:
    telemetry = heard(0.1, 5.0)
    newest_s = BOOTED_S + 4.9
    ahead_s = newest_s + 0.9 * AHEAD_S
    attitude, position = telemetry.attitude(ahead_s), telemetry.position(ahead_s)
    assert attitude is not None and position is not None
    assert math.remainder(attitude.yaw_rad - heading(ahead_s), 2 * math.pi) == pytest.approx(
        0, abs=3e-3
    )
    assert position[0] == pytest.approx(2.0 + 0.3 * (4.9 + 0.9 * AHEAD_S), abs=2e-3)
    assert telemetry.attitude(newest_s + AHEAD_S + 0.1) is None
    assert telemetry.position(newest_s + AHEAD_S + 0.1) is None


def test_across_a_gap_and_before_the_first_nothing_is_known() -> None:
    telemetry = Telemetry()
    assert telemetry.attitude(1.0) is None and telemetry.position(1.0) is None
    for ms in (0, 100, round(200 + 1000 * GAP_S)):
        telemetry.heard_attitude(ms, BOOTED_S + ms / 1000, Attitude(0, 0, 0.1), (0, 0, 0))
    assert telemetry.attitude(BOOTED_S - 0.01) is None
    assert telemetry.attitude(BOOTED_S + 0.05) is not None
    assert telemetry.attitude(BOOTED_S + 0.1 + GAP_S / 2) is None


def test_an_autopilot_that_was_started_anew_is_another_clock() -> None:
    telemetry = heard(0.1, 5.0)
    again_s = BOOTED_S + 60
    telemetry.heard_attitude(100, again_s + 0.1, Attitude(0, 0, 1.0), (0, 0, 0))
    assert telemetry.attitude(BOOTED_S + 4.0) is None
    assert telemetry.position(BOOTED_S + 4.0) is None
    attitude = telemetry.attitude(again_s + 0.15)
    assert attitude is not None and attitude.yaw_rad == pytest.approx(1.0)


def test_the_same_message_twice_by_two_ways_counts_once() -> None:
    telemetry = Telemetry()
    for arrival_s in (BOOTED_S + 0.1, BOOTED_S + 0.13):
        telemetry.heard_attitude(100, arrival_s, Attitude(0, 0, 0.1), (0, 0, 0))
    telemetry.heard_attitude(200, BOOTED_S + 0.2, Attitude(0, 0, 0.3), (0, 0, 0))
    attitude = telemetry.attitude(BOOTED_S + 0.15)
    assert attitude is not None and attitude.yaw_rad == pytest.approx(0.2, abs=1e-6)


def test_the_fastest_message_tells_the_clock_and_a_slow_start_is_forgotten() -> None:
    stamps = Stamps()
    assert stamps.ours(1.0) is None and stamps.theirs(1.0) is None
    stamps.heard(0.0, 100.4)
    assert stamps.ours(0.0) == pytest.approx(100.4)
    stamps.heard(0.1, 100.103)
    assert stamps.ours(0.1) == pytest.approx(100.103)
    assert stamps.theirs(100.103) == pytest.approx(0.1)
    stamps.heard(0.2, 100.25)
    assert stamps.ours(0.2) == pytest.approx(100.203)
    # A clock that runs 1 in 10,000 slow: only so much is remembered of when it was right.
    for k in range(3, 4 * WINDOW):
        stamps.heard(k / 10, 100.003 + k / 10 * 1.0001)
    now_s = (4 * WINDOW - 1) / 10
    late_s = 100.003 + now_s * 1.0001 - (stamps.ours(now_s) or 0.0)
    assert 0 <= late_s <= 2 * WINDOW / 10 * 1e-4 + 1e-9


def test_frames_by_our_own_clock_keep_their_times_and_others_are_mapped() -> None:
    ours = FrameTimes()
    assert [ours.ours(50.0 + k, 50.06 + k) for k in range(3)] == [50.0, 51.0, 52.0]
    assert ours.foreign is False
    others = FrameTimes()  # seconds since the first frame, as a camera's are
    first = [others.ours(k / 10, 5000.0 + k / 10 + delay) for k, delay in ((0, 0.3), (1, 0.06))]
    assert first == pytest.approx([5000.3, 5000.16])
    assert others.ours(0.2, 5000.5) == pytest.approx(5000.26)
    assert others.foreign is True


def test_frames_that_tell_their_age_are_told_when_they_were_taken() -> None:
    """Whatever else is done between the age and the output, which makes it too late to say."""
    times, rng = FrameTimes(), np.random.default_rng(4)
    mapped = list[float]()
    for k in range(200):
        age_s, busy_s = float(rng.uniform(0.04, 0.3)), float(rng.exponential(0.005))
        mapped.append(times.ours(k / 20, 5000.0 + k / 20 + age_s + busy_s, age_s))
    assert times.foreign is False
    assert np.abs(np.array(mapped[20:]) - (5000.0 + np.arange(20, 200) / 20)).max() < 0.001


def test_mapped_times_never_go_back_even_where_a_recording_is_read_fast() -> None:
    times, mapped = FrameTimes(), list[float]()
    for k in range(300):
        mapped.append(times.ours(k / 30, 5000.0 + k / 90))
    assert mapped == sorted(mapped) and mapped[-1] <= 5000.0 + 299 / 90
