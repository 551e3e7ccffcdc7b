from __future__ import annotations

import pytest

from chromadock.rate import Rate


def test_the_rate_is_that_of_the_newest_results_and_ends_with_them() -> None:
    rate = Rate(silence_s=2.0)
    assert rate.hz(0.0) is None
    for second in range(60):
        rate.came(float(second))
    assert rate.hz(60.0) == pytest.approx(1.0)
    for number in range(40):
        rate.came(60.0 + number / 20)
    assert rate.hz(62.0) == pytest.approx(20.0)
    assert rate.hz(61.95 + 2.0) == pytest.approx(20.0)
    assert rate.hz(61.95 + 2.01) is None


def test_one_result_has_no_rate() -> None:
    rate = Rate(silence_s=2.0)
    rate.came(1.0)
    assert rate.hz(1.0) is None
