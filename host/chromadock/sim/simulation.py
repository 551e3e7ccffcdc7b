"""Dock and vehicle side by side in one scene, with no message between them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock.choices import MAPPINGS
from chromadock.colour.hsv import degrees, rgb_from_hsv
from chromadock.errors import ChromadockError
from chromadock.link.rgb565 import to_rgb565
from chromadock.marker_colour import MarkerColour
from chromadock.method import DEFAULT_MAPPING_NAME
from chromadock.sim.camera_spec import CameraSpec
from chromadock.sim.control import CameraSettings
from chromadock.sim.photograph import Photographs
from chromadock.sim.renderer import Frame, Renderer
from chromadock.sim.scene import Scene

RGB = tuple[int, int, int]

_LOOK_S = 0.001
"""How long the dock's lamps are out for a frame without their light: a picture here is of one
moment, so the vehicle's camera sees none of it."""

METER_PERIOD_S = 0.1
"""Cameras look at the light this often, not at every frame of a fast one."""


@dataclass(frozen=True)
class Step:
    """One moment: all that the vehicle's frame depends on, and what the dock decided.

    Parameters
    ----------
    index, time_s
        Number of the step, seconds.
    led_share
        What the dock's LEDs give, share of full power, R, G, B.
    settings
        The vehicle camera's.
    dock_hue_deg
        The hue that the dock's firmware decides on, 0..360: what it shows, unless the scene's dock
        has a colour of its own.
    dock_background
        The water's colour as the dock's firmware sees it, R, G, B, 0..255.
    dock_settings
        The dock camera's.
    """

    index: int
    time_s: float
    led_share: tuple[float, float, float]
    settings: CameraSettings
    dock_hue_deg: float
    dock_background: RGB
    dock_settings: CameraSettings


class Simulation:
    """A run of both sides; pickles, and any process makes the same frames of the same steps.

    Parameters
    ----------
    scene
        See ``load_scene``.
    mapping
        From water to marker colour, the dock's setting of that name.
    photographs
        Backgrounds instead of rendered water, for both cameras.

    Raises
    ------
    ChromadockError
        For an unknown mapping.
    """

    def __init__(
        self,
        scene: Scene,
        mapping: str = DEFAULT_MAPPING_NAME,
        photographs: Photographs | None = None,
    ) -> None:
        if mapping not in MAPPINGS:
            raise ChromadockError(
                f"unknown mapping '{mapping}': choose one of {', '.join(MAPPINGS)}"
            )
        self.scene = scene
        self.mapping = mapping
        self._photographs = photographs
        self._vehicle = Renderer(scene, "vehicle", photographs)
        self._dock = Renderer(scene, "dock", photographs)

    def steps(self, times: Iterable[float]) -> Iterator[Step]:
        """Both sides' state at ascending times, seconds: quick, but one after the other.

        At each of them the dock's camera takes a frame, the firmware core decides on it and
        drives the LEDs; the vehicle's camera adapts.  Where the core wants a frame without its
        own light, it gets one between two steps.  Each call starts both sides anew.

        Raises
        ------
        ChromadockError
            Where the firmware's package is missing.
        """
        dock, led_full = _firmware(self.mapping)
        own_duties = _own_duties(dock, self.scene.dock.colour)
        dock_camera = _Adapting(self.scene.dock_camera, self._dock)
        vehicle_camera = _Adapting(self.scene.vehicle_camera, self._vehicle)
        led_share = (0.0, 0.0, 0.0)
        for index, time_s in enumerate(times):
            dock_settings = dock_camera.settings(time_s, led_share)
            self._look(dock, time_s, led_share, dock_settings)
            duties = dock.duties
            if dock.looks:
                self._look(dock, time_s + _LOOK_S, (0.0, 0.0, 0.0), dock_settings)
                duties = dock.duties
            led_share = power_share(own_duties or duties, led_full)
            settings = vehicle_camera.settings(time_s, led_share)
            water = dock.c.decision.background
            yield Step(
                index=index,
                time_s=time_s,
                led_share=led_share,
                settings=settings,
                dock_hue_deg=degrees(dock.marker_hue),
                dock_background=rgb_from_hsv(water.hue, water.saturation, water.value),
                dock_settings=dock_settings,
            )

    def _look(
        self,
        dock: Any,
        time_s: float,
        led_share: tuple[float, float, float],
        camera: CameraSettings,
    ) -> None:
        """The dock decides on what its camera sees in the light of its LEDs."""
        seen = self._dock.picture(time_s, led_share, camera)
        height, width = seen.shape[:2]
        dock.frame(to_rgb565(seen), width, height, "rgb565", round(1000 * time_s))

    def __reduce__(self) -> tuple[Any, ...]:
        # Renderers are quickly built and large to send.
        return Simulation, (self.scene, self.mapping, self._photographs)

    def frame(self, step: Step) -> Frame:
        """The vehicle camera's frame of a step."""
        return self._vehicle.frame(step.time_s, step.led_share, step.settings, step.index)

    def dock_frame(self, step: Step) -> Frame:
        """The dock camera's frame of a step, as its picture before RGB565."""
        return self._dock.frame(step.time_s, step.led_share, step.dock_settings, step.index)


class _Adapting:
    """A camera's settings at ascending times."""

    def __init__(self, camera: CameraSpec, renderer: Renderer) -> None:
        self._control = camera.auto_control()
        self._adapts = "auto" in (camera.control.exposure, camera.control.white_balance)
        self._renderer = renderer
        self._settings: CameraSettings | None = None
        self._metered: NDArray[np.float64] = np.zeros(3)
        self._metered_s = -math.inf

    def settings(self, time_s: float, led_share: tuple[float, float, float]) -> CameraSettings:
        """At a moment; nothing is metered once all is locked."""
        if self._settings is None or self._adapts:
            if time_s - self._metered_s >= METER_PERIOD_S:
                self._metered = self._renderer.meter(time_s, led_share)
                self._metered_s = time_s
            self._settings = self._control.update(self._metered, time_s)
        return self._settings


def _firmware(mapping: str) -> tuple[Any, int]:
    """The dock's firmware core, and the duty of a channel that is always on."""
    try:
        from chromadock_firmware import Dock, Settings, lib
    except ModuleNotFoundError as error:
        raise ChromadockError(
            f"the simulation needs the package {error.name}: "
            "run `make setup` in the project's folder"
        ) from None
    return Dock(Settings(mapping=mapping)), int(lib.LED_FULL)


def _own_duties(dock: Any, colour: str | None) -> tuple[int, int, int] | None:
    """What the firmware core gives its LEDs for a colour that does not follow the water.

    White is all three at full power.  None where the core decides, as it does too for ``any``: then
    only the vehicle does not know.
    """
    own = None if colour is None else MarkerColour.parse(colour)
    if own is None or own.kind == "any":
        return None
    from chromadock_firmware import ffi, lib

    duty, led = ffi.new("uint16_t[3]"), ffi.addressof(dock.c.settings, "led")
    if own.hue is None:
        lib.led_raw_duties(duty, bytes([255, 255, 255]), led)
    else:
        lib.led_duties(duty, own.hue, led)
    return duty[0], duty[1], duty[2]


def power_share(duties: tuple[int, int, int], full: int) -> tuple[float, float, float]:
    """What LEDs give at these duties, which are on while their pin is high: LED_ANODE 0."""
    red, green, blue = (np.array(duties) / full).tolist()
    return red, green, blue
