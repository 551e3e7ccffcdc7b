from __future__ import annotations

from math import comb

import numpy as np
import pytest

from chromadock.evaluate.statistics import independent_size, median_interval, wilson


@pytest.mark.parametrize(
    ("hits", "trials", "low", "high"),
    # Newcombe, Statistics in Medicine 17:857 (1998), table I, method 3.
    [
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ],
)
def test_wilsons_interval_is_that_of_newcombes_table(
    hits: int, trials: int, low: float, high: float
) -> None:
    assert wilson(hits, trials) == pytest.approx((low, high), abs=5e-5)


def test_all_and_none_stay_within_nought_and_one() -> None:
    assert wilson(0, 10)[0] == 0
    assert wilson(10, 10)[1] == 1
    assert 0 < wilson(10, 10)[0] < 1


@pytest.mark.parametrize("share", [0.05, 0.3, 0.5, 0.9])
def test_wilsons_interval_covers_the_true_share_as_often_as_it_says(share: float) -> None:
    rng = np.random.default_rng(1)
    hits = rng.binomial(100, share, 4000)
    ends = np.array([wilson(int(h), 100) for h in hits])
    covered = np.mean((ends[:, 0] <= share) & (share <= ends[:, 1]))
    assert covered == pytest.approx(0.95, abs=0.025)


@pytest.mark.parametrize("n", [6, 10, 25, 101, 500])
def test_the_medians_interval_is_the_narrowest_that_holds_its_confidence(n: int) -> None:
    low, high = median_interval(np.arange(n))
    assert low + high == n - 1
    missed = [2 * sum(comb(n, i) for i in range(int(k) + 1)) / 2**n for k in (low, low + 1)]
    assert missed[0] <= 0.05 < missed[1]


def test_the_medians_interval_covers_the_median_of_a_skewed_distribution() -> None:
    rng = np.random.default_rng(2)
    samples = rng.lognormal(1.0, 2.0, (3000, 40))
    ends = np.array([median_interval(s) for s in samples])
    covered = np.mean((ends[:, 0] <= np.e) & (np.e <= ends[:, 1]))
    assert 0.94 < covered < 0.985  # at least 0.95 by theory, whole ranks make it more


def test_few_values_have_their_extremes_for_an_interval() -> None:
    assert median_interval([3.0]) == (3, 3)
    assert median_interval([5.0, 1.0, 3.0]) == (1, 5)


def test_independent_values_count_as_many_as_they_are() -> None:
    rng = np.random.default_rng(3)
    sizes = [independent_size(rng.random(400) < 0.3, 20) for _ in range(200)]
    assert 300 < np.median(sizes) <= 400
    assert independent_size(np.ones(50), 10) == 50


def test_repeated_values_count_once() -> None:
    rng = np.random.default_rng(4)
    sizes = [independent_size(np.repeat(rng.random(80), 10), 50) for _ in range(200)]
    assert np.median(sizes) == pytest.approx(80, rel=0.3)


def test_intervals_of_correlated_frames_cover_only_with_their_independent_size(
    record_property,
) -> None:
    """A share of frames found, where what decides it lasts some ten frames."""
    rng = np.random.default_rng(5)
    naive = corrected = median_naive = median_corrected = 0
    count, n, block = 400, 1000, 100
    for _ in range(count):
        series = ar1(n, 0.9, rng)
        found = series > 0
        naive += covers(wilson(found.sum(), n), 0.5)
        size = independent_size(found, block)
        corrected += covers(wilson(found.sum() * size / n, size), 0.5)
        median_naive += covers(median_interval(series), 0)
        below = series <= np.median(series)
        size = independent_size(below, block)
        median_corrected += covers(median_interval(series, size=size), 0)
    record_property(
        "figure",
        f"95% intervals of correlated frames cover {naive / count:.2f} as independent, "
        f"{corrected / count:.2f} by blocks; of medians {median_naive / count:.2f}, "
        f"{median_corrected / count:.2f}",
    )
    assert naive / count < 0.7
    assert median_naive / count < 0.7
    assert corrected / count > 0.88
    assert median_corrected / count > 0.88


def ar1(n: int, memory: float, rng: np.random.Generator) -> np.ndarray:
    """Unit variance, correlated by ``memory`` from each value to the next."""
    series = np.empty(n)
    value = rng.normal()
    for i, shock in enumerate(rng.normal(0, np.sqrt(1 - memory**2), n)):
        series[i] = value = memory * value + shock
    return series


def covers(ends: tuple[float, float], value: float) -> bool:
    return ends[0] <= value <= ends[1]
