"""Dock and vehicle side by side, a frame at a time, with no message between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.colour.hsv import degrees
from chromadock.demo import scene
from chromadock.detection import Detection
from chromadock.detector import Detector
from chromadock.dock import DockGeometry
from chromadock_firmware import Dock, lib

FRAME_RATE_HZ = 15


@dataclass(frozen=True, slots=True)
class Step:
    """One moment: the vehicle's frame and mask, what it found, and the truth."""

    index: int
    time_s: float
    frame_bgr: NDArray[np.uint8]
    mask: NDArray[np.bool_]
    detection: Detection
    dock_hue_deg: float
    truth: scene.TruePose


def run(geometry: DockGeometry, seed: int = 0) -> Iterator[Step]:
    """The whole approach; deterministic by ``seed``."""
    rng = np.random.default_rng(seed)
    dock = Dock()
    detector = Detector(scene.VEHICLE_CAMERA, geometry, method="paper")
    for index in range(round(scene.DURATION_S * FRAME_RATE_HZ)):
        time_s = index / FRAME_RATE_HZ
        width, height = scene.DOCK_CAMERA
        frame = scene.dock_frame(time_s, rng)
        dock.frame(frame, width, height, "rgb565", round(1000 * time_s))
        seen = scene.vehicle_frame(time_s, led_light(dock.duties), geometry, rng)
        detection = detector.process(seen, time_s)
        yield Step(
            index,
            time_s,
            seen,
            detector.mask,
            detection,
            degrees(dock.marker_hue),
            scene.true_pose(time_s),
        )


def led_light(duties: tuple[int, int, int]) -> NDArray[np.float32]:
    """What a common-anode LED gives at these duties, R, G, B, 0..1."""
    return 1 - np.array(duties, dtype=np.float32) / np.float32(lib.LED_FULL)
