"""Markers of the right colour, lit in linear light, on real photographs of water."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from lit import add_led, to_encoded, to_linear

from chromadock import CameraModel, DockGeometry
from chromadock.colour.background import background_colour
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.colour.marker import marker_hue
from chromadock.colour.working_image import smooth, working_image

SIZE = (640, 480)
CAMERA = CameraModel.nominal(*SIZE)
DOCK = DockGeometry.default()
LED_RADIANCE = 3.0  # the core clips up to about three metres
ATTENUATION = (0.25, 0.8)  # 1/m: a clear pool to hazy coastal water


@dataclass(frozen=True, slots=True)
class Composite:
    """A (480, 640, 3) uint8 BGR frame with the true pose and marker pixels (4, 2)."""

    frame_bgr: np.ndarray
    R: np.ndarray
    t: np.ndarray
    pixels: np.ndarray


def composites(
    photographs: list[Path], range_m: float, count: int, seed: int
) -> Iterator[Composite]:
    """``count`` frames at ``range_m``; yaw +-20 degrees, pitch and roll +-8."""
    rng = np.random.default_rng(seed)
    for i in range(count):
        photograph = cv2.imread(str(photographs[i % len(photographs)]))
        yield compose(cv2.resize(photograph, SIZE), range_m, rng)


def compose(
    photograph_bgr: np.ndarray,
    range_m: float,
    rng: np.random.Generator,
    mapping: str = "ternary",
    hue: int | None = None,
) -> Composite:
    """One frame: the dock somewhere in view, its markers lit by the mapping of this water, or
    in a hue of their own."""
    rgb = photograph_bgr[..., ::-1]
    water = background_colour(smooth(working_image(np.ascontiguousarray(rgb))))
    hue = marker_hue(water, mapping) if hue is None else hue
    pure = to_linear(np.array(rgb_from_hsv(hue, 255, 255)))
    R, t, pixels = _pose_in_view(range_m, rng)
    light = to_linear(rgb)
    attenuation = rng.uniform(*ATTENUATION)
    for pixel in pixels:
        centre = (float(pixel[0]), float(pixel[1]))
        focal = float(CAMERA.matrix[0, 0])
        add_led(light, centre, LED_RADIANCE * pure, range_m, focal, attenuation)
    noisy = rng.normal(0, 2, light.shape)
    noisy += to_encoded(light)
    # Into the same array: a new one of this size costs the system more than the sum.
    encoded = np.clip(np.rint(noisy, out=noisy), 0, 255, out=noisy).astype(np.uint8)
    jpeg = cv2.imencode(".jpg", encoded[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, 92])[1]
    return Composite(cv2.imdecode(jpeg, cv2.IMREAD_COLOR), R, t, pixels)


def _pose_in_view(
    range_m: float, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    while True:
        yaw, pitch, roll = np.radians(rng.uniform(-1, 1, 3) * (20, 8, 8))
        R = np.eye(3)
        for axis, angle in ((0, pitch), (1, yaw), (2, roll)):
            R = R @ cv2.Rodrigues(np.eye(3)[axis] * angle)[0]
        t = range_m * np.array([rng.uniform(-0.5, 0.5), rng.uniform(-0.35, 0.35), 1.0])
        t *= range_m / np.linalg.norm(t)
        pixels = CAMERA.project(DOCK.points @ R.T + t)
        if (pixels > 12).all() and (pixels < np.array(SIZE) - 12).all():
            return R, t, pixels
