"""Docks composited in linear light on photographs of water, harder than ``composites``.

Each frame draws its own water (beam attenuation 0.25 to 1.35 /m, each channel up to a third
off), struts and buoys about the dock, cores that clip, halos of forward-scattered light,
shot and read noise, a Bayer mosaic and JPEG.  It owes the simulator nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from lit import (
    HALO_ANGLE_RAD,
    LED_RADIUS_M,
    LENS_SIGMA_PX,
    SCATTERED_SHARE,
    to_encoded,
    to_linear,
)

from chromadock import CameraModel, DockGeometry
from chromadock.colour.background import background_colour
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.colour.marker import marker_hue
from chromadock.colour.working_image import smooth, working_image

SIZE = (640, 480)
CAMERA = CameraModel.nominal(*SIZE)
DOCK = DockGeometry.default()
ATTITUDE_DEG = (8.0, 20.0, 8.0)  # pitch, yaw, roll: at most
MARGIN_PX = 12  # of the markers from the frame's edge
ATTENUATION = (0.25, 1.35)  # 1/m: a clear pool to a murky harbour
CHANNEL_SPREAD = (0.75, 1.3)
LED_RADIANCE = 12.0  # of the LED's face in full scales: it clips out to several metres
# No LED is one channel's alone, nor is a channel one LED's (rows: R, G, B of the camera).
CROSSTALK = np.array([[1, 0.05, 0.02], [0.10, 1, 0.15], [0.02, 0.2, 1]])
SHOT_VARIANCE, READ_VARIANCE = 1.2e-4, 2e-6  # of linear light; per unit of light, and always
CODE_NOISE = 1.5  # 8-bit steps
JPEG_QUALITY = 90
DARK = np.full(3, 0.05)  # the dock's frame
ORANGE = np.array([0.8, 0.25, 0.03])  # a buoy's


@dataclass(frozen=True, slots=True)
class Composite:
    """A (480, 640, 3) uint8 BGR frame with the true pose and marker pixels (N, 2)."""

    frame_bgr: np.ndarray
    R: np.ndarray
    t: np.ndarray
    pixels: np.ndarray


@dataclass(frozen=True, slots=True)
class Water:
    """Linear RGB: beam attenuation (3,) 1/m, colour of the water itself (3,), of the LEDs (3,)."""

    attenuation: np.ndarray
    veil: np.ndarray
    lamp: np.ndarray

    @classmethod
    def of(cls, rgb: np.ndarray, rng: np.random.Generator) -> Water:
        """The water in a photograph, (H, W, 3) uint8 RGB, and the LEDs that suit it."""
        seen = background_colour(smooth(working_image(np.ascontiguousarray(rgb))))
        pure = to_linear(np.array(rgb_from_hsv(marker_hue(seen, "ternary"), 255, 255)))
        lamp = CROSSTALK @ pure
        attenuation = rng.uniform(*ATTENUATION) * rng.uniform(*CHANNEL_SPREAD, 3)
        return cls(attenuation, to_linear(np.array(seen.rgb)), LED_RADIANCE * lamp / lamp.max())


def read(photograph: Path) -> np.ndarray:
    """A photograph at SIZE, (480, 640, 3) uint8 BGR."""
    return cv2.resize(cv2.imread(str(photograph)), SIZE)


def composites(
    photographs: list[Path], range_m: float, count: int, seed: int, dock: DockGeometry = DOCK
) -> Iterator[Composite]:
    """``count`` frames with a dock at ``range_m``, each from a seed of its own."""
    for i in range(count):
        rng = np.random.default_rng([seed, round(1000 * range_m), i])
        yield compose(read(photographs[i % len(photographs)]), range_m, rng, dock)


def compose(
    photograph_bgr: np.ndarray, range_m: float, rng: np.random.Generator, dock: DockGeometry = DOCK
) -> Composite:
    """One frame: the dock somewhere in view, its markers lit by the mapping of this water."""
    rgb = photograph_bgr[..., ::-1]
    R, t, pixels = pose_in_view(range_m, rng, dock)
    water = Water.of(rgb, rng)
    light = to_linear(rgb)
    add_clutter(light, water, dock, R, t, rng)
    for pixel, point in zip(pixels, dock.points, strict=True):
        add_lamp(light, water, pixel, float(np.linalg.norm(R @ point + t)))
    return Composite(photographed(light, rng), R, t, pixels)


def pose_in_view(
    range_m: float, rng: np.random.Generator, dock: DockGeometry = DOCK
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """R, t and the pixels of a dock that the camera sees whole."""
    while True:
        R = np.eye(3)
        for axis, angle in enumerate(np.radians(rng.uniform(-1, 1, 3) * ATTITUDE_DEG)):
            R = R @ cv2.Rodrigues(np.eye(3)[axis] * angle)[0]
        t = np.array([rng.uniform(-0.5, 0.5), rng.uniform(-0.35, 0.35), 1.0])
        t *= range_m / np.linalg.norm(t)
        pixels = CAMERA.project(dock.points @ R.T + t)
        if (pixels > MARGIN_PX).all() and (pixels < np.array(SIZE) - MARGIN_PX).all():
            return R, t, pixels


def add_lamp(
    light: np.ndarray,
    water: Water,
    pixel: np.ndarray,
    range_m: float,
    camera: CameraModel = CAMERA,
) -> None:
    """Add one LED to a linear RGB image, in place: what comes straight and its halo."""
    focal = float(camera.matrix[0, 0])
    face = focal * LED_RADIUS_M / range_m
    sigma, halo = np.hypot(LENS_SIGMA_PX, face / 2), focal * HALO_ANGLE_RAD
    straight = np.exp(-water.attenuation * range_m)
    scattered = np.exp(-(1 - SCATTERED_SHARE) * water.attenuation * range_m) - straight
    energy = np.pi * face**2 * water.lamp
    y, x = np.mgrid[0 : light.shape[0], 0 : light.shape[1]].astype(np.float32)
    distance = np.hypot(x - np.float32(pixel[0]), y - np.float32(pixel[1]))
    core = np.exp(-0.5 * (distance / sigma) ** 2) / (2 * np.pi * sigma**2)
    glow = np.exp(-distance / halo) / (2 * np.pi * halo**2)
    for channel in range(3):
        direct, around = energy[channel] * straight[channel], energy[channel] * scattered[channel]
        light[..., channel] += np.float32(direct) * core + np.float32(around) * glow


def in_plain_water(points: np.ndarray, camera: CameraModel, seed: int = 0) -> np.ndarray:
    """Lamps at points in the camera frame (N, 3), where the lens has them, over blue-green water
    with a camera's noise, (H, W, 3) uint8 BGR."""
    rng = np.random.default_rng(seed)
    shade = np.linspace(1.2, 0.8, camera.height)[:, None, None] * np.array([40.0, 140.0, 190.0])
    noisy = shade + rng.normal(0, 2, (camera.height, camera.width, 3))
    rgb = np.clip(noisy, 0, 255).astype(np.uint8)
    light, seen = to_linear(rgb), Water.of(rgb, rng)
    water = Water(np.full(3, 0.4), seen.veil, seen.lamp)
    for pixel, point in zip(camera.project(points), points, strict=True):
        add_lamp(light, water, pixel, float(np.linalg.norm(point)), camera)
    return photographed(light, rng)


