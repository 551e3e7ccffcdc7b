"""A short approach to the default dock: frames that are found and tracked, made in no time."""

from __future__ import annotations

import cv2
import numpy as np

from chromadock import CameraModel, Detector, DockGeometry
from chromadock.results.detection import Detection
from chromadock.sources import Frame

WATER = (200, 160, 40)  # BGR
FPS = 20.0
CAMERA = CameraModel(640, 480, np.array([[512, 0, 319.5], [0, 510, 239.5], [0, 0, 1.0]]))
CAMERA_YAML = """\
image_width: 640
image_height: 480
camera_matrix: {rows: 3, cols: 3, data: [512, 0, 319.5, 0, 510, 239.5, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
"""


def picture(away_m: float, noise_seed: int | None = None, roll_rad: float = 0.0) -> np.ndarray:
    """The dock straight ahead, its markers of the colour that this water makes of them; the
    vehicle rolled about where it looks to."""
    frame = np.full((480, 640, 3), WATER, np.uint8)
    dock = DockGeometry.default()
    found = Detector(None, dock, independent=True).process(frame, 0)
    assert found.observed is not None
    R_camera_dock = cv2.Rodrigues(np.array([0.0, 0.0, -roll_rad]))[0]
    for x, y in CAMERA.project(dock.points @ R_camera_dock.T + np.array([0, 0, away_m])):
        place = (round(x * 16), round(y * 16))
        cv2.circle(frame, place, 5 * 16, found.observed[::-1], -1, cv2.LINE_AA, 4)
    if noise_seed is not None:
        noise = np.random.default_rng(noise_seed).normal(0, 2, frame.shape)
        frame = np.clip(frame + noise, 0, 255).astype(np.uint8)
    return frame


def frames(count: int, start_s: float = 0.0) -> list[Frame]:
    """From 2 m on, 0.1 m/s nearer."""
    return [
        Frame(picture(2.0 - 0.1 * k / FPS, k), f"{k}.png", k, start_s + k / FPS)
        for k in range(count)
    ]


def detected(pictures: list[Frame]) -> list[Detection]:
    """What the detector says of them."""
    detector = Detector(CAMERA, DockGeometry.default())
    return [detector.process(frame.image, frame.time_s) for frame in pictures]
