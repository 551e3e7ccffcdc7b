"""A vehicle that turns hard, and one that does not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from track_truth import approach, sight
from vehicle_truth import Yawing, followed, telemetry

from chromadock.track.bank import Bank
from chromadock.track.manoeuvre import LASTS_S, SELDOM, decided, later, missed
from chromadock.track.motion import TURNING, turning_of


def test_a_manoeuvre_is_forgotten() -> None:
    assert later(SELDOM, 3.0) == pytest.approx(SELDOM)
    assert later(0.9, 0.0) == 0.9
    assert later(0.9, LASTS_S) == pytest.approx(SELDOM + (0.9 - SELDOM) / np.e)


def test_a_quiet_vehicle_is_filtered_as_if_there_were_no_other() -> None:
    assert turning_of(0.0) == TURNING
    rng = np.random.default_rng(0)
    bank, swift, alone = Bank.of(sight(approach(0.0), rng)), SELDOM, 0
    for k in range(1, 31):
        seen = sight(approach(k / 10), rng)
        after = decided(lambda p, bank=bank: bank.after(0.1, p), seen, later(swift, 0.1))
        quiet = bank.after(0.1).seen(seen)
        assert after is not None and quiet is not None
        same = after[0].hypotheses[0].state.t == pytest.approx(quiet.hypotheses[0].state.t)
        alone += same
        bank, swift = after
    assert alone == 30
    assert swift < 0.1


def test_a_jump_of_the_bearing_is_a_manoeuvre_and_a_larger_one_another_thing() -> None:
    rng = np.random.default_rng(1)
    bank = Bank.of(sight(approach(0.0), rng))
    for k in range(1, 11):
        bank = bank.after(0.1).seen(sight(approach(k / 10), rng)) or bank
    R, t = approach(1.1)
    for off_m, expected in ((0.0, "quiet"), (0.25, "swift"), (1.5, "none")):
        place = t + np.array([off_m, 0.0, 0.0])
        seen = sight((R, place), rng)
        after = decided(lambda p: bank.after(0.1, p), seen, SELDOM)
        if expected == "none":
            assert after is None
            continue
        assert after is not None
        assert (after[1] > 0.5) == (expected == "swift")
        assert after[0].hypotheses[0].state.t == pytest.approx(place, abs=0.2)


@pytest.mark.parametrize("told", [False, True])
@pytest.mark.parametrize("hz", [5, 10])
def test_a_vehicle_that_yaws_fast_keeps_its_dock(hz: int, told: bool, record_property: Any) -> None:
    """15 degrees to either side in 1.5 s: up to 63 degrees a second."""
    tracked, covered, off_m, ahead, ahead_m = [], [], [], [], []
    for seed in range(3):
        vehicle = Yawing(15.0, 1.5, 1.3 * seed)
        attitude = telemetry(vehicle, hz) if told else None
        outcome = followed(vehicle, hz, 8.0, attitude, seed)
        tracked.append(outcome.tracked)
        covered.append(outcome.covered)
        off_m.append(outcome.off_m)
        ahead.append(outcome.predicted_covered)
        ahead_m.append(outcome.predicted_off_m)
    off_mm = 1000 * np.nanmedian(off_m)
    record_property(
        "figure",
        f"track: yaw at up to 63 degrees a second, {hz} frames a second, "
        f"{'with' if told else 'without'} attitude: {np.mean(tracked):.2f} tracked, "
        f"{off_mm:.0f} mm off, {np.mean(covered):.2f} in the 95% region; "
        f"0.15 s ahead {1000 * np.nanmedian(ahead_m):.0f} mm and {np.mean(ahead):.2f}",
    )
    assert np.mean(tracked) > 0.95
    assert np.mean(covered) >= 0.85
    assert off_mm < 60


@pytest.mark.parametrize("phase", range(16))
def test_it_is_caught_again_in_whatever_phase_it_was_met(phase: int) -> None:
    """At 5 frames a second it turns by up to 12 degrees from one to the next."""
    outcome = followed(Yawing(15.0, 1.5, 0.37 * phase), 5, 8.0, None, phase)
    assert np.mean(outcome.tracked) > 0.95


def test_a_miss_makes_a_manoeuvre_likelier_and_never_certain() -> None:
    assert SELDOM < missed(SELDOM) < 0.2
    swift = SELDOM
    for _ in range(100):
        swift = missed(swift)
        assert 0 < swift < 0.9999
    assert missed(0.0) == 0.0
