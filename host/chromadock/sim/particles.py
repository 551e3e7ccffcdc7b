"""Suspended matter near the lens: drifting specks, sharp at the focus and discs before it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.sim.ambient import Ambient
from chromadock.sim.daylit import Daylit
from chromadock.sim.lamp_core import LENS_SIGMA_PX
from chromadock.sim.response import Response
from chromadock.sim.spectrum import WAVELENGTHS_NM
from chromadock.sim.transform import Transform

Floats = NDArray[np.float64]

REACH_M = 1.0
"""Farther specks are smaller than a pixel and are the water's scattering already."""
NEAREST_M = 0.06
"""A housing's port keeps them off the lens."""
APERTURE_M = 0.001
"""Of a small camera's lens."""
FOCUS_M = 1.0
REFLECTANCE = 0.5
SPREAD = 0.5
"""Standard deviation of the logarithm of the diameter."""
_SLICES = 8


@dataclass(frozen=True)
class Suspension:
    """Marine snow, or what a pool's bathers and filters leave.

    Parameters
    ----------
    seed
        Another seed, other specks.
    concentration_per_m3
        Specks in a cubic metre, large enough to be seen singly.
    diameter_m
        The median; log-normal.
    drift_m_s
        (3,) their velocity, world.
    """

    seed: int
    concentration_per_m3: float
    diameter_m: float
    drift_m_s: tuple[float, float, float]


class Particles:
    """Draws a suspension into one camera's images.

    The specks fill space periodically, in cubes around the camera twice ``REACH_M`` wide, so
    that it can travel however far.
    """

    def __init__(
        self, suspension: Suspension, camera: CameraModel, response: Response, ambient: Ambient
    ) -> None:
        rng = np.random.default_rng(suspension.seed)
        self._camera = camera
        self._drift = np.array(suspension.drift_m_s)
        self._side = 2 * REACH_M
        count = rng.poisson(suspension.concentration_per_m3 * self._side**3)
        self._starts = rng.uniform(0, self._side, (count, 3))
        self._radius = suspension.diameter_m / 2 * np.exp(rng.normal(0, SPREAD, count))
        self._daylit = Daylit(ambient, response)
        self._focal_px = math.sqrt(camera.matrix[0, 0] * camera.matrix[1, 1])
        right, bottom = camera.width - 0.5, camera.height - 0.5
        corners = [(-0.5, -0.5), (right, -0.5), (-0.5, bottom), (right, bottom)]
        self._widest = 1.05 * float(np.abs(camera.undistort(corners)).max())

    def draw(self, light: NDArray[np.float32], T_world_camera: Transform, time_s: float) -> None:
        """Add the specks to a (H, W, 3) float32 signal image, in place.

        A speck shines as a matt ball in the daylight, less the light behind it that it hides.
        """
        points, radius = self._in_view(T_world_camera, time_s)
        if not len(points):
            return
        pixels = self._camera.project(points)
        range_m = np.linalg.norm(points, axis=1)
        # Share of a pixel that a speck fills, all in one.
        area = np.pi * (radius / range_m * self._focal_px) ** 2
        blur = APERTURE_M * self._focal_px * np.abs(1 / range_m - 1 / FOCUS_M) / 2
        sigma = np.hypot(LENS_SIGMA_PX, np.hypot(blur, radius / range_m * self._focal_px) / 2)
        # However sharp and large, it hides no more than all.
        filled = np.minimum(area, 2 * np.pi * sigma**2)[:, None]
        value = self._contrast(light, pixels, range_m, T_world_camera, time_s) * filled
        for chosen in _by_size(sigma):
            _splat(light, pixels[chosen], sigma[chosen], value[chosen])
        # Two that hide the same light must not take it twice.
        np.maximum(light, 0, out=light)

    def _in_view(self, T_world_camera: Transform, time_s: float) -> tuple[Floats, Floats]:
        """(N, 3) camera frame and (N,) radius of the specks that the camera may see."""
        offset = self._starts + self._drift * time_s - T_world_camera.t
        offset = np.remainder(offset + REACH_M, self._side) - REACH_M
        points = offset @ T_world_camera.R
        reach = self._widest * points[:, 2]
        seen = (
            (points[:, 2] > NEAREST_M)
            & (np.abs(points[:, 0]) < reach)
            & (np.abs(points[:, 1]) < reach)
            & ((offset**2).sum(axis=1) < REACH_M**2)
        )
        return points[seen], self._radius[seen]

    def _contrast(
        self,
        light: NDArray[np.float32],
        pixels: Floats,
        range_m: Floats,
        T_world_camera: Transform,
        time_s: float,
    ) -> Floats:
        """(N, 3) signal of a speck less that of the light it hides."""
        white = np.full((1, len(WAVELENGTHS_NM)), REFLECTANCE)
        depth_m, typical_m = np.array([T_world_camera.t[2]]), np.array([REACH_M / 2])
        (seen,) = self._daylit.seen(
            white, np.maximum(depth_m, 0), typical_m, time_s, T_world_camera.R.T
        )
        # The mean over all faces of a ball that can be seen: half of them meet the sun.
        face = np.exp(-np.outer(range_m - seen.range_m, seen.fade)) * (
            seen.beam / 4 + (seen.sky + seen.below) / 2
        )
        height, width = light.shape[:2]
        x, y = (
            np.clip(np.rint(pixels[:, i]).astype(int), 0, side - 1)
            for i, side in enumerate((width, height))
        )
        hidden = (1 - seen.share_before(range_m.astype(np.float32)).T) * light[y, x]
        return np.asarray(face - hidden)


def _by_size(sigma: Floats) -> list[NDArray[np.intp]]:
    """Indices of specks of about the same size, which share a patch's size."""
    order = np.argsort(sigma)
    return [chosen for chosen in np.array_split(order, min(_SLICES, len(order))) if len(chosen)]


def _splat(light: NDArray[np.float32], pixels: Floats, sigma: Floats, value: Floats) -> None:
    """Add Gaussian spots, each summing up to its ``value`` (N, 3), in place."""
    height, width = light.shape[:2]
    reach = math.ceil(3 * float(sigma.max()))
    corner = np.rint(pixels).astype(np.intp) - reach
    steps = np.arange(2 * reach + 1)
    x, y = corner[:, :1] + steps, corner[:, 1:] + steps
    across, down = (
        np.exp(-0.5 * ((places - pixels[:, i : i + 1]) / sigma[:, None]) ** 2)
        for i, places in enumerate((x, y))
    )
    across *= (x >= 0) & (x < width)
    down *= (y >= 0) & (y < height)
    share = down[:, :, None] * across[:, None, :] / (2 * np.pi * sigma**2)[:, None, None]
    places = np.clip(y, 0, height - 1)[:, :, None] * width + np.clip(x, 0, width - 1)[:, None, :]
    flat = light.reshape(-1, 3)
    for channel in range(3):
        added = (share * value[:, channel, None, None]).astype(np.float32)
        np.add.at(flat[:, channel], places.reshape(-1), added.reshape(-1))
