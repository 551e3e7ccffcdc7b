"""Spectra on one wavelength grid: daylight, LEDs, paint, and how bright the eye sees them.

Irradiance W m^-2 nm^-1, radiance W m^-2 sr^-1 nm^-1, radiant intensity W sr^-1 nm^-1.
"""

from __future__ import annotations

import math
from functools import lru_cache

import jerlov
import numpy as np
from jerlov.colour import XYZ_TO_LINEAR_SRGB
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]

STEP_NM = 5.0
WAVELENGTHS_NM: FloatArray = np.arange(400.0, 701.0, STEP_NM)
"""(61,) nm: what every table of `jerlov` spans, and all but 0.1 % of what the eye sees."""
WAVELENGTHS_NM.setflags(write=False)

LUMENS_PER_WATT = 683.0
"""Luminous efficacy at 555 nm, by the SI's definition of the candela."""

_BAND_EDGES_NM = (490.0, 585.0)
"""Where the sRGB primaries' shares of D65 meet: blue below, green between, red above."""
_BAND_SOFTNESS_NM = 8.0
"""Pigments change over some tens of nanometres; a step would be no paint's."""


def daylight(illuminance_lux: float) -> FloatArray:
    """(61,) irradiance with the shape of CIE illuminant D65.

    Parameters
    ----------
    illuminance_lux
        Of the surface it falls on, lux, 0 or more.
    """
    shape = np.interp(WAVELENGTHS_NM, *jerlov.d65())
    return np.asarray(shape * (illuminance_lux / luminance(shape)))


def gaussian(peak_nm: float, fwhm_nm: float) -> FloatArray:
    """(61,) bell curve with peak value 1 and full width ``fwhm_nm`` at half its height."""
    return np.asarray(np.exp2(-(((WAVELENGTHS_NM - peak_nm) / (fwhm_nm / 2)) ** 2)))


def led_intensity(peak_nm: float, fwhm_nm: float, intensity_cd: float) -> FloatArray:
    """(61,) radiant intensity of an LED of ``intensity_cd`` candela along its axis."""
    shape = gaussian(peak_nm, fwhm_nm)
    return shape * (intensity_cd / luminance(shape))


def luminance(spectrum: ArrayLike) -> float:
    """Luminance of a (61,) radiance in cd/m^2; of irradiance lux, of radiant intensity cd.

    683 lm/W times the integral with the CIE 1931 observer's y-bar, which is the CIE 1924
    V(lambda).
    """
    return float(LUMENS_PER_WATT * STEP_NM * (np.asarray(spectrum) @ _observer()[:, 1]))


def reflectance(rgb: ArrayLike) -> FloatArray:
    """(61,) smooth reflectance, 0 to 1, that looks roughly like ``rgb`` in daylight.

    Three bands that add up to 1 at every wavelength, so that grey is flat, with the heights
    that give the colour under D65. A colour that no such paint has (a pure primary) comes
    out as the nearest that one has.

    Parameters
    ----------
    rgb
        (3,) linear sRGB, 0 to 1.
    """
    heights = np.linalg.solve(_band_colours(), np.asarray(rgb, dtype=np.float64))
    return np.asarray(np.clip(heights, 0, 1) @ _bands())


@lru_cache(maxsize=1)
def _observer() -> FloatArray:
    """(61, 3) x-bar, y-bar, z-bar of the CIE 1931 observer."""
    wavelengths, functions = jerlov.cie_1931_cmf()
    columns = [np.interp(WAVELENGTHS_NM, wavelengths, column) for column in functions.T]
    return np.stack(columns, axis=1)


@lru_cache(maxsize=1)
def _bands() -> FloatArray:
    """(3, 61) of red, green and blue paint; the sum is 1."""
    low, high = (
        1 / (1 + np.exp(-(WAVELENGTHS_NM - edge) / _BAND_SOFTNESS_NM)) for edge in _BAND_EDGES_NM
    )
    return np.stack([high, low - high, 1 - low])


@lru_cache(maxsize=1)
def _band_colours() -> FloatArray:
    """(3, 3): column k is the linear sRGB of band k in daylight that makes white (1, 1, 1)."""
    light = daylight(LUMENS_PER_WATT / math.pi)
    xyz = (_bands() * light) @ _observer()
    return np.asarray(XYZ_TO_LINEAR_SRGB @ (xyz / xyz[:, 1].sum()).T)
