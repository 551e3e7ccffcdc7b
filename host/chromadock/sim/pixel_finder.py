"""Which pixels may show a shape: looked for in blocks, so that most pixels need not be asked."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.sim.rays import RayGrid, unit_rays
from chromadock.sim.shapes import Shape

Singles = NDArray[np.float32]

BLOCK_PX = 8


class PixelFinder:
    """The pixels of one camera's images and their rays."""

    def __init__(self, camera: CameraModel) -> None:
        self.pixel_rad = 1 / math.sqrt(camera.matrix[0, 0] * camera.matrix[1, 1])
        """The angle that a pixel in the middle spans."""
        self._width, self._height = camera.width, camera.height
        self._rays = RayGrid(camera, (1, 1)).rays.reshape(3, -1)
        columns, rows = (
            np.arange(math.ceil(side / BLOCK_PX)) * BLOCK_PX + (BLOCK_PX - 1) / 2
            for side in (camera.width, camera.height)
        )
        middles = np.stack(np.meshgrid(columns, rows), axis=-1)
        rays = unit_rays(camera, middles.reshape(-1, 2)).astype(np.float32)
        self._blocks = np.ascontiguousarray(rays.T)
        self._blocks_across = len(columns)

    def shows(self, shape: Shape, margin_rad: float) -> bool:
        """Whether the shape is in the image, or outside it by less than about a margin."""
        return len(self._near(shape, self._blocks, margin_rad)) > 0

    def find(self, shape: Shape, rows: range, soft_rad: float) -> tuple[NDArray[np.intp], Singles]:
        """(N,) places in the flattened image and (3, N) unit rays of these pixels.

        All that the shape fills, with its edge ``soft_rad`` wide, and some more.

        Parameters
        ----------
        rows : the image's rows to look at; they begin with a multiple of ``BLOCK_PX``.
        """
        first = rows.start // BLOCK_PX * self._blocks_across
        last = math.ceil(rows.stop / BLOCK_PX) * self._blocks_across
        near = self._near(shape, self._blocks[:, first:last], soft_rad) + first
        step = np.arange(BLOCK_PX)
        y = (near // self._blocks_across * BLOCK_PX)[:, None, None] + step[:, None]
        x = (near % self._blocks_across * BLOCK_PX)[:, None, None] + step
        places = y * self._width + x
        inside = (y < rows.stop) & (x < self._width)
        pixels = places.reshape(-1) if inside.all() else places[inside]
        return pixels, np.take(self._rays, pixels, axis=1)

    def _near(self, shape: Shape, blocks: Singles, soft_rad: float) -> NDArray[np.intp]:
        """Which blocks (3, N) have pixels that the shape may fill."""
        wide_rad = soft_rad + (math.sqrt(2) * BLOCK_PX + 1) * self.pixel_rad
        near = np.flatnonzero(_within_bound(shape, blocks, wide_rad))
        return np.asarray(near[shape.coverage(blocks[:, near], wide_rad) > 0])


def _within_bound(shape: Shape, rays: Singles, margin_rad: float) -> NDArray[np.bool_]:
    """(N,) which rays come near the sphere around a shape."""
    centre, radius = shape.bound
    distance = math.sqrt(centre @ centre)
    if distance <= radius:
        return np.ones(rays.shape[1], np.bool_)
    angle = math.asin(radius / distance) + margin_rad
    cosine = (centre / distance).astype(np.float32) @ rays
    return np.asarray(cosine > math.cos(min(angle, math.pi)))
