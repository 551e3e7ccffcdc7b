"""The water's own light as a camera's channels see it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.ambient import Ambient
from chromadock.sim.elevation import ElevationTable
from chromadock.sim.radiance import SunAndSky, path_radiance
from chromadock.sim.response import Response

Floats = NDArray[np.float64]
Image = NDArray[np.float32]


class Moment(NamedTuple):
    """Daylight at a time.

    Attributes
    ----------
    time_s
        Seconds.
    level
        (61,) veiling radiance of level water just beneath the surface.
    sky_share
        Share of the illuminance that comes from no single direction, 0..1.
    """

    time_s: float
    level: Floats
    sky_share: float


class Veil:
    """Renders water that is lit by sun and sky.

    Parameters
    ----------
    response
        What the camera's channels see.
    ambient
        Daylight and water.
    """

    def __init__(self, response: Response, ambient: Ambient) -> None:
        self._response = response
        self._ambient = ambient
        self._source = SunAndSky(ambient.water.phase, ambient.sun_direction)

    def moment(self, time_s: float) -> Moment:
        """The daylight at a time, seconds."""
        return Moment(
            time_s,
            self._ambient.veiling_radiance(0.0, time_s),
            self._ambient.diffuse_share_at(time_s),
        )

    def level(self, now: Moment, depth_m: float) -> Floats:
        """(61,) radiance of level water at a depth, metres."""
        return np.asarray(now.level * np.exp(-self._ambient.kd * depth_m))

    def light(
        self, now: Moment, depth_m: float, d_z: Floats, length_m: Floats, rays: Image
    ) -> Image:
        """Light that the water scatters into rays.

        Parameters
        ----------
        now : the moment.
        depth_m : from where the rays are followed.
        d_z : (n,) evenly spaced downward components that span those of the rays.
        length_m : (n,) where rays end that have them, metres.
        rays : (3, h, w) unit vectors, world.

        Returns
        -------
        (h, w, 3) signal.
        """
        water, kd = self._ambient.water, self._ambient.kd
        path = path_radiance(self.level(now, depth_m), water.c, kd, d_z, length_m)
        columns = np.column_stack([self._response.signal(path), self._source.sky(d_z)])
        seen = ElevationTable(d_z, columns).at(rays[2])
        factor = now.sky_share * seen[..., 3] + (1 - now.sky_share) * self._source.sun(rays)
        return np.asarray(seen[..., :3] * factor[..., None])
