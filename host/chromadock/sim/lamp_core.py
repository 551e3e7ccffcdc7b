"""A lamp itself in an image: where it is seen, and an evenly lit disc that the lens blurs."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.sim.rays import solid_angles, unit_rays

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

LENS_SIGMA_PX = 0.7
"""Standard deviation of the blur by a good lens and a pixel's own width."""

_SPOTS_AT_MOST = 128
_GOLDEN_ANGLE_RAD = math.pi * (3 - math.sqrt(5))
_SAME_RAY = 1e-3


def place_points(camera: CameraModel, points_camera: Floats) -> tuple[Floats, Floats]:
    """Where (N, 3) points are seen, (N, 2) pixels, and those pixels' solid angles, (N,) sr.

    NaN for a point behind the camera or so far aside that the lens model, which is a
    polynomial, folds it back.
    """
    pixels = camera.project(points_camera)
    pixels[np.abs(pixels).max(axis=1) > 2 * max(camera.width, camera.height)] = math.nan
    angles = np.full(len(pixels), math.nan)
    (near,) = np.nonzero(np.isfinite(pixels[:, 0]))
    rays = points_camera[near] / np.linalg.norm(points_camera[near], axis=1, keepdims=True)
    off = np.linalg.norm(unit_rays(camera, pixels[near]) - rays, axis=1)
    angles[near] = solid_angles(camera, pixels[near])
    folded = near[off > _SAME_RAY]
    pixels[folded], angles[folded] = math.nan, math.nan
    return pixels, angles


def add_cores(light: Image, pixels: Floats, values: Floats, radius_px: float) -> None:
    """Add evenly lit discs, blurred by the lens, to an image, in place.

    A disc is a sunflower of equal Gaussian spots, which are separable: the sum of all spots
    is a product of two thin matrices.

    Parameters
    ----------
    light : (H, W, 3) float32 signal.
    pixels : (N, 2) x and y of the discs' centres, where the light's centroid comes; N >= 1.
    values : (N, 3) what each disc's pixels sum up to: irradiance / a pixel's solid angle.
    radius_px : of the discs before the blur.
    """
    count = 2 * math.ceil(min(_SPOTS_AT_MOST, 4 + 6 * (radius_px / LENS_SIGMA_PX) ** 2) / 2)
    sigma = max(LENS_SIGMA_PX, 1.2 * radius_px / math.sqrt(count))
    reach = math.ceil(radius_px + 6 * sigma)
    columns, rows = (
        np.arange(
            max(0, math.floor(places.min()) - reach),
            min(size, math.ceil(places.max()) + reach + 1),
        )
        for places, size in zip(pixels.T, light.shape[1::-1], strict=True)
    )
    if not len(columns) or not len(rows):
        return
    spots = (pixels[:, None] + radius_px * _sunflower(count)).reshape(-1, 2)
    across = _spread(columns, spots[:, 0], sigma)
    down = _spread(rows, spots[:, 1], sigma)
    patch = light[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    for channel, value in enumerate(np.repeat(values / count, count, axis=0).T):
        patch[..., channel] += down.T @ (value[:, None] * across)


def _spread(pixels: NDArray[np.int_], centres: Floats, sigma: float) -> Floats:
    """(S, n): share of a Gaussian spot at each of S centres that falls on each pixel."""
    offset = (pixels - centres[:, None]) / sigma
    return np.asarray(np.exp(-0.5 * offset**2) / (sigma * math.sqrt(2 * math.pi)))


@cache
def _sunflower(count: int) -> Floats:
    """(count, 2) points evenly over the unit disc, in pairs: their centroid is 0 (Vogel 1979)."""
    index = np.arange(count // 2)
    radius = np.sqrt((index + 0.5) / len(index))
    angle = index * _GOLDEN_ANGLE_RAD
    half = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    return np.concatenate([half, -half])
