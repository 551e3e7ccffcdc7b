"""Waters: absorption and scattering over wavelength, and what follows from them.

One water takes all its numbers from one table: published tables differ from each other
several times over.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import jerlov
import numpy as np
from numpy.typing import ArrayLike

from chromadock.errors import ChromadockError
from chromadock.sim.phase import PhaseFunction
from chromadock.sim.spectrum import WAVELENGTHS_NM, FloatArray

MEASURED_SOURCE = "williamson2022"
"""Williamson & Hollins (2022): the only table whose a and b were measured; types IB to 5C."""
INVERTED_SOURCE = "solonenko2015"
"""Solonenko & Mobley (2015): inverted from Kd; the clearest and the most turbid types."""

JERLOV_TYPES = jerlov.SOURCES[INVERTED_SOURCE].water_types
"""I, IA, IB, II, III (oceanic) and 1C, 3C, 5C, 7C, 9C (coastal), clearest first."""

LAKE_TYPE = "5C"
"""The most turbid water with measured coefficients lends a lake its spectral shape."""

VISIBILITY_NM = 532.0
BLACK_TARGET_CONTRAST = 4.8
"""c(532) times the horizontal visibility of a black target: Zaneveld & Pegau (2003)."""

CDOM_NM = 440.0
CDOM_SLOPE_PER_NM = 0.0155
"""Of exp(-S (l - 440)) for coloured dissolved matter: the middle of the usual 0.014..0.017."""

PETZOLD_NM = 530.0


@dataclass(frozen=True, eq=False)
class Water:
    """A homogeneous water.

    Parameters
    ----------
    name
        What messages and reports call it.
    a, b
        (61,) absorption and scattering, 1/m.
    phase
        Where scattered light goes, at all wavelengths.
    """

    name: str
    a: FloatArray
    b: FloatArray
    phase: PhaseFunction

    def __post_init__(self) -> None:
        for key in ("a", "b"):
            values = np.array(getattr(self, key), dtype=np.float64)
            values.setflags(write=False)
            object.__setattr__(self, key, values)

    @classmethod
    def jerlov_type(cls, name: str) -> Water:
        """One of Jerlov's ten types, by `JERLOV_TYPES`.

        Raises
        ------
        ChromadockError
            For any other name.
        """
        if name not in JERLOV_TYPES:
            raise ChromadockError(
                f"there is no Jerlov type {name!r}: give one of {', '.join(JERLOV_TYPES)}"
            )
        measured = name in jerlov.SOURCES[MEASURED_SOURCE].water_types
        # Any: jerlov types its classes, not these methods.
        table: Any = jerlov.water(name, source=MEASURED_SOURCE if measured else INVERTED_SOURCE)
        with warnings.catch_warnings():
            # The doubts are known and stand in the documents: 400..410 nm of the measured
            # table are its own model's, and b of I and IA was inverted from Kd.
            warnings.simplefilter("ignore", jerlov.ProvenanceWarning)
            return _water(f"Jerlov {name}", table.a(WAVELENGTHS_NM), table.b(WAVELENGTHS_NM))

    @classmethod
    def pool(cls, scattering_per_m: float = 0.2) -> Water:
        """Pure water with particles that scatter ``scattering_per_m`` at every wavelength.

        Raises
        ------
        ChromadockError
            For a scattering that is not positive and finite.
        """
        if not 0 < scattering_per_m < math.inf:
            raise ChromadockError(
                f"scattering_per_m is {scattering_per_m:g}: it must be a positive number of 1/m"
            )
        a, b = _pure_water()
        return _water("pool", a, b + scattering_per_m)

    @classmethod
    def lake(cls, visibility_m: float, cdom_per_m: float = 0.0) -> Water:
        """Type 5C, what is in it thinned or thickened until a black target vanishes as stated.

        c(532) = 4.8 / visibility (Zaneveld & Pegau 2003), with the dissolved matter in it.

        Parameters
        ----------
        visibility_m
            Horizontal visibility of a black target, m.
        cdom_per_m
            Absorption by coloured dissolved matter beyond that of type 5C, 1/m at 440 nm.

        Raises
        ------
        ChromadockError
            For a visibility beyond that of pure water with this dissolved matter.
        """
        if not 0 <= cdom_per_m < math.inf:
            raise ChromadockError(f"cdom_per_m is {cdom_per_m:g}: it must be 0 1/m or more")
        pure_a, pure_b = _pure_water()
        base_a = pure_a + cdom_per_m * np.exp(-CDOM_SLOPE_PER_NM * (WAVELENGTHS_NM - CDOM_NM))
        base_c = _at(VISIBILITY_NM, base_a + pure_b)
        clearest_m = BLACK_TARGET_CONTRAST / base_c
        if not 0 < visibility_m < clearest_m:
            raise ChromadockError(
                f"visibility_m is {visibility_m:g}: with cdom_per_m = {cdom_per_m:g} "
                f"it must lie between 0 and {clearest_m:.3g} m, which pure water has"
            )
        turbid = cls.jerlov_type(LAKE_TYPE)
        extra_a, extra_b = turbid.a - pure_a, turbid.b - pure_b
        amount = (BLACK_TARGET_CONTRAST / visibility_m - base_c) / _at(
            VISIBILITY_NM, extra_a + extra_b
        )
        name = f"lake, visibility {visibility_m:g} m"
        return _water(name, base_a + amount * extra_a, pure_b + amount * extra_b)

    @classmethod
    def mixed(cls, parts: Sequence[tuple[Water, float]]) -> Water:
        """Waters stirred together: ``(water, share)`` with shares that add up to 1.

        Raises
        ------
        ChromadockError
            For no parts, a negative share, or another sum.
        """
        shares = [share for _, share in parts]
        if min(shares, default=-1.0) < 0 or not math.isclose(sum(shares), 1, abs_tol=1e-6):
            listed = ", ".join(f"{share:g}" for share in shares) or "none"
            raise ChromadockError(
                f"the shares of the mixed waters are {listed}: "
                "each must be 0 or more and their sum 1"
            )
        name = " + ".join(f"{share:g} {water.name}" for water, share in parts)
        a = np.sum([share * water.a for water, share in parts], axis=0)
        b = np.sum([share * water.b for water, share in parts], axis=0)
        return _water(name, a, b)

    @classmethod
    def measured(cls, wavelengths: ArrayLike, a: ArrayLike, b: ArrayLike) -> Water:
        """The user's own coefficients, linear between the wavelengths.

        Parameters
        ----------
        wavelengths
            (n,) nm, ascending, 400 to 700 or more.
        a, b
            (n,) absorption and scattering, 1/m.

        Raises
        ------
        ChromadockError
            Wavelengths that do not ascend or leave a gap at an end, another number of
            coefficients, or coefficients that are not positive.
        """
        grid = np.asarray(wavelengths, dtype=np.float64)
        series = {"a": np.asarray(a, np.float64), "b": np.asarray(b, np.float64)}
        fault = _measurement_fault(grid, series)
        if fault:
            raise ChromadockError(fault)
        on_grid = {key: np.interp(WAVELENGTHS_NM, grid, series[key]) for key in series}
        return _water("measured water", on_grid["a"], on_grid["b"])

    @property
    def c(self) -> FloatArray:
        """(61,) beam attenuation a + b, 1/m."""
        return self.a + self.b

    @property
    def bb(self) -> FloatArray:
        """(61,) backscattering, 1/m."""
        return self.b * self.phase.backscatter_ratio

    def kd(self, mu0: float) -> FloatArray:
        """(61,) diffuse attenuation of downwelling irradiance, 1/m.

        Kirk, J. T. O. (1984), Limnol. Oceanogr. 29, 350-356:
        Kd = sqrt(a^2 + (0.425 mu0 - 0.19) a b) / mu0.

        Parameters
        ----------
        mu0
            Cosine of the light's zenith angle just beneath the surface, above 0.66.
        """
        return np.asarray(np.sqrt(self.a**2 + (0.425 * mu0 - 0.19) * self.a * self.b) / mu0)

    @cached_property
    def as_jerlov(self) -> jerlov.Water:
        """The same coefficients for the functions of `jerlov`."""
        return jerlov.Water.from_measurements(WAVELENGTHS_NM, a=self.a, b=self.b, name=self.name)


def _water(name: str, a: FloatArray, b: FloatArray) -> Water:
    """A water with the phase function of the measured one that scatters most like it."""
    return Water(name, a, b, PhaseFunction.nearest(_at(PETZOLD_NM, b)))


def _pure_water() -> tuple[FloatArray, FloatArray]:
    """(61,) a and b of pure fresh water, 1/m."""
    a = jerlov.pure_water_absorption(WAVELENGTHS_NM)
    b = jerlov.pure_water_scattering(WAVELENGTHS_NM, salinity_psu=0.0)
    return np.asarray(a), np.asarray(b)


def _at(wavelength_nm: float, values: FloatArray) -> float:
    return float(np.interp(wavelength_nm, WAVELENGTHS_NM, values))


def _measurement_fault(grid: FloatArray, series: dict[str, FloatArray]) -> str | None:
    """What makes these measurements impossible as a water, or None."""
    first, last = WAVELENGTHS_NM[0], WAVELENGTHS_NM[-1]
    if grid.ndim != 1 or grid.size < 2 or not (np.diff(grid) > 0).all():
        return "wavelengths_nm must be two or more ascending numbers of nm"
    if not (grid[0] <= first and last <= grid[-1]):
        return (
            f"wavelengths_nm is {grid[0]:g} to {grid[-1]:g}: "
            f"it must reach from {first:g} or less to {last:g} nm or more"
        )
    for key, values in series.items():
        if values.shape != grid.shape:
            return f"{key} has {values.size} numbers for {grid.size} wavelengths: give one for each"
        wrong = ~((values > 0) & (values < math.inf))
        if wrong.any():
            value, place = values[wrong][0], grid[wrong][0]
            return f"{key} at {place:g} nm is {value:g}: it must be a positive number of 1/m"
    return None
