"""Confidence intervals of shares and medians, for independent and for correlated frames.

Both intervals assume independent values.  Frames of one run are not: waves, flicker and a
slow automatic exposure last over several of them, and the interval of so many frames is
too narrow.  ``independent_size`` tells how many independent values a series is worth, by
comparing consecutive blocks; give that number where an interval is to hold for another day
in the same water and not only for another camera's noise on the same day.
"""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike, NDArray

CONFIDENCE = 0.95


def wilson(hits: float, trials: float, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Ends of the score interval of a share: Wilson, J. Am. Stat. Assoc. 22:209 (1927).

    Parameters
    ----------
    hits : 0..trials.
    trials : how many independent ones, above 0; need not be whole.
    confidence : 0..1.
    """
    z2 = NormalDist().inv_cdf((1 + confidence) / 2) ** 2
    share = hits / trials
    centre = (share + z2 / (2 * trials)) / (1 + z2 / trials)
    half = math.sqrt(z2 * (share * (1 - share) / trials + z2 / (4 * trials**2)))
    half /= 1 + z2 / trials
    return max(0.0, centre - half), min(1.0, centre + half)


def median_interval(
    values: ArrayLike, confidence: float = CONFIDENCE, size: float | None = None
) -> tuple[float, float]:
    """Ends of the interval of a median between two of the sorted values, for any distribution.

    The rank of the median among n values is binomial with share 1/2 (David, Nagaraja, Order
    Statistics, 2003, section 7.1); the ranks are the innermost symmetric ones whose interval
    has at least the confidence.  With so few values that none has, the ends are the extremes.

    Parameters
    ----------
    values : (n,) without NaN, n > 0.
    confidence : 0..1.
    size : how many independent values they are worth, at most n; None for n.
    """
    ordered = np.sort(np.asarray(values, np.float64).ravel())
    n = len(ordered)
    worth = n if size is None else max(1, min(n, round(size)))
    # Ranks among `worth` values, then the same shares of n, outwards.
    skipped = _ranks_outside(worth, confidence)
    first = math.floor(skipped * n / worth)
    return float(ordered[first]), float(ordered[n - 1 - first])


def _ranks_outside(n: int, confidence: float) -> int:
    """How many values lie outside on each side."""
    # With k outside, the interval misses the median where at most k values lie on one side
    # of it: P = sum of C(n, i) / 2^n for i = 0..k, and as much for the other side.
    tail, outside = 0.0, 0
    log_half = n * math.log(0.5)
    for k in range((n + 1) // 2):
        choose = math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1)
        tail += math.exp(choose + log_half)
        if 2 * tail > 1 - confidence:
            break
        outside = k
    return outside


def independent_size(values: ArrayLike, block: int) -> float:
    """How many independent values a series in time order is worth, 1..n.

    n times the variance that a block's mean would have if its values were independent, over
    the variance that the blocks' means do have: n over the design effect of cluster sampling (Kish,
    Survey Sampling, 1965, section 8.2).  Blocks must be longer than what correlates the
    values; with few blocks the answer is rough.

    Parameters
    ----------
    values : (n,), any numbers or truth values; n > 0.  A constant series shows no
        correlation and counts as independent.
    block : values a block, above 0; a shorter rest at the end is left out.
    """
    series: NDArray[np.float64] = np.asarray(values, np.float64).ravel()
    n, count = len(series), len(series) // block
    spread = float(series.var())
    if spread == 0:
        return float(n)
    if count < 2:
        return 1.0
    means = series[: count * block].reshape(count, block).mean(axis=1)
    effect = float(means.var(ddof=1)) * block / spread
    return n / effect if effect > 1 else float(n)
