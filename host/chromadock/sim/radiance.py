"""Daylight that the water scatters towards an eye: single scattering, in closed form.

Light that falls off with depth as exp(-kd z) and is scattered once towards the eye, from
an endless straight path along the unit vector d (world, z down), has the radiance

    L(d) = integral from 0 of c L_h g(d) exp(-kd d_z t) exp(-c t) dt = L_h g(d) c / (c + kd d_z)

where L_h is that of a level path and g says how much more light the phase function turns
towards the eye from d than it does from the horizon on average.  A path that ends after s
has the share 1 - exp(-(c + kd d_z) s) of it.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.ambient import REFRACTIVE_INDEX
from chromadock.sim.phase import PhaseFunction
from chromadock.sim.surface import reflectance_from_below

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

SUN_BLUR_RAD = 0.05
"""Waves spread the refracted sunlight by (1 - 1/n) times their slope, some tenths."""

_SUN_NODES = 2048
_SKY_D_Z: Floats = np.linspace(-1, 1, 129)
_AZIMUTHS = 72
_ZENITHS = 48


def path_radiance(level: Floats, c: Floats, kd: Floats, d_z: Floats, length_m: Floats) -> Floats:
    """Radiance of the water along directions, but for the factor g.

    Parameters
    ----------
    level : (61,) radiance L_h of an endless level path from the same place.
    c, kd : (61,) beam and diffuse attenuation, 1/m.
    d_z : (n,) how much deeper a metre of the path leads, -1..1.
    length_m : (n,) where the path ends, metres; may be infinite where ``c + kd d_z > 0``.

    Returns
    -------
    (n, 61) in the unit of ``level``.
    """
    rate = c + kd * d_z[:, None]
    length = length_m[:, None]
    # At rate 0 the integral is the length; a path upwards to the surface may have rate < 0.
    small = np.abs(rate) < 1e-9
    with np.errstate(invalid="ignore", divide="ignore"):
        integral = np.where(small, length, -np.expm1(-rate * length) / rate)
    return np.asarray(level * c * integral)


class SunAndSky:
    """The factor g: how sun and sky light up the water that is seen along a direction.

    Its mean over the horizon is 1, so that level water has on average the radiance that
    ``Ambient.veiling_radiance`` gives.

    Parameters
    ----------
    phase
        Where the water scatters to.
    sun_direction
        (3,) world unit vector along which sunlight travels in the water.
    """

    def __init__(self, phase: PhaseFunction, sun_direction: Floats) -> None:
        self._travel = sun_direction.astype(np.float32)
        half_chord = np.linspace(0, 1, _SUN_NODES)
        table = _blurred(phase, 2 * np.arcsin(half_chord))
        azimuth = _azimuths()
        level = np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros(_AZIMUTHS)])
        horizon = np.interp(np.sqrt(0.5 + 0.5 * level @ sun_direction), half_chord, table)
        self._sun = (table / horizon.mean()).astype(np.float32)
        self._sky = _sky_factor(phase)

    def sun(self, directions: Image) -> Image:
        """(3, ...) directions of sight, world, to (...) the g of sunlight."""
        # Half the chord of the angle from the sunlight's travel to the light's, which is -d:
        # even steps of it resolve the forward peak.
        cosine = np.tensordot(self._travel, directions, axes=1)
        half_chord = np.sqrt(np.maximum(0.5 + 0.5 * cosine, 0))
        index = half_chord * (_SUN_NODES - 1) + 0.5
        return np.asarray(self._sun[np.minimum(index, _SUN_NODES - 1).astype(np.intp)])

    def sky(self, d_z: Floats) -> Floats:
        """(...) downward components of directions of sight to (...) the g of skylight."""
        return np.asarray(np.interp(d_z, _SKY_D_Z, self._sky))


@cache  # it depends on nothing else, and a simulation has a source of light for each of its waters
def _sky_factor(phase: PhaseFunction) -> Floats:
    """(n,) g of an evenly bright sky, whose light fills Snell's cone, along ``_SKY_D_Z``."""
    d_z = _SKY_D_Z
    critical = math.sqrt(1 - 1 / REFRACTIVE_INDEX**2)
    cosine = critical + (1 - critical) * (np.arange(_ZENITHS) + 0.5) / _ZENITHS
    sine = np.sqrt(1 - cosine**2)[:, None] * np.cos(_azimuths())
    across = np.sqrt(1 - d_z**2)[:, None, None]
    against = -(d_z[:, None, None] * cosine[:, None] + across * sine)
    scattered = _blurred(phase, np.arccos(np.clip(against, -1, 1))).mean(axis=-1)
    radiance = scattered @ (1 - reflectance_from_below(cosine))
    return np.asarray(radiance / np.interp(0.0, d_z, radiance))


def _blurred(phase: PhaseFunction, angle_rad: Floats) -> Floats:
    """The phase function without its sharp peak."""
    return phase.value(np.minimum(np.hypot(angle_rad, SUN_BLUR_RAD), math.pi))


def _azimuths() -> Floats:
    return np.asarray(2 * np.pi * (np.arange(_AZIMUTHS) + 0.5) / _AZIMUTHS)
