"""Two dives, one after the other: a blue pool, then a green lake."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock.detector import Detector
from chromadock.results.detection import Detection
from chromadock.sim.renderer import Frame
from chromadock.sim.scene import Scene, load_scene
from chromadock.sim.simulation import Simulation, Step
from chromadock.sim.workers import rendered

FRAME_RATE_HZ = 15


@dataclass(frozen=True)
class Leg:
    """One dive: a shipped scene, and what is different in it."""

    scene_name: str
    duration_s: float
    changes: Mapping[str, Any] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Frames."""
        return round(self.duration_s * FRAME_RATE_HZ)

    def scene(self) -> Scene:
        """The scene with the changes."""
        return load_scene(self.scene_name, self.changes)


# From about where the dock begins to be seen: far in the pool, near in the lake.
LEGS = (
    Leg(
        "pool",
        7.0,
        {"vehicle.distance_m": 7.0, "vehicle.approach": {"to_m": 1.6, "duration_s": 7.0}},
    ),
    Leg(
        "lake",
        5.0,
        {"vehicle.distance_m": 2.4, "vehicle.approach": {"to_m": 0.9, "duration_s": 5.0}},
    ),
)
COUNT = sum(leg.count for leg in LEGS)


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """The vehicle's frame and mask, what it found, and both sides' state; time over all dives."""

    index: int
    time_s: float
    place: str
    scene: Scene
    frame: Frame
    mask: NDArray[np.bool_]
    detection: Detection
    step: Step


def run(jobs: int) -> Iterator[Moment]:
    """All of it in that many processes, the same in any number.

    The vehicle starts anew with each dive, as the dock does.
    """
    start_s, index = 0.0, 0
    for leg in LEGS:
        scene = leg.scene()
        simulation = Simulation(scene)
        detector = Detector(scene.vehicle_camera.model, scene.dock, mounting=scene.mounting)
        steps = list(simulation.steps(np.arange(leg.count) / FRAME_RATE_HZ))
        frames = rendered(simulation, steps, jobs, _as_it_is)
        for step, frame in zip(steps, frames, strict=True):
            detection = detector.process(frame.image_bgr, step.time_s)
            yield Moment(
                index=index,
                time_s=start_s + step.time_s,
                place=leg.scene_name,
                scene=scene,
                frame=frame,
                mask=detector.mask,
                detection=detection,
                step=step,
            )
            index += 1
        start_s += leg.duration_s


def _as_it_is(frame: Frame) -> Frame:
    return frame
