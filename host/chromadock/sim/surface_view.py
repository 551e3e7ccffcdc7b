"""The surface as it is seen from below: what it mirrors, and the sky through it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.ambient import REFRACTIVE_INDEX, Ambient
from chromadock.sim.basin import Basin
from chromadock.sim.elevation import ElevationTable
from chromadock.sim.response import Response
from chromadock.sim.spectrum import daylight
from chromadock.sim.surface import (
    reflectance_from_below,
    sky_transmittance,
    split,
    upward_normals,
)
from chromadock.sim.veil import Moment, Veil
from chromadock.sim.waves import GaussianField

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

SUN_LOBE_RAD = 0.05
"""Width of the sun in a facet: ripples too small to be drawn spread it."""

RIPPLE_M = 0.15
"""Where a ray covers this much of the surface, waves of a decimetre and more begin to blur."""

_ELEVATIONS = 129
_LOWEST_SUN = 0.05


class SurfaceView:
    """Renders the surface.

    Parameters
    ----------
    response
        What the camera's channels see.
    ambient
        Daylight and water.
    veil
        The water's own light, which the surface mirrors.
    waves
        Of the surface; world metres, with the camera at x = y = 0.
    basin
        Floor and wall, which the surface mirrors too.
    """

    def __init__(
        self, response: Response, ambient: Ambient, veil: Veil, waves: GaussianField, basin: Basin
    ) -> None:
        self._response = response
        self._ambient = ambient
        self._veil = veil
        self._waves = waves
        self._basin = basin

    def light(self, now: Moment, depth_m: float, rays: Image, ray_rad: float) -> Image:
        """Light of the surface at the eye.

        Parameters
        ----------
        now : the moment.
        depth_m : of the eye below the mean surface, above 0.
        rays : (3, h, w) unit vectors, world, upwards.
        ray_rad : what a ray covers, rad: finer waves blur.

        Returns
        -------
        (h, w, 3) signal.
        """
        up = -rays[2]
        length = depth_m / up
        slope = self._waves.slope(now.time_s, rays[0] * length, rays[1] * length)
        covered = length * np.float32(ray_rad / RIPPLE_M) / up
        slope = slope.astype(np.float32) / np.sqrt(1 + covered**2)[..., None]
        facet = split(rays, upward_normals(slope))
        mirrored = self._from_below(now, facet.reflected)
        sky = self._from_above(now, facet.refracted)
        light = sky + facet.reflectance[..., None] * (mirrored - sky)
        return np.asarray(light * self._transmittance(depth_m, rays[2]))

    def _from_below(self, now: Moment, directions: Image) -> Image:
        """(3, h, w) directions to (h, w, 3): the water, floor and wall seen from the surface."""
        d_z = np.linspace(0, 1, _ELEVATIONS)
        ends = self._basin.ends(d_z, 0.0)
        image = self._veil.light(now, 0.0, d_z, ends.length_m, directions)
        if (ends.floor | ends.wall).any():
            solid = self._basin.radiance(ends, d_z, 0.0, self._ambient, now.time_s)
            image += ElevationTable(d_z, self._response.signal(solid)).at(directions[2])
        return image

    def _from_above(self, now: Moment, directions: Image) -> Image:
        """(3, h, w) directions in the air to (h, w, 3): daylight as if facets let all of it in.

        An evenly bright sky, and the sun as a lobe, as bright as makes what gets in through
        flat water the irradiance beneath it.  Radiance grows by n^2 on its way in.
        """
        n = REFRACTIVE_INDEX
        signal = n**2 * self._response.signal(self._ambient.downwelling(0.0, now.time_s))
        travel = self._ambient.sun_direction * (n, n, 1)
        enters = 1 - float(reflectance_from_below(travel[2]))
        travel[2] = math.sqrt(max(1 - float(travel[:2] @ travel[:2]), 0))
        normal = max(enters * travel[2], _LOWEST_SUN**2)
        beam = (1 - now.sky_share) / normal / (2 * math.pi * SUN_LOBE_RAD**2)
        sky = now.sky_share / math.pi / sky_transmittance()
        # 1 - cos is half the square of the angle from the sun.  Directions that total reflection
        # makes meaningless are no unit vectors, and would count as beyond the sun's middle.
        off = np.maximum(1 + np.tensordot(travel.astype(np.float32), directions, axes=1), 0)
        brightness = sky + beam * np.exp(-off / SUN_LOBE_RAD**2)
        return np.asarray(brightness[..., None] * signal.astype(np.float32))

    def _transmittance(self, depth_m: float, d_z: Image) -> Image:
        """(h, w, 3) share of daylight at the surface that comes through the water from there."""
        steps = np.linspace(float(d_z.min()), float(d_z.max()), _ELEVATIONS)
        spectrum = daylight(1.0)
        left = spectrum * np.exp(self._ambient.water.c * (depth_m / steps)[:, None])
        share = self._response.signal(left) / self._response.signal(spectrum)
        return ElevationTable(steps, share).at(d_z)
