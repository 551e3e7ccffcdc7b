"""The computed page about power."""

import power
import pytest


def test_the_page_has_what_the_figures_give():
    assert power.BEGIN + power.table() + power.END in power.PAGE.read_text(encoding="utf-8")


def test_a_board_that_never_rests_draws_all_its_parts():
    current = power.board(0)
    assert current.least == pytest.approx(5 + 30 + 125 / 2.8)
    assert current.most == pytest.approx(11 + 68 + 125 / 1.3)


def test_longer_rests_approach_the_resting_board_from_above():
    currents = [power.board(interval).most for interval in power.INTERVALS_MS]
    assert currents == sorted(currents, reverse=True)
    assert power.board(10**9).most == pytest.approx(11 + 31 + 0.6, abs=0.01)


def test_a_tenth_of_the_time_awake_is_a_tenth_of_the_difference():
    # 0.6 s awake of 0.4 s more than the interval.
    tenth = power.board(5600)
    assert tenth.least == pytest.approx(5 + 0.1 * (30 + 125 / 2.8) + 0.9 * (20 + 0.6))
