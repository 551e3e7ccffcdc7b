"""Where dock and vehicle are at any moment: course, aim, and both bobbing in the waves.

World: x north, y east, z down, origin on the mean surface.  Bodies: x right, y down,
z forward; the dock's "forward" is away from an approaching vehicle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np

from chromadock.sim.transform import Transform, level, looking, turned
from chromadock.sim.waves import Sway


@dataclass(frozen=True)
class Bobbing:
    """How waves move a body about its rest, in six independent ways.

    Parameters
    ----------
    seed
        Another seed, another motion.
    surge_m, sway_m, heave_m
        Amplitudes along the body's z, x and y, metres.
    roll_deg, pitch_deg, yaw_deg
        Amplitudes about the body's z, x and y.
    period_s
        Of the waves.
    """

    seed: int = 0
    surge_m: float = 0.0
    sway_m: float = 0.0
    heave_m: float = 0.0
    roll_deg: float = 0.0
    pitch_deg: float = 0.0
    yaw_deg: float = 0.0
    period_s: float = 4.0

    def at(self, time_s: float) -> Transform:
        """``T_rest_body``."""
        surge, sway, heave, roll, pitch, yaw = (float(s.value(time_s)) for s in self._sways)
        return Transform(turned(yaw, pitch, roll), np.array([sway, heave, surge]))

    @cached_property
    def _sways(self) -> tuple[Sway, ...]:
        amplitudes = (
            self.surge_m, self.sway_m, self.heave_m, self.roll_deg, self.pitch_deg, self.yaw_deg
        )  # fmt: skip
        seeds = np.random.SeedSequence(self.seed).generate_state(len(amplitudes))
        return tuple(
            Sway(int(seed), amplitude, self.period_s)
            for seed, amplitude in zip(seeds, amplitudes, strict=True)
        )


@dataclass(frozen=True)
class Course:
    """Distance from the dock: steady from one to another in ``duration_s``, then held."""

    from_m: float
    to_m: float
    duration_s: float

    def distance_m(self, time_s: float) -> float:
        """At a moment; before 0 it is the first one."""
        share = min(max(time_s / self.duration_s, 0.0), 1.0)
        return self.from_m + share * (self.to_m - self.from_m)


@dataclass(frozen=True)
class Motion:
    """Both bodies in the world.

    Parameters
    ----------
    depth_m
        Of the dock's origin at rest.
    heading_deg
        Where the dock's z axis points at rest: which way a vehicle in front of it looks.
    course
        Distance of the vehicle's camera along that axis.
    offset_right_m, offset_down_m
        How far the camera is off that axis; it looks at the dock's origin all the same.
    aim_yaw_deg, aim_pitch_deg, aim_roll_deg
        How far it is turned away from there.
    camera_roll_deg
        How the camera is mounted: turned about its line of sight, its right side low; 90: on its
        side, 180: upside down.
    dock, vehicle
        How the waves move them.
    """

    depth_m: float
    heading_deg: float
    course: Course
    offset_right_m: float = 0.0
    offset_down_m: float = 0.0
    aim_yaw_deg: float = 0.0
    aim_pitch_deg: float = 0.0
    aim_roll_deg: float = 0.0
    camera_roll_deg: float = 0.0
    dock: Bobbing = field(default_factory=Bobbing)
    vehicle: Bobbing = field(default_factory=Bobbing)

    def T_world_dock(self, time_s: float) -> Transform:
        """The dock in the world; its camera is at its origin and looks along its z."""
        return _remembered(_T_world_dock, self, time_s)

    def T_world_camera(self, time_s: float) -> Transform:
        """The vehicle's camera in the world."""
        return _remembered(_T_world_camera, self, time_s)

    def T_camera_dock(self, time_s: float) -> Transform:
        """The dock as the vehicle's camera sees it."""
        return self.T_world_camera(time_s).inverse() @ self.T_world_dock(time_s)

    @cached_property
    def T_world_rest(self) -> Transform:
        """The dock at rest."""
        return Transform(level(self.heading_deg), np.array([0.0, 0.0, self.depth_m]))

    @cached_property
    def T_vehicle_camera(self) -> Transform:
        """The camera in the vehicle, which has x right, y down, z forward too."""
        return Transform(turned(0.0, 0.0, self.camera_roll_deg), np.zeros(3))


# All that is drawn into a frame asks for the same few moments.
@lru_cache(maxsize=32)
def _remembered(
    pose: Callable[[Motion, float], Transform], motion: Motion, time_s: float
) -> Transform:
    return pose(motion, time_s)


def _T_world_dock(motion: Motion, time_s: float) -> Transform:
    return motion.T_world_rest @ motion.dock.at(time_s)


def _T_world_camera(motion: Motion, time_s: float) -> Transform:
    distance = motion.course.distance_m(time_s)
    position = np.array([motion.offset_right_m, motion.offset_down_m, -distance])
    aim = turned(motion.aim_yaw_deg, motion.aim_pitch_deg, motion.aim_roll_deg)
    T_rest_vehicle = Transform(looking(-position) @ aim, position)
    T_world_vehicle = motion.T_world_rest @ T_rest_vehicle @ motion.vehicle.at(time_s)
    return T_world_vehicle @ motion.T_vehicle_camera
