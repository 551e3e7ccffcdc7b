"""Sunlight that waves focus: shafts in the water, and the net of light on a floor."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.sim.ambient import Ambient
from chromadock.sim.response import Response

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

BLUR_M = 0.3
"""Where a pixel covers this much, its waves are no longer told apart; they are 0.1 to 6 m long."""

_AZIMUTHS = 160
_RADII_M = np.geomspace(0.02, 30, 64)
_MEANS_M = np.geomspace(0.03, 12, 24)
_TINY = np.float32(1e-9)


class Focusing:
    """How much the irradiance differs from its mean, from place to place.

    At every place the factor is ``Ambient``'s exp(sigma g - sigma^2 / 2), with g that of the
    sunray through the camera's depth on which the place lies: so shafts slant as the sun's
    rays do.  Metres are counted from the camera, which stays at the field's origin.

    Parameters
    ----------
    ambient
        Light, its flicker and the sun's direction.
    response
        What a camera's channels see.
    """

    def __init__(self, ambient: Ambient, response: Response) -> None:
        self._ambient = ambient
        self._response = response
        travel = ambient.sun_direction
        self._drift = (travel[:2] / travel[2]).astype(np.float32)
        # Shares of the light that comes from the rings about the radii, if its mean radius is m.
        rings = np.exp(-_RADII_M[:, None] / _MEANS_M) * _RADII_M[:, None]
        self._shares = (rings / rings.sum(axis=0)).astype(np.float32)

    def sigma(self, depth_m: float, time_s: float, spectrum: Floats) -> Image:
        """(3,) sigma for light of a (61,) spectrum at a depth, per channel."""
        signal = self._response.signal(spectrum)
        weighted = self._response.signal(spectrum * self._ambient.flicker_sigma(depth_m, time_s))
        none = np.zeros_like(signal)
        return np.divide(weighted, signal, out=none, where=signal > 0).astype(np.float32)

    def at(self, places: Image, covered_m: Image, time_s: float, sigma: Image) -> Image:
        """Factors of the light that falls on a pixel's places.

        Parameters
        ----------
        places : (3, ...) metres from the camera, world.
        covered_m : (...) what a pixel covers there, metres.
        time_s : seconds.
        sigma : (3,) of the channels.

        Returns
        -------
        (..., 3), 1 on average.
        """
        x, y = places[:2] - self._drift[:, None, None] * places[2]
        g = self._ambient.fluctuation(time_s, x, y).astype(np.float32)
        seen = sigma / np.sqrt(1 + (covered_m / np.float32(BLUR_M)) ** 2)[..., None]
        return np.asarray(np.exp(seen * (g[..., None] - seen / 2)))

    def along(self, rays: Image, mean_m: Image, time_s: float, sigma: Image) -> Image:
        """Factors of the light that whole paths scatter towards the camera.

        What arrives from the distance t falls off as exp(-t / mean).  Seen along the sunrays,
        a path runs straight from the camera, so that its mean depends on two numbers only,
        azimuth and mean radius, for which it is tabulated.

        Parameters
        ----------
        rays : (3, h, w) unit vectors, world.
        mean_m : (h, w) mean distance that the light comes from.
        time_s, sigma : as above.

        Returns
        -------
        (h, w, 3), 1 on average.
        """
        x, y = rays[:2] - self._drift[:, None, None] * rays[2]
        middle = math.atan2(float(y.mean()), float(x.mean()))
        turned = (np.arctan2(y, x) - np.float32(middle - math.pi)) % (2 * math.pi) - math.pi
        span = float(np.abs(turned).max()) + 1e-3
        azimuth = middle + np.linspace(-span, span, _AZIMUTHS)
        places = (np.outer(f(azimuth), _RADII_M) for f in (np.cos, np.sin))
        g = self._ambient.fluctuation(time_s, *places).astype(np.float32)
        table = np.stack([np.exp(s * (g - s / 2)) @ self._shares for s in sigma], axis=-1)
        radius = np.log(mean_m * np.sqrt(x**2 + y**2) / np.float32(_MEANS_M[0]) + _TINY)
        column = radius * ((len(_MEANS_M) - 1) / math.log(_MEANS_M[-1] / _MEANS_M[0]))
        column = np.clip(column, 0, len(_MEANS_M) - 1).astype(np.float32)
        row = ((turned + span) * ((_AZIMUTHS - 1) / (2 * span))).astype(np.float32)
        return np.asarray(cv2.remap(table, column, row, cv2.INTER_LINEAR))
