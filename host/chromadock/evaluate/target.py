"""The true dock in a frame, as the measures need it."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.sim.scene import Scene
from chromadock.sim.truth import Truth


@dataclass(frozen=True, eq=False)
class Target:
    """The true dock in one frame.

    ``names`` and ``pixels`` (N, 2) of the markers, NaN behind the camera; ``R`` (3, 3) and
    ``t`` (3,) metres of ``T_camera_dock``; ``radius_px`` is half the smallest distance of two
    markers as seen from there: what is that near to a marker belongs to it.
    """

    names: tuple[str, ...]
    pixels: NDArray[np.float64]
    R: NDArray[np.float64]
    t: NDArray[np.float64]
    radius_px: float

    @property
    def range_m(self) -> float:
        """From the camera to the dock's origin."""
        return float(np.linalg.norm(self.t))

    def circles(self, shape: tuple[int, ...]) -> NDArray[np.uint8]:
        """(H, W) uint8, 255 within ``radius_px`` of a marker."""
        height, width = shape[:2]
        inside = np.zeros((height, width), np.uint8)
        for x, y in self.pixels:
            if -width < x < 2 * width and -height < y < 2 * height:  # not so for NaN
                cv2.circle(inside, (round(x), round(y)), round(self.radius_px), 255, -1)
        return inside


def target_of(scene: Scene, truth: Truth) -> Target:
    """The dock as the truth of a vehicle's frame has it."""
    pose, dock = truth.T_camera_dock, scene.dock
    spacing_m = min(float(np.linalg.norm(a - b)) for a, b in itertools.combinations(dock.points, 2))
    focal_px = float(np.diag(scene.vehicle_camera.model.matrix)[:2].mean())
    radius_px = focal_px * spacing_m / 2 / truth.range_m
    return Target(dock.names, truth.pixels(), pose.R, pose.t, radius_px)