def add_clutter(
    light: np.ndarray,
    water: Water,
    dock: DockGeometry,
    R: np.ndarray,
    t: np.ndarray,
    rng: np.random.Generator,
) -> None:
    """The dock's frame, up to three buoys and two posts near it, in place."""
    focal, range_m = float(CAMERA.matrix[0, 0]), float(np.linalg.norm(t))
    (left, top), (right, bottom) = dock.points[:, :2].min(0) - 0.1, dock.points[:, :2].max(0) + 0.1
    edge = np.array([(left, top), (right, top), (right, bottom), (left, bottom)])

    def drawn(points: np.ndarray, thickness_m: float, closed: bool) -> np.ndarray:
        return _stroke(CAMERA.project(points @ R.T + t), focal * thickness_m / range_m, closed)

    def blend(coverage: np.ndarray, colour: np.ndarray) -> None:
        through = np.exp(-water.attenuation * range_m)
        seen = (colour * through + water.veil * (1 - through)).astype(np.float32)
        light[:] = light * (1 - coverage) + coverage * seen

    blend(drawn(np.column_stack([edge, np.full(4, 0.02)]), 0.025, True), DARK)
    for _ in range(rng.integers(0, 4)):
        place = rng.uniform((-0.8, -0.5, 0.0), (0.8, 0.5, 0.4))
        radius, colour = rng.uniform(0.03, 0.12), ORANGE * rng.uniform(0.2, 1.0)
        blend(drawn(np.array([place, place]), 2 * radius, False), colour)
    for _ in range(2):
        x, grey = rng.uniform(-0.6, 0.6), rng.uniform(0.05, 0.5)
        blend(drawn(np.array([(x, -0.8, 0.05), (x, 0.6, 0.05)]), 0.03, False), np.full(3, grey))


def photographed(light: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Linear RGB through a sensor with a Bayer mosaic and JPEG, uint8 BGR."""
    shot = np.sqrt(np.clip(light, 0, 1) * SHOT_VARIANCE + READ_VARIANCE)
    noisy = light + shot * rng.standard_normal(light.shape, np.float32)
    encoded = to_encoded(_demosaiced(np.clip(noisy, 0, 1)))
    stepped = np.rint(encoded + CODE_NOISE * rng.standard_normal(light.shape, np.float32))
    bgr = np.ascontiguousarray(np.clip(stepped, 0, 255).astype(np.uint8)[..., ::-1])
    jpeg = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])[1]
    return cv2.imdecode(jpeg, cv2.IMREAD_COLOR)


def _demosaiced(light: np.ndarray) -> np.ndarray:
    """What is left of linear RGB, 0..1, where each pixel sees one colour: red at the top left."""
    raw = light[..., 1].copy()
    raw[::2, ::2], raw[1::2, 1::2] = light[::2, ::2, 0], light[1::2, 1::2, 2]
    whole = cv2.demosaicing(np.rint(65535 * raw).astype(np.uint16), cv2.COLOR_BayerBG2RGB)
    return whole.astype(np.float32) / 65535


def _stroke(points: np.ndarray, thickness: float, closed: bool) -> np.ndarray:
    """How much of each pixel a round-ended stroke covers, (480, 640, 1) float32."""
    drawn = np.zeros(SIZE[::-1], np.uint8)
    if not np.isfinite(points).all() or np.abs(points).max() > 8 * max(SIZE):
        return drawn[..., None].astype(np.float32)
    fixed = np.rint(points * 16).astype(np.int32)
    cv2.polylines(drawn, [fixed], closed, 255, max(1, round(thickness)), cv2.LINE_AA, 4)
    return drawn[..., None].astype(np.float32) / 255
