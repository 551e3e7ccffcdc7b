"""Into which directions water scatters light: Petzold's measured functions."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache

import jerlov
import numpy as np
from numpy.typing import ArrayLike

from chromadock.sim.spectrum import FloatArray

SMALLEST_ANGLE_RAD = 1e-9
"""The forward peak is a power law that diverges at 0; smaller angles count as this one."""

_DENSE = 4000
"""Angles of the cumulative integral: trapezoids are then good to 1e-6."""


@dataclass(frozen=True, eq=False)
class PhaseFunction:
    """The phase function of one of Petzold's (1972) stations, normalised to 1 over the sphere.

    Between the printed angles it is a straight line in log-log. Below 0.1 degree, where
    nothing was measured, it is the report's own power law, whose slope follows from the
    share of b that the report puts there.
    """

    station: str
    angles_rad: FloatArray
    """(55,) the report's angles, 0.1 degree to pi."""
    values: FloatArray
    """(55,) sr^-1 at these angles."""
    forward_slope: float
    """s of value ~ angle^-s below 0.1 degree."""
    _dense_rad: FloatArray = field(repr=False)
    _dense_share: FloatArray = field(repr=False)

    @staticmethod
    @cache
    def of(station: str) -> PhaseFunction:
        """The function of a station of ``jerlov.PETZOLD_STATIONS``."""
        measured = jerlov.petzold_scattering(station)
        angles = np.radians(measured.angles_deg)
        first, below = angles[0], measured.fraction_below_0_1_deg * measured.b
        dense = np.geomspace(first, math.pi, _DENSE)
        dense[-1] = math.pi
        vsf = np.exp(np.interp(np.log(dense), np.log(angles), np.log(measured.vsf)))
        rings = 2 * math.pi * vsf * np.sin(dense) * dense  # per unit of log angle
        steps = (rings[1:] + rings[:-1]) / 2 * np.diff(np.log(dense))
        cumulative = below + np.concatenate([[0.0], np.cumsum(steps)])
        # The report summed with coarser steps: its b is 0.2 % more than the curve holds.
        total = cumulative[-1]
        return PhaseFunction(
            station=station,
            angles_rad=angles,
            values=measured.vsf / total,
            forward_slope=2 - 2 * math.pi * float(measured.vsf[0]) * first**2 / below,
            _dense_rad=dense,
            _dense_share=cumulative / total,
        )

    @staticmethod
    def nearest(scattering_per_m: float) -> PhaseFunction:
        """The station whose b at 530 nm is nearest, by its logarithm, to ``scattering_per_m``."""
        stations = [jerlov.petzold_scattering(name) for name in jerlov.PETZOLD_STATIONS]
        like = min(stations, key=lambda one: abs(math.log(one.b / scattering_per_m)))
        return PhaseFunction.of(like.station)

    def value(self, angle_rad: ArrayLike) -> FloatArray:
        """sr^-1 at scattering angles of any shape, 0 to pi."""
        angle = np.maximum(np.asarray(angle_rad, dtype=np.float64), SMALLEST_ANGLE_RAD)
        log_value = np.interp(np.log(angle), np.log(self.angles_rad), np.log(self.values))
        beyond = np.log(np.minimum(angle / self.angles_rad[0], 1.0))
        return np.asarray(np.exp(log_value - self.forward_slope * beyond))

    def share_within(self, angle_rad: ArrayLike) -> FloatArray:
        """Share of the scattered light within an angle of its old direction, 0 to 1, any shape."""
        angle = np.asarray(angle_rad, dtype=np.float64)
        peak = np.minimum(angle / self.angles_rad[0], 1.0) ** (2 - self.forward_slope)
        return np.asarray(peak * np.interp(angle, self._dense_rad, self._dense_share))

    @property
    def backscatter_ratio(self) -> float:
        """The ratio bb / b: the share scattered by more than 90 degrees."""
        return 1.0 - float(self.share_within(math.pi / 2))
