"""From the checked tables of a scene's file to the parts of a scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from chromadock.dock import DockGeometry
from chromadock.errors import ChromadockError
from chromadock.marker_colour import MarkerColour
from chromadock.sim import scene_models as models
from chromadock.sim.ambient import Ambient, Cloud
from chromadock.sim.basin import Basin, Floor, Wall
from chromadock.sim.camera_spec import CameraSpec, load_camera
from chromadock.sim.control import ControlSpec
from chromadock.sim.lights import Emitter, LampSpec
from chromadock.sim.motion import Bobbing, Course, Motion
from chromadock.sim.particles import Suspension
from chromadock.sim.scattered_daylight import ScatteredDaylight
from chromadock.sim.water import Water
from chromadock.toml_file import one_line_error
from chromadock.validation import shown

_T = TypeVar("_T")

SHALLOWEST_M = 0.1
"""Cameras stay this far under the mean surface, at rest."""


def named(place: str, build: Callable[[], _T]) -> _T:
    """What ``build`` gives; its refusal with the file and the key before it."""
    try:
        return build()
    except (ChromadockError, ValueError) as error:
        raise ChromadockError(f"{place}: {error}") from None


def water_of(section: models.WaterSection) -> Water:
    """The water, mixed or not."""
    if section.kind == "mixed":
        return Water.mixed([(_substance(part), part.share) for part in section.part])
    return _substance(section)


def _substance(section: models.WaterSection | models.WaterPart) -> Water:
    if section.kind == "pool":
        return Water.pool(section.scattering_per_m)
    if section.kind == "lake":
        return Water.lake(section.visibility_m, section.cdom_per_m)
    if section.kind == "jerlov":
        return Water.jerlov_type(section.type)
    return Water.measured(section.wavelengths_nm, section.a_per_m, section.b_per_m)


def ambient_of(section: models.LightSection, water: Water, seed: int) -> Ambient:
    """Daylight in the water."""
    clouds = tuple(Cloud(**cloud.model_dump()) for cloud in section.cloud)
    rest = section.model_dump(exclude={"cloud"})
    return ScatteredDaylight(water=water, clouds=clouds, seed=seed, **rest)


def basin_of(place: models.PlaceSection) -> Basin:
    """Floor and wall, where there are any."""
    floor, wall = place.floor_depth_m, place.wall_distance_m
    return Basin(
        None if floor is None else Floor(floor, models.rgb(place.floor_rgb)),
        None if wall is None else Wall(wall, models.rgb(place.wall_rgb)),
    )


def dock_of(section: models.DockSection, source: str) -> tuple[DockGeometry, NDArray[np.float64]]:
    """The markers, and (N,) seconds from which each lamp is dark."""
    dock = DockGeometry.default()
    if section.geometry:
        dock = named(f"{source}: dock.geometry", lambda: DockGeometry.from_toml(section.geometry))
    if section.colour is not None:
        MarkerColour.parse(section.colour, f"{source}: dock.colour")
        dock = replace(dock, colour=section.colour)
    fails = [(f.marker, f.at_s) for f in section.failure]
    named_in = [("markers_out has", name) for name in section.markers_out]
    for key, name in (*named_in, *(("failure is of", name) for name, _ in fails)):
        if name not in dock.names:
            raise ChromadockError(
                f"{source}: dock.{key} {shown(name)}: it must name some of {', '.join(dock.names)}"
            )
    fails += [(name, -np.inf) for name in section.markers_out]
    dark_from_s = [
        min([at_s for name, at_s in fails if name == n], default=np.inf) for n in dock.names
    ]
    return dock, np.array(dark_from_s)


def lamp_of(section: models.LampSection) -> LampSpec:
    """What shines in each marker."""
    red, green, blue = (
        Emitter(led.peak_nm, led.fwhm_nm, section.power * led.intensity_cd)
        for led in (section.red, section.green, section.blue)
    )
    return LampSpec(red, green, blue, section.diameter_m, section.half_angle_deg)


def motion_of(file: models.SceneFile, source: str, dock_seed: int, vehicle_seed: int) -> Motion:
    """Where everything is; nothing rests above the surface or under the floor."""
    vehicle, place = file.vehicle, file.place
    for key, depth, heave in (
        ("place.depth_m", place.depth_m, file.dock.sway.heave_m),
        (
            "place.depth_m + vehicle.offset_down_m",
            place.depth_m + vehicle.offset_down_m,
            vehicle.sway.heave_m,
        ),
    ):
        lowest = np.inf if place.floor_depth_m is None else place.floor_depth_m - heave
        if not SHALLOWEST_M + heave <= depth <= lowest:
            floor = "" if np.isinf(lowest) else f" to {lowest:g} m, above the floor"
            raise ChromadockError(
                f"{source}: {key} is {depth:g}: with its heaving it must be "
                f"{SHALLOWEST_M + heave:g} m{floor or ' or more'}"
            )
    approach = vehicle.approach
    distance = vehicle.distance_m
    return Motion(
        depth_m=place.depth_m,
        heading_deg=vehicle.heading_deg,
        course=Course(distance, distance, 1.0)
        if approach is None
        else Course(distance, approach.to_m, approach.duration_s),
        offset_right_m=vehicle.offset_right_m,
        offset_down_m=vehicle.offset_down_m,
        aim_yaw_deg=vehicle.aim_yaw_deg,
        aim_pitch_deg=vehicle.aim_pitch_deg,
        aim_roll_deg=vehicle.aim_roll_deg,
        camera_roll_deg=vehicle.camera_roll_deg,
        dock=Bobbing(dock_seed, **file.dock.sway.model_dump()),
        vehicle=Bobbing(vehicle_seed, **vehicle.sway.model_dump()),
    )


def suspension_of(section: models.ParticlesSection | None, seed: int) -> Suspension | None:
    """What drifts in the water."""
    if section is None:
        return None
    north, east, down = section.drift_m_s
    return Suspension(seed, section.concentration_per_m3, section.diameter_m, (north, east, down))


def camera_of(section: models.CameraSection, place: str) -> CameraSpec:
    """A camera with the scene's changes of its control; ``place`` is the file and the table."""
    camera = named(f"{place}.model", lambda: load_camera(section.model))
    try:
        control = ControlSpec(**{**asdict(camera.control), **section.control})
    except ValidationError as error:
        raise one_line_error(place, error) from None
    return replace(camera, control=control)
