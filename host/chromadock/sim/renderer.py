"""One camera's view of a scene: a pure function of the moment, the LEDs and the settings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.sim.backdrop import backdrop
from chromadock.sim.bodies import Bodies
from chromadock.sim.control import CameraSettings
from chromadock.sim.halo import HaloTable
from chromadock.sim.lights import Lamps
from chromadock.sim.markers import Markers, Placed
from chromadock.sim.motion import Motion
from chromadock.sim.particles import Particles
from chromadock.sim.photograph import Photographs
from chromadock.sim.scene import Scene
from chromadock.sim.shutter import Shutter
from chromadock.sim.transform import Transform
from chromadock.sim.truth import MarkerTruth, Truth, colour_of

Floats = NDArray[np.float64]
Image = NDArray[np.float32]
Which = Literal["vehicle", "dock"]


@dataclass(frozen=True, eq=False)
class Frame:
    """A finished frame: (H, W, 3) uint8 BGR and what is true of it."""

    image_bgr: NDArray[np.uint8]
    truth: Truth


@dataclass(frozen=True)
class VehicleView:
    """The vehicle's camera and the dock before it."""

    motion: Motion

    def T_world_camera(self, time_s: float) -> Transform:
        """See ``bodies.View``."""
        return self.motion.T_world_camera(time_s)

    def T_world_dock(self, time_s: float) -> Transform:
        """See ``bodies.View``."""
        return self.motion.T_world_dock(time_s)


@dataclass(frozen=True)
class DockView:
    """The dock's own camera, at the dock's origin, looking along its z."""

    motion: Motion

    def T_world_camera(self, time_s: float) -> Transform:
        """See ``bodies.View``."""
        return self.motion.T_world_dock(time_s)

    def T_world_dock(self, time_s: float) -> Transform:
        """See ``bodies.View``."""
        return self.motion.T_world_dock(time_s)


class Renderer:
    """Renders what one camera sees.

    Parameters
    ----------
    scene
        What there is.
    which
        ``"vehicle"`` or ``"dock"``.  The dock's camera looks away from the lamps beside it and
        sees none.
    photographs
        Backgrounds instead of rendered water.
    """

    def __init__(self, scene: Scene, which: Which, photographs: Photographs | None = None) -> None:
        is_vehicle = which == "vehicle"
        spec = scene.vehicle_camera if is_vehicle else scene.dock_camera
        self._scene = scene
        self._stream = 0 if is_vehicle else 1
        self._camera, self._sensor = spec.model, spec.sensor
        self._view = VehicleView(scene.motion) if is_vehicle else DockView(scene.motion)
        self._photographs = photographs
        self._backdrop = backdrop(scene, spec, photographs)
        ambient, response = scene.ambient, spec.sensor.response
        shutter = Shutter(spec.model.height, spec.readout_s)
        self._bodies = Bodies(scene.bodies, spec.model, response, shutter, ambient, self._view)
        self._particles = (
            None
            if scene.suspension is None
            else Particles(scene.suspension, spec.model, response, ambient)
        )
        self._markers: Markers | None = None
        if is_vehicle:
            halo = HaloTable(ambient.water.phase)
            lamps = Lamps(scene.lamp, spec.model, response, ambient.water, halo)
            self._markers = Markers(scene, spec.model, shutter, self._view, lamps, self._bodies)
        corners = np.array([[-0.5, -0.5], [spec.model.width - 0.5, spec.model.height - 0.5]])
        (left, top), (right, bottom) = spec.model.undistort(corners)
        self._solid_angle = (right - left) * (bottom - top)

    def meter(self, time_s: float, led_share: ArrayLike) -> Floats:
        """(3,) mean signal over the image that exposure and white balance go by, cd/m^2.

        Of the water and the lamps' unscattered light, as if there was nothing solid.
        """
        mean = self._backdrop.mean(time_s, self._view.T_world_camera(time_s))
        if self._markers is not None and np.any(led_share):
            placed = self._markers.placed(time_s, hidden=False)
            energy = self._markers.irradiance(placed, led_share, time_s)[placed.in_view].sum(axis=0)
            mean = mean + energy / self._solid_angle
        return mean

    def light(self, time_s: float, led_share: ArrayLike) -> Image:
        """(H, W, 3) float32 signal on the sensor, R, G, B, cd/m^2.

        ``led_share`` is (3,) what the LEDs give, share of full power, R, G, B.
        """
        placed = None if self._markers is None else self._markers.placed(time_s)
        return self._light(time_s, led_share, placed)[0]

    def picture(
        self, time_s: float, led_share: ArrayLike, settings: CameraSettings
    ) -> NDArray[np.uint8]:
        """(H, W, 3) uint8 BGR; the same arguments give the same bytes, in any process.

        Noise depends on the scene's seed, the camera and the time alone.
        """
        return self._taken(self.light(time_s, led_share), time_s, settings)

    def frame(
        self, time_s: float, led_share: ArrayLike, settings: CameraSettings, index: int
    ) -> Frame:
        """The same with its truth; ``index`` only numbers the frame."""
        placed = None if self._markers is None else self._markers.placed(time_s)
        light, water = self._light(time_s, led_share, placed)
        return Frame(
            self._taken(light, time_s, settings),
            self._truth(time_s, np.asarray(led_share, np.float64), settings, index, placed, water),
        )

    def _taken(self, light: Image, time_s: float, settings: CameraSettings) -> NDArray[np.uint8]:
        """The picture of light on the sensor."""
        moment = round(time_s * 1e6) & 0xFFFFFFFFFFFFFFFF
        rng = np.random.default_rng([self._scene.seed, self._stream, moment])
        return self._sensor.picture(light, settings, rng)

    def _light(
        self, time_s: float, led_share: ArrayLike, placed: Placed | None
    ) -> tuple[Image, Floats]:
        """The light on the sensor, and (3,) the mean of the water alone."""
        pose = self._view.T_world_camera(time_s)
        light = self._backdrop.light(time_s, pose)
        water = _mean(light)
        self._bodies.draw(light, time_s)
        if self._markers is not None and placed is not None:
            self._markers.draw(light, placed, led_share, time_s)
        if self._particles is not None:
            self._particles.draw(light, pose, time_s)
        return light, water

    def _truth(
        self,
        time_s: float,
        led_share: Floats,
        settings: CameraSettings,
        index: int,
        placed: Placed | None,
        water: Floats,
    ) -> Truth:
        T_world_camera = self._view.T_world_camera(time_s)
        markers: tuple[MarkerTruth, ...] = ()
        if self._markers is not None and placed is not None:
            markers = self._markers.truth(placed, led_share, water, time_s)
        north, east, depth = T_world_camera.t
        forward = T_world_camera.R[:, 2]
        ambient = self._scene.ambient
        return Truth(
            index=index,
            time_s=time_s,
            T_camera_dock=T_world_camera.inverse() @ self._view.T_world_dock(time_s),
            depth_m=float(depth),
            heading_deg=math.degrees(math.atan2(forward[1], forward[0])) % 360,
            markers=markers,
            water_signal=water,
            water_rgb=colour_of(water, self._sensor, settings),
            led_share=led_share,
            settings=settings,
            flicker=float(ambient.fluctuation(time_s, north, east)),
            clear_share=math.prod(cloud.illuminance_share(time_s) for cloud in ambient.clouds),
            photograph=None if self._photographs is None else self._photographs.path(time_s).name,
        )


def _mean(light: Image) -> Floats:
    """(3,) of every eighth pixel, which is near enough."""
    return np.asarray(light[::8, ::8].mean(axis=(0, 1)), np.float64)
