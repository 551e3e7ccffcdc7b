"""What dock and vehicle see in the closed loop: rendered before, shown in real time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np

from chromadock.sim.recording import write_camera
from chromadock.sim.scene import load_scene
from chromadock.sim.simulation import Simulation, Step, power_share
from chromadock_firmware import lib

SECONDS = 4.0
"""Of the approach, which is shown forth and back."""
CHANGES = {
    "vehicle.distance_m": 2.8,
    "vehicle.approach": {"to_m": 2.2, "duration_s": SECONDS},
}
Duties = tuple[int, int, int]


def lamps(duties: Sequence[int]) -> tuple[float, float, float]:
    """What the dock's lamps give at these duties, share of full power, R, G, B."""
    red, green, blue = duties
    return power_share((red, green, blue), int(lib.LED_FULL))


@dataclass(frozen=True, eq=False)
class Film:
    """The approach in a pool, frame by frame, before anybody lights the dock's lamps."""

    simulation: Simulation
    steps: list[Step]
    fps: int

    @classmethod
    def of(cls, fps: int) -> Film:
        """At so many frames a second."""
        simulation = Simulation(load_scene("pool", CHANGES))
        steps = list(simulation.steps(np.arange(round(SECONDS * fps)) / fps))
        return cls(simulation, steps, fps)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the vehicle's pictures."""
        model = self.simulation.scene.vehicle_camera.model
        return model.width, model.height

    def write_calibration(self, path: Path) -> None:
        """The vehicle camera's."""
        write_camera(path, self.simulation.scene.vehicle_camera.model)

    def write_water(self, folder: Path) -> None:
        """What the dock's own camera sees: a picture a frame, for `chromadock dock simulate`."""
        folder.mkdir()
        for step in self.steps:
            picture = self.simulation.dock_frame(step).image_bgr
            cv2.imwrite(str(folder / f"{step.index:04d}.png"), picture)

    def write(self, path: Path, duties: Duties | None) -> list[float]:
        """What the vehicle sees while the dock's lamps have these duties, None for dark: BGR
        frames one after the other.  Returns the true ranges, metres, by frame."""
        share = (0.0, 0.0, 0.0) if duties is None else lamps(duties)
        ranges_m = []
        with path.open("wb") as file:
            for step in self.steps:
                frame = self.simulation.frame(replace(step, led_share=share))
                file.write(frame.image_bgr.tobytes())
                ranges_m.append(frame.truth.range_m)
        return ranges_m
