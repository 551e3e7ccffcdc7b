"""The water behind everything: its veil, the surface above, a floor and a wall."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.sim.ambient import Ambient
from chromadock.sim.basin import Basin, Ends
from chromadock.sim.elevation import ElevationTable
from chromadock.sim.focusing import Focusing
from chromadock.sim.rays import RayGrid
from chromadock.sim.response import Response
from chromadock.sim.surface_view import SurfaceView
from chromadock.sim.veil import Moment, Veil
from chromadock.sim.waves import GaussianField

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

OPEN_WATER = Basin()

STEP_PX = (4, 2)
"""Between the rays that are worked out, across and down: waves are seen flat, so wide."""
CAUSTIC_STEP_PX = (8, 4)
SHAFT_STEP_PX = (4, 8)

FAINT = 0.004
"""What less than this share of gets through the water is not worked out."""

_ELEVATIONS = 257
_TINY = np.float32(1e-9)


class Background:
    """Renders the water as one camera sees it, without the dock.

    Waves, shafts and the net of light on the floor are those about the world's origin, above
    and below which the camera stays.

    Parameters
    ----------
    camera
        Whose rays; its lens distortion is kept.
    response
        What its channels see.
    ambient
        Daylight and water.
    waves
        Of the surface.
    basin
        Floor and wall; by default open water.
    """

    def __init__(
        self,
        camera: CameraModel,
        response: Response,
        ambient: Ambient,
        waves: GaussianField,
        basin: Basin = OPEN_WATER,
    ) -> None:
        self._size = (camera.height, camera.width, 3)
        self._response = response
        self._ambient = ambient
        self._basin = basin
        self._grid = RayGrid(camera, STEP_PX)
        self._caustic_grid = RayGrid(camera, CAUSTIC_STEP_PX)
        self._shaft_grid = RayGrid(camera, SHAFT_STEP_PX)
        self._veil = Veil(response, ambient)
        self._surface = SurfaceView(response, ambient, self._veil, waves, basin)
        self._focusing = Focusing(ambient, response)
        self._pixel_rad = 1 / math.sqrt(camera.matrix[0, 0] * camera.matrix[1, 1])
        self._reach_m = -math.log(FAINT) / float(ambient.water.c.min())

    def light(self, time_s: float, R_world_camera: Floats, depth_m: float) -> Image:
        """The water's light at a moment.

        Parameters
        ----------
        time_s : seconds.
        R_world_camera : (3, 3) rotation from the camera's to the world frame.
        depth_m : of the camera below the mean surface, above 0.

        Returns
        -------
        (H, W, 3) float32 signal R, G, B.
        """
        now = self._veil.moment(time_s)
        if not now.level.any():
            return np.zeros(self._size, np.float32)
        rays = self._grid.turned(R_world_camera)
        d_z = np.linspace(float(rays[2].min()), float(rays[2].max()), _ELEVATIONS)
        ends = self._basin.ends(d_z, depth_m)
        image = self._veil.light(now, depth_m, d_z, ends.length_m, rays)
        image *= self._shafts(now, depth_m, R_world_camera)
        if (ends.floor | ends.wall).any():
            solids = self._solids(now, depth_m, d_z, ends, rays)
            image += solids * self._caustics(now, depth_m, R_world_camera)
        self._add_surface(image, now, depth_m, rays)
        # Between roots, or the edges of a sky that is far brighter than white come out in steps.
        root = self._grid.enlarge(np.sqrt(image, out=image))
        return np.square(root, out=root)

    def _shafts(self, now: Moment, depth_m: float, R_world_camera: Floats) -> Image | float:
        """(h, w, 3) factor by which waves brighten or darken the water along rays."""
        level = self._veil.level(now, depth_m)
        sigma = self._focusing.sigma(depth_m, now.time_s, level)
        if not sigma.any():
            return 1.0
        rays = self._shaft_grid.turned(R_world_camera)
        d_z = np.linspace(-1, 1, _ELEVATIONS)
        length = self._basin.ends(d_z, depth_m).length_m
        c = float(np.average(self._ambient.water.c, weights=level))
        kd = float(np.average(self._ambient.kd, weights=level))
        # Upwards the light grows nearly as fast as the water takes it: the surface ends that.
        rate = np.maximum(c + kd * d_z, c / 2)
        mean = 1 / rate
        cut = np.isfinite(length)
        # x / (exp(x) - 1) from its mirror image, which overflows for no length.
        fade = np.exp(-rate[cut] * length[cut])
        mean[cut] -= length[cut] * fade / np.maximum(1 - fade, _TINY)
        distance = ElevationTable(d_z, mean[:, None]).at(rays[2])
        factor = self._focusing.along(rays, distance, now.time_s, sigma)
        return self._shaft_grid.enlarge(factor, self._grid)

    def _solids(self, now: Moment, depth_m: float, d_z: Floats, ends: Ends, rays: Image) -> Image:
        """(h, w, 3) light of floor and wall, evenly lit."""
        arriving = self._basin.radiance(ends, d_z, depth_m, self._ambient, now.time_s)
        columns = np.column_stack([self._response.signal(arriving), ends.wall])
        seen = ElevationTable(d_z, columns).at(rays[2])
        # What falls on an upright face, of what falls on a level one: half the sky's, and
        # the sun's by its angle.
        sun = self._ambient.sun_direction.astype(np.float32)
        facing = (sun[0] * rays[0] + sun[1] * rays[1]) / np.sqrt(1 - rays[2] ** 2 + _TINY)
        sky = now.sky_share
        upright = sky / 2 + (1 - sky) * np.maximum(facing, 0) / sun[2]
        return np.asarray(seen[..., :3] * (1 + seen[..., 3] * (upright - 1))[..., None])

    def _caustics(self, now: Moment, depth_m: float, R_world_camera: Floats) -> Image | float:
        """(h, w, 3) factor by which waves brighten or darken floor and wall."""
        deep = self._basin.floor.depth_m if self._basin.floor else depth_m
        spectrum = self._ambient.downwelling(deep, now.time_s)
        sigma = self._focusing.sigma(deep, now.time_s, spectrum)
        if not sigma.any():
            return 1.0
        rays = self._caustic_grid.turned(R_world_camera)
        d_z = np.linspace(-1, 1, _ELEVATIONS)
        reach = np.minimum(self._basin.ends(d_z, depth_m).length_m, self._reach_m)
        length = ElevationTable(d_z, reach[:, None]).at(rays[2])
        ray_rad = np.float32(CAUSTIC_STEP_PX[1] * self._pixel_rad)
        covered = length * ray_rad / np.maximum(np.abs(rays[2]), np.float32(0.1))
        factor = self._focusing.at(rays * length, covered, now.time_s, sigma)
        return self._caustic_grid.enlarge(factor, self._grid)

    def _add_surface(self, image: Image, now: Moment, depth_m: float, rays: Image) -> None:
        """Add the surface's light, in place, to (h, w, 3) where rays (3, h, w) end there."""
        lowest = np.float32(depth_m / self._reach_m)
        reached = rays[2] < -lowest
        if self._basin.wall:
            across = np.sqrt(1 - rays[2] ** 2)
            reached &= depth_m * across < -rays[2] * np.float32(self._basin.wall.distance_m)
        rows = np.flatnonzero(reached.any(axis=1))
        if not len(rows):
            return
        band = slice(rows[0], rows[-1] + 1)
        upwards = rays[:, band].copy()
        np.minimum(upwards[2], -lowest, out=upwards[2])
        light = self._surface.light(now, depth_m, upwards, STEP_PX[1] * self._pixel_rad)
        image[band] += light * reached[band][..., None]
