"""What the two cameras see: drifting water, and a dock that comes nearer."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.demo.light import add_led, to_encoded, to_linear
from chromadock.dock import DockGeometry

DURATION_S = 12.0
# Bright enough that a lit marker leaves the water's grey interval, which the paper's mask
# asks for: see "What the printed mask cannot see" in docs/method.md.
POOL_RGB = (52, 150, 200)
LAKE_RGB = (92, 176, 118)
ATTENUATION = 0.2
LED_RADIANCE = 0.95
NOISE = 2.0
"""Standard deviation of the sensor's noise, grey levels."""

DOCK_CAMERA = (160, 120)
VEHICLE_CAMERA = CameraModel.nominal(640, 480)


@dataclass(frozen=True, slots=True)
class TruePose:
    """``T_camera_dock``: rotation (3, 3) and translation (3,) in metres."""

    R: NDArray[np.float64]
    t: NDArray[np.float64]


def water_rgb(time_s: float) -> NDArray[np.float32]:
    """Linear colour of the water at mid-height, from pool blue to lake green."""
    share = np.clip(time_s / DURATION_S, 0, 1)
    mixed = (1 - share) * to_linear(POOL_RGB) + share * to_linear(LAKE_RGB)
    return np.asarray(mixed, np.float32)


def true_pose(time_s: float) -> TruePose:
    """An approach from 3 m to 1.2 m that sways a little."""
    share = time_s / DURATION_S
    yaw = np.radians(8) * np.sin(2 * np.pi * time_s / 7)
    pitch = np.radians(3) * np.sin(2 * np.pi * time_s / 5 + 1)
    roll = np.radians(3) * np.sin(2 * np.pi * time_s / 4)
    R = cv2.Rodrigues(np.array([pitch, 0.0, 0.0]))[0]
    R = R @ cv2.Rodrigues(np.array([0.0, yaw, 0.0]))[0]
    R = R @ cv2.Rodrigues(np.array([0.0, 0.0, roll]))[0]
    sway = 0.12 * np.sin(2 * np.pi * time_s / 6)
    t = np.array([sway, 0.05 * np.cos(2 * np.pi * time_s / 3), 3.0 - 1.8 * share])
    return TruePose(np.asarray(R, np.float64), t)


def dock_frame(time_s: float, rng: np.random.Generator) -> bytes:
    """The dock's own camera: QQVGA, big-endian RGB565, water only."""
    width, height = DOCK_CAMERA
    rgb = _exposed(_water(time_s, width, height), rng)
    r, g, b = (rgb[..., c].astype(np.uint16) for c in range(3))
    return ((r >> 3) << 11 | (g >> 2) << 5 | b >> 3).astype(">u2").tobytes()


def vehicle_frame(
    time_s: float,
    led_light: NDArray[np.float32],
    geometry: DockGeometry,
    rng: np.random.Generator,
) -> NDArray[np.uint8]:
    """The vehicle's camera: VGA, BGR uint8.

    ``led_light`` is (3,) R, G, B: the share of full power that each channel gives.
    """
    camera, pose = VEHICLE_CAMERA, true_pose(time_s)
    light = _water(time_s, camera.width, camera.height)
    _add_frame(light, geometry, pose)
    points = geometry.points @ pose.R.T + pose.t
    for pixel, point in zip(camera.project(points), points, strict=True):
        add_led(
            light,
            (float(pixel[0]), float(pixel[1])),
            LED_RADIANCE * led_light,
            float(np.linalg.norm(point)),
            float(camera.matrix[0, 0]),
            ATTENUATION,
        )
    return np.ascontiguousarray(_exposed(light, rng)[..., ::-1])


def _water(time_s: float, width: int, height: int) -> NDArray[np.float32]:
    """Light that falls off downwards, (height, width, 3) linear RGB."""
    fall = np.linspace(1.06, 0.94, height, dtype=np.float32)[:, None, None]
    return np.broadcast_to(fall * water_rgb(time_s), (height, width, 3)).copy()


def _add_frame(light: NDArray[np.float32], geometry: DockGeometry, pose: TruePose) -> None:
    """The dock's dark tubes a hand's breadth outside the markers, dimmed by the water."""
    low, high = geometry.points.min(axis=0) - 0.1, geometry.points.max(axis=0) + 0.1
    outline = np.array(
        [(low[0], low[1], 0), (high[0], low[1], 0), (high[0], high[1], 0), (low[0], high[1], 0)]
    )
    pixels = VEHICLE_CAMERA.project(outline @ pose.R.T + pose.t)
    thickness = max(1, round(VEHICLE_CAMERA.matrix[0, 0] * 0.02 / pose.t[2]))
    tubes = np.zeros(light.shape[:2], np.uint8)
    corners = np.rint(pixels * 16).astype(np.int32)
    cv2.polylines(tubes, [corners], True, 255, thickness, cv2.LINE_AA, shift=4)
    visible = tubes[..., None] / np.float32(255) * np.float32(np.exp(-ATTENUATION * pose.t[2]))
    light *= 1 - 0.9 * visible


def _exposed(light: NDArray[np.float32], rng: np.random.Generator) -> NDArray[np.uint8]:
    """Encoded to 8 bits with the sensor's noise."""
    noise = rng.normal(0, NOISE, light.shape).astype(np.float32)
    return np.asarray(np.clip(np.rint(to_encoded(light) + noise), 0, 255), np.uint8)
