"""Random waves and motion as sums of sinusoids: any moment and place, in any order."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.sim.spectrum import FloatArray

GRAVITY_M_S2 = 9.81

_SINUSOIDS = 32
_SWAY_SINUSOIDS = 5
_SWAY_SPREAD = 0.35
"""Bobbing bodies answer to a band of periods around their own."""


@dataclass(frozen=True)
class GaussianField:
    """Waves on deep water, as a unit-variance Gaussian field and as the surface's slope.

    The wavelengths lie evenly in their logarithm, the directions evenly around the circle;
    each wave runs with its own speed, omega^2 = g k. Default lengths give 0.5 to 4 Hz.

    Parameters
    ----------
    seed
        Another seed, another sea.
    wind_m_s
        Wind speed at mast height, m/s, for the slope alone.
    shortest_m, longest_m
        Limits of the wavelengths, m.
    """

    seed: int
    wind_m_s: float = 5.0
    shortest_m: float = 0.1
    longest_m: float = 6.0

    def value(self, time_s: ArrayLike, x_m: ArrayLike, y_m: ArrayLike) -> FloatArray:
        """Unit-variance, zero-mean Gaussian, of the shape that the arguments broadcast to."""
        waves = np.cos(self._phases(time_s, x_m, y_m))
        return np.asarray(_amplitude() * waves.sum(axis=0), dtype=np.float64)

    def slope(self, time_s: ArrayLike, x_m: ArrayLike, y_m: ArrayLike) -> FloatArray:
        """(..., 2): how fast the surface rises (upwards) along x and y, of the same waves.

        The mean square slope is 0.003 + 0.00512 W, both axes together: Cox, C. and Munk, W.
        (1954), "Measurement of the roughness of the sea surface from photographs of the sun's
        glitter", J. Opt. Soc. Am. 44, 838-850.
        """
        rms = math.sqrt(0.003 + 0.00512 * self.wind_m_s)
        waves = np.sin(self._phases(time_s, x_m, y_m))
        falls = np.tensordot(waves, self._directions.astype(np.float32), axes=(0, 0))
        return np.asarray(-rms * _amplitude() * falls, dtype=np.float64)

    def _phases(self, time_s: ArrayLike, x_m: ArrayLike, y_m: ArrayLike) -> NDArray[np.float32]:
        """(n, ...) radians; single precision, whose cosine is thirty times faster."""
        time = np.asarray(time_s, dtype=np.float64)
        x, y = np.asarray(x_m, dtype=np.float32), np.asarray(y_m, dtype=np.float32)
        # The waves' axis comes first: rows over the points are long, and so fast.
        first = (_SINUSOIDS, *[1] * np.broadcast(time, x, y).ndim)
        omega = np.sqrt(GRAVITY_M_S2 * self._numbers).reshape(first)
        # Whole turns go in double precision: days of waves stay as exact as their first second.
        turned = np.remainder(self._starts.reshape(first) - omega * time, 2 * math.pi)
        along = (self._numbers * self._directions.T).astype(np.float32)
        run = along[0].reshape(first) * x + along[1].reshape(first) * y
        return np.asarray(run + turned.astype(np.float32))

    @cached_property
    def _numbers(self) -> FloatArray:
        """(n,) wave numbers, 1/m."""
        length = self.shortest_m * (self.longest_m / self.shortest_m) ** self._strata[0]
        return np.asarray(2 * math.pi / length)

    @cached_property
    def _directions(self) -> FloatArray:
        """(n, 2) unit vectors along which the waves run."""
        heading = 2 * math.pi * self._strata[1]
        return np.stack([np.cos(heading), np.sin(heading)], axis=1)

    @cached_property
    def _starts(self) -> FloatArray:
        """(n,) phases at time 0, radians."""
        return np.asarray(2 * math.pi * self._strata[2])

    @cached_property
    def _strata(self) -> FloatArray:
        """(3, n) in 0..1: each row has one draw in each of n equal strata, in random order.

        So no seed misses a length or a direction.
        """
        rng = np.random.default_rng(self.seed)
        draws = (np.arange(_SINUSOIDS) + rng.random((3, _SINUSOIDS))) / _SINUSOIDS
        return rng.permuted(draws, axis=1)


@dataclass(frozen=True)
class Sway:
    """A body's bobbing along or about one axis: a few sinusoids around a period.

    Parameters
    ----------
    seed
        Another seed, another motion.
    amplitude
        Of the sinusoid with the same root mean square, in any unit; the sum exceeds it at times.
    period_s
        The middle period, s.
    """

    seed: int
    amplitude: float
    period_s: float

    def value(self, time_s: ArrayLike) -> FloatArray:
        """The deviation from rest, in the amplitude's unit, of the shape of ``time_s``."""
        frequency, phase = self._sinusoids
        time = np.asarray(time_s, dtype=np.float64)[..., None]
        waves = np.cos(2 * math.pi * frequency * time + phase)
        return np.asarray(self.amplitude * waves.sum(axis=-1) / math.sqrt(_SWAY_SINUSOIDS))

    @cached_property
    def _sinusoids(self) -> tuple[FloatArray, FloatArray]:
        rng = np.random.default_rng(self.seed)
        strata = (np.arange(_SWAY_SINUSOIDS) + rng.random(_SWAY_SINUSOIDS)) / _SWAY_SINUSOIDS
        frequency = (1 + _SWAY_SPREAD * (2 * strata - 1)) / self.period_s
        return frequency, 2 * math.pi * rng.random(_SWAY_SINUSOIDS)


def _amplitude() -> float:
    """Of each of n equal sinusoids with the variance 1 together."""
    return math.sqrt(2 / _SINUSOIDS)
