"""What is behind everything in one camera's images: rendered water, or photographs of water."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.sim.background import Background
from chromadock.sim.camera_spec import CameraSpec
from chromadock.sim.photograph import Photographs
from chromadock.sim.scene import Scene
from chromadock.sim.transform import Transform

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

METER_WIDTH = 40
"""Pixels across of the picture of the water that cameras meter on."""
SHALLOWEST_M = 0.02
"""A camera that the waves lift out of the water is taken for one just below."""


class Backdrop(ABC):
    """The light behind everything, for poses ``T_world_camera``."""

    @abstractmethod
    def light(self, time_s: float, pose: Transform) -> Image:
        """(H, W, 3) float32 signal, which may be drawn on."""

    @abstractmethod
    def mean(self, time_s: float, pose: Transform) -> Floats:
        """(3,) mean of that over the image, quickly."""


class RenderedBackdrop(Backdrop):
    """The scene's own water."""

    def __init__(self, scene: Scene, camera: CameraSpec) -> None:
        response = camera.sensor.response
        rest = (response, scene.ambient, scene.waves, scene.basin)
        self._background = Background(camera.model, *rest)
        self._small = Background(_shrunk(camera.model), *rest)

    def light(self, time_s: float, pose: Transform) -> Image:
        """See ``Backdrop``."""
        return self._background.light(time_s, pose.R, depth_of(pose))

    def mean(self, time_s: float, pose: Transform) -> Floats:
        """See ``Backdrop``."""
        small = self._small.light(time_s, pose.R, depth_of(pose))
        return np.asarray(small.mean(axis=(0, 1)), np.float64)


class PhotographedBackdrop(Backdrop):
    """Photographs, as bright as the scene's own water would be."""

    def __init__(self, scene: Scene, camera: CameraSpec, photographs: Photographs) -> None:
        self._water = RenderedBackdrop(scene, camera)
        self._camera = camera
        self._photographs = photographs

    def light(self, time_s: float, pose: Transform) -> Image:
        """See ``Backdrop``."""
        photograph = self._photographs.linear(time_s, self._camera.sensor)
        return photograph * np.float32(self._brightness(time_s, pose))

    def mean(self, time_s: float, pose: Transform) -> Floats:
        """See ``Backdrop``."""
        colour = self._photographs.colour(time_s, self._camera.sensor)
        return colour * self._brightness(time_s, pose)

    def _brightness(self, time_s: float, pose: Transform) -> float:
        return float(self._water.mean(time_s, pose).mean())


def backdrop(scene: Scene, camera: CameraSpec, photographs: Photographs | None) -> Backdrop:
    """Photographs where there are some, else the scene's own water."""
    if photographs is None:
        return RenderedBackdrop(scene, camera)
    return PhotographedBackdrop(scene, camera, photographs)


def depth_of(pose: Transform) -> float:
    """Metres below the mean surface of a camera at ``T_world_camera``, kept under water."""
    return max(float(pose.t[2]), SHALLOWEST_M)


def _shrunk(camera: CameraModel) -> CameraModel:
    """The same view with few pixels.  Pixel 0 is the middle of the first, in both."""
    factor = max(camera.width // METER_WIDTH, 1)
    width, height = camera.width // factor, camera.height // factor
    scale = np.diag([width / camera.width, height / camera.height, 1.0])
    shift = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1]])
    matrix = np.linalg.inv(shift) @ scale @ shift @ camera.matrix
    return replace(camera, width=width, height=height, matrix=matrix)
