"""How alike the strengths of a dock's markers are, and what that says.

All markers shine alike: log strengths scatter little about a common value of which nothing is
known, and about a slope from one end of the dock to the other, since the end that is turned
away is seen through more water.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.peaks import MIN_SNR

SPREAD = 0.25
"""Standard deviation of the log strength of one dock's markers: where in a cell each falls,
a little range and angle."""

SLOPE = 0.3
"""Standard deviation of what the log strength changes from the dock's middle to its end: the
usual yaw puts the end of the paper's dock 0.15 m nearer or farther, in water of 2 m visibility."""

STRONGEST = 400.0
"""Signal to noise of markers in a clear pool at a metre; the common value is even in its
logarithm up to there."""

_LOG_RANGE = float(np.log(STRONGEST / MIN_SNR))


def variance(snr: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of the log strength of a marker that stands out by ``snr``."""
    return np.asarray(SPREAD**2 + 1 / snr**2)


def log_alike(snr: NDArray[np.float64], along: NDArray[np.float64]) -> NDArray[np.float64]:
    """(M,) log density of the log strengths of sets of markers, (M, n) signals to noise.

    The integral over the common value and the slope, of the product of normal densities about
    them.  ``along`` (n,): where the markers are along the dock, -1..1.
    """
    value, weight = np.log(snr), 1 / variance(snr)
    # Normal equations of value = common + slope along, the slope's prior included.
    powers = along[:, None] ** np.arange(3)
    a, b, c = (weight @ powers).T
    c = c + 1 / SLOPE**2
    x, y = (weight * value @ powers[:, :2]).T
    determinant = a * c - b * b
    off = (weight * value**2).sum(axis=1) - (c * x * x - 2 * b * x * y + a * y * y) / determinant
    norm = np.log((weight / (2 * np.pi)).prod(axis=1) / (determinant / (2 * np.pi)))
    return np.asarray(0.5 * (norm - off) - np.log(SLOPE) - np.log(_LOG_RANGE))


def log_unlike(
    snr: NDArray[np.float64], other: NDArray[np.float64], apart: float
) -> NDArray[np.float64]:
    """(N,) the least that ``log_alike`` of any set with both of (N,) markers falls below its most.

    Their difference alone: density of all = density of it, times that of the others given it.
    ``apart``: the markers' distance along the dock.
    """
    spread = variance(snr) + variance(other) + (SLOPE * apart) ** 2
    return np.asarray(-0.5 * np.log(snr / other) ** 2 / spread)


def placed_along(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where (n, 3) markers are along the dock's longest extent: (n,), its ends at most 1 off."""
    centred = points - points.mean(axis=0)
    along = centred @ np.linalg.svd(centred)[2][0]
    return np.asarray(along / np.abs(along).max())
