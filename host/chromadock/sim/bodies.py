"""Solid things in the water: the dock's frame, buoys, printed parts, whatever a scene has."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.sim.ambient import Ambient
from chromadock.sim.body import Body
from chromadock.sim.daylit import Daylit, Seen
from chromadock.sim.lamp_core import LENS_SIGMA_PX
from chromadock.sim.pixel_finder import BLOCK_PX, PixelFinder
from chromadock.sim.response import Response
from chromadock.sim.shapes import NEAR_M, Hits, Shape
from chromadock.sim.shutter import Shutter
from chromadock.sim.transform import Transform

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

_SWAY_RAD = 0.05
"""No body moves farther while a rolling shutter reads a frame."""
_FIELDS = (40, 30)
"""Across and down: some degrees wide, as far as most scattered light strays."""


class View(Protocol):
    """Where a camera and the dock are."""

    def T_world_camera(self, time_s: float) -> Transform:
        """The camera in the world."""

    def T_world_dock(self, time_s: float) -> Transform:
        """The dock in the world."""


class Bodies:
    """Draws bodies into one camera's images, and tells what they hide.

    What the water takes of a body's light it replaces by light from around: a contrast C
    is left with C exp(-c r) (Duntley, S. Q. 1963, "Light in the sea", J. Opt. Soc. Am. 53,
    214-233), before rendered and photographed water alike.

    Parameters
    ----------
    bodies
        All of them.
    camera, response, shutter
        Whose images.
    ambient
        Daylight and water.
    view
        Where everything is.
    """

    def __init__(
        self,
        bodies: Sequence[Body],
        camera: CameraModel,
        response: Response,
        shutter: Shutter,
        ambient: Ambient,
        view: View,
    ) -> None:
        self._bodies = tuple(bodies)
        self._ambient = ambient
        self._shutter = shutter
        self._view = view
        self._daylit = Daylit(ambient, response)
        self._placed: tuple[float, list[tuple[Body, Shape]]] | None = None
        self._finder = PixelFinder(camera)
        # An even ramp with the variance of the lens's Gaussian blur.
        self._soft_rad = math.sqrt(12) * LENS_SIGMA_PX * self._finder.pixel_rad

    def draw(self, light: Singles, time_s: float) -> None:
        """Draw all into a (H, W, 3) float32 signal image, in place; farthest first."""
        bands = self._shutter.bands(BLOCK_PX)
        near = self._bodies
        if len(bands) > 1:  # what is out of view is looked for once, not in every band
            shapes = self._in_camera(time_s)
            near = tuple(body for body, shape in shapes if self._finder.shows(shape, _SWAY_RAD))
        if not near:
            return
        flat = light.reshape(-1, 3)
        around = _around(light).reshape(-1, 3)
        for rows in bands:
            middle = (rows.start + rows.stop - 1) / 2
            moment = self._shutter.row_time(time_s, middle)
            self._draw_rows(near, flat, around, rows, moment)

    def visible(self, points_camera: Floats, diameter_m: float, time_s: float) -> Floats:
        """(N,) share of discs at (N, 3) metres, camera frame, that no body hides, 0..1."""
        left = np.ones(len(points_camera))
        ranges = np.linalg.norm(points_camera, axis=1)
        rays = points_camera / ranges[:, None]
        penumbra_rad = diameter_m / float(ranges.min())
        for _, shape in self._in_camera(time_s):
            centre, radius = shape.bound
            along = rays @ centre
            if (centre @ centre - along**2 < (radius + diameter_m) ** 2).any():
                hits = shape.hits(rays.T.astype(np.float32), penumbra_rad)
                before = hits.range_m < ranges[hits.index] - diameter_m / 2
                left[hits.index] *= 1 - np.where(before, hits.coverage, 0)
        return left

    def _in_camera(self, time_s: float) -> list[tuple[Body, Shape]]:
        """The bodies with their shapes in the camera's frame."""
        # Asked for twice a frame: by what is hidden and by what is drawn.
        if self._placed is None or self._placed[0] != time_s:
            T_camera_world = self._view.T_world_camera(time_s).inverse()
            frames = {"world": T_camera_world}
            frames["dock"] = T_camera_world @ self._view.T_world_dock(time_s)
            shapes = [
                (body, body.shape.moved(frames[body.fixed_to]))
                for body in self._bodies
                if body.there(time_s)
            ]
            self._placed = (time_s, shapes)
        return self._placed[1]

    def _draw_rows(
        self, bodies: Sequence[Body], light: Singles, around: Singles, rows: range, time_s: float
    ) -> None:
        """Draw what (H * W, 3) pixels of some rows show at a moment."""
        T_world_camera = self._view.T_world_camera(time_s)
        found = []
        for body, shape in self._in_camera(time_s):
            if body not in bodies:
                continue
            pixels, rays = self._finder.find(shape, rows, self._soft_rad)
            hits = shape.hits(rays, self._soft_rad)
            if len(hits.index):
                found.append(_Found(body, shape, pixels[hits.index], hits))
        if not found:
            return
        found.sort(key=lambda one: -one.range_m)
        seen = self._daylit.seen(
            np.stack([one.body.reflectance for one in found]),
            np.array([max(T_world_camera.points(one.shape.bound[0])[2], 0) for one in found]),
            np.array([one.range_m for one in found]),
            time_s,
            T_world_camera.R.T,
        )
        spots = T_world_camera.points(np.concatenate([one.shape.spots for one in found]))
        waves = self._ambient.fluctuation(time_s, spots[:, 0], spots[:, 1])
        for one, surface in zip(found, seen, strict=True):
            count = len(one.shape.spots)
            _paint(light, around, one, surface, waves[:count])
            waves = waves[count:]


@dataclass(frozen=True, eq=False)
class _Found:
    """A body before the camera, with the pixels that it meets."""

    body: Body
    shape: Shape
    pixels: NDArray[np.intp]
    hits: Hits

    @property
    def range_m(self) -> float:
        """Of the body's middle."""
        centre, _ = self.shape.bound
        return max(math.sqrt(centre @ centre), NEAR_M)


def _paint(light: Singles, around: Singles, found: _Found, seen: Seen, waves: Floats) -> None:
    """Blend a body over (H * W, 3) pixels, with the light ``around`` in front of it."""
    pixels, hits = found.pixels, found.hits
    image = seen.faces(hits.normal, hits.range_m)
    flicker = seen.flicker(waves)
    if hits.along is not None:
        spots = np.linspace(0, 1, len(waves))
        flicker = np.stack([np.interp(hits.along, spots, one) for one in flicker])
    image *= flicker.astype(np.float32)
    image += seen.share_before(hits.range_m) * around[pixels].T
    behind = light[pixels].T
    image -= behind
    image *= hits.coverage
    image += behind
    light[pixels] = image.T


def _around(light: Singles) -> Singles:
    """(H, W, 3) the mean light of each pixel's wider neighbourhood."""
    height, width = light.shape[:2]
    fields = cv2.resize(light, _FIELDS, interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.resize(fields, (width, height), interpolation=cv2.INTER_LINEAR))
