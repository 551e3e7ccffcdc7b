"""A vehicle on its way to the dock: one scene, frame after frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from chromadock.mounting import R_BODY_CAMERA_FORWARD
from chromadock.track.attitude import Attitude
from chromadock.variety.backdrops import Backdrops, backdrop
from chromadock.variety.docks import ORIGINAL_WIDTH_M
from chromadock.variety.drawing import draw
from chromadock.variety.factors import Fixed
from chromadock.variety.light import water_and_lamp
from chromadock.variety.rendering import render_at
from chromadock.variety.scene import NO_DOCK, Floats, Scene, Thing, Truth

DURATION_S = 14.0
RATE_HZ = 10.0
FROM_M, TO_M = 7.0, 0.7
"""Of a dock as wide as the original; of others in proportion."""
HEADING_DEG, SWAY_DEG, ROCK_DEG = 20.0, 4.0, 3.0
"""At most: between the vehicle's heading and the dock's axis; how far heading, and pitch and
roll, swing to either side."""
ROCKING_S, DRIFTING_S = (3.0, 9.0), (8.0, 20.0)
"""Periods of the attitude's swing and of the way's."""
TELEMETRY_DEG = 1.0
"""Step of the attitude that is told."""
CLOSER = 0.15
"""By how much the backdrop grows on the way."""


@dataclass(frozen=True, eq=False, slots=True)
class Moment:
    """One frame of an approach.

    Parameters
    ----------
    time_s
        Since the first.
    frame_bgr
        (H, W, 3) uint8.
    truth
        What is true of it.
    attitude
        As the vehicle tells it, in whole degrees; its yaw is from an origin of its own.
    """

    time_s: float
    frame_bgr: NDArray[np.uint8]
    truth: Truth
    attitude: Attitude


@dataclass(frozen=True, eq=False, slots=True)
class Path:
    """Where the vehicle is at each moment, (N,) or (N, 3).

    Parameters
    ----------
    time_s
        Since the first.
    angles_rad
        (N, 3) roll, pitch and yaw of the vehicle; the dock's axis is at yaw 0, and it is level.
    R, t
        (N, 3, 3) and (N, 3) metres: ``T_camera_dock`` of a camera that looks ahead.
    """

    time_s: Floats
    angles_rad: Floats
    R: Floats
    t: Floats


def approach(
    index: int, seed: int, backdrops: Backdrops, **fixed: Fixed
) -> Iterator[tuple[Scene, Moment]]:
    """The scene as drawn and each moment of the approach; dock, water and camera stay.

    Parameters
    ----------
    fixed
        As of ``draw``; ``distance`` and angles are the approach's own.  ``dock="none"`` is a way
        to where no dock is, past all that stands or shines there.
    """
    drawn = draw(index, seed, backdrops, **{**fixed, "distance": str(int(FROM_M))})
    scene = replace(drawn, things=_in_the_way_of_none(drawn))
    path = draw_path(scene)
    rng = np.random.default_rng([seed, index, 4])
    origin_rad = rng.uniform(-np.pi, np.pi)
    camera = scene.camera_model
    size, focal = (camera.width, camera.height), float(camera.matrix[0, 0])
    # A turn to the right moves all in view to the left, the bow's rise moves it down.
    turned = path.angles_rad - path.angles_rad[0]
    moved = focal / camera.width * turned[:, 2:0:-1] * (-1, 1)
    room = (_pair(moved.min(axis=0)), _pair(moved.max(axis=0)))
    first = backdrop(scene, size, room=room) * np.float32(scene.daylight_level)
    water, lamp_rgb = water_and_lamp(scene, first)
    for i, time_s in enumerate(path.time_s.tolist()):
        roll, pitch, yaw = path.angles_rad[i]
        closer = 1 + CLOSER * i / len(path.time_s)
        behind = backdrop(scene, size, _pair(moved[i]), closer, room)
        noise = np.random.default_rng([seed, index, 5, i])
        now = replace(
            scene,
            shake_px=scene.shake_px * float(noise.uniform()),
            shake_deg=float(noise.uniform(0, 180)),
        )
        frame, truth = render_at(now, path.R[i], path.t[i], behind, water, lamp_rgb, noise)
        told = np.degrees([roll, pitch, yaw + origin_rad]) / TELEMETRY_DEG
        told_rad = np.radians(np.rint(told) * TELEMETRY_DEG).tolist()
        yield drawn, Moment(time_s, frame, truth, Attitude(*told_rad))


def _pair(values: Floats) -> tuple[float, float]:
    first, second = values.tolist()
    return first, second


def _in_the_way_of_none(scene: Scene) -> tuple[Thing, ...]:
    """The things without those that are nearer than the dock, which could come to hide it; all of
    them where there is none."""
    if scene.dock == NO_DOCK:
        return scene.things
    return tuple(
        thing
        for thing in scene.things
        if (scene.R @ np.array(thing.place) + scene.t)[2] > scene.t[2]
    )


def draw_path(scene: Scene) -> Path:
    """A smooth way in; the dock's centre stays where the frame has room for the dock."""
    rng = np.random.default_rng([scene.seed, scene.index, 3])
    time_s = np.arange(round(DURATION_S * RATE_HZ)) / RATE_HZ
    swing = np.radians((ROCK_DEG, ROCK_DEG, SWAY_DEG))
    rocking = swing * np.column_stack([_swing(time_s, ROCKING_S, rng) for _ in range(3)])
    angles = rocking.copy()
    angles[:, 2] += np.radians(rng.uniform(-HEADING_DEG, HEADING_DEG))
    R = np.array(
        [
            (Attitude(*rad).R_world_body @ R_BODY_CAMERA_FORWARD).T @ R_BODY_CAMERA_FORWARD
            for rad in angles.tolist()
        ]
    )
    scale = scene.width_m / ORIGINAL_WIDTH_M
    z = scale * np.linspace(FROM_M, TO_M, len(time_s))
    dock, camera = scene.dock_geometry, scene.camera_model
    extent = np.ptp(dock.points, axis=0)[:2] if dock else np.full(2, scene.width_m)
    corner = camera.undistort([(0.0, 0.0), (camera.width - 1.0, camera.height - 1.0)])
    middle, half = corner.mean(axis=0), 0.5 * (corner[1] - corner[0])
    room = 0.85 * half - 0.55 * extent / z[:, None] - swing[2:0:-1]
    drift = np.column_stack([_swing(time_s, DRIFTING_S, rng) for _ in range(2)])
    centre = rng.uniform(-0.6, 0.6, 2) + 0.25 * drift
    turned = rocking[:, 2:0:-1] * (-1, 1)
    ray = middle + np.maximum(room, 0.02 * half) * centre + turned
    return Path(time_s, angles, R, z[:, None] * np.column_stack([ray, np.ones(len(z))]))


def _swing(time_s: Floats, periods_s: tuple[float, float], rng: np.random.Generator) -> Floats:
    """(N,) within -1..1: two sines."""
    periods, phases = rng.uniform(*periods_s, 2), rng.uniform(0, 2 * np.pi, 2)
    share = rng.uniform(0.3, 0.7)
    first, second = np.sin(2 * np.pi * time_s[:, None] / periods + phases).T
    return np.asarray(share * first + (1 - share) * second)
