"""Renders a scene: its picture and what is true of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.variety.backdrops import backdrop
from chromadock.variety.bodies import Painter, paint_dock, paint_thing
from chromadock.variety.factors import variety
from chromadock.variety.lamps import Lamp, add_glow, add_lamp
from chromadock.variety.light import Water, lamp_light, water_and_lamp
from chromadock.variety.picture import taken
from chromadock.variety.scene import Floats, Image, Scene, Truth

NEAREST_M = 0.05
"""What is nearer than that to the camera is not drawn."""

RGB = tuple[int, int, int]


def render(scene: Scene) -> tuple[NDArray[np.uint8], Truth]:
    """The scene's (H, W, 3) uint8 BGR picture and its truth; the same scene, the same picture."""
    size = variety().cameras[scene.camera].size
    behind = backdrop(scene, size)
    water, lamp_rgb = water_and_lamp(scene, behind * np.float32(scene.daylight_level))
    rng = np.random.default_rng([scene.seed, scene.index, 1])
    return render_at(scene, scene.R, scene.t, behind, water, lamp_rgb, rng)


def render_at(
    scene: Scene,
    R: Floats,
    t: Floats,
    behind: Image,
    water: Water,
    lamp_rgb: RGB,
    rng: np.random.Generator,
) -> tuple[NDArray[np.uint8], Truth]:
    """The picture from a pose, ``T_camera_dock``, on a backdrop (H, W, 3) by full daylight.

    Parameters
    ----------
    water, lamp_rgb : see ``water_and_lamp``.
    rng : of this frame alone, for the noise.
    """
    camera, dock = scene.camera_model, scene.dock_geometry
    light = behind * np.float32(scene.daylight_level)
    places = (dock.points if dock else np.zeros((0, 3))) @ R.T + t
    painter = Painter(light, camera, water)
    own = lamp_light(lamp_rgb, 1.0, scene.crosstalk)
    things = [(thing, R @ np.array(thing.place) + t) for thing in scene.things]
    things = sorted((x for x in things if x[1][2] > NEAREST_M), key=lambda x: -x[1][2])
    dock_m = float(places[:, 2].mean()) if len(places) else np.inf
    for thing, place in things:
        if place[2] >= dock_m or not dock:
            paint_thing(painter, thing, place, own)
    paint_dock(painter, scene, places)
    for thing, place in things:
        if place[2] < dock_m and dock:
            paint_thing(painter, thing, place, own)

    focal = float(camera.matrix[0, 0])
    pixels = camera.project(places)
    lit = lamp_light(lamp_rgb, scene.radiance, scene.crosstalk)
    lamps = [
        _lamp(pixel, place, scene.lamp_radius_m, gain * lit, focal, scene)
        for pixel, place, gain in zip(pixels, places, scene.lamp_gains, strict=True)
        if place[2] > NEAREST_M
    ]
    for thing, place in things:
        if thing.kind == "lamp":
            colour = own if thing.own_colour else np.array(thing.colour)
            pixel = camera.project([place])[0]
            shine = thing.radiance * colour
            lamps.append(_lamp(pixel, place, thing.size_m, shine, focal, scene))
    aspect = float(camera.matrix[1, 1] / focal)
    for lamp in lamps:
        add_lamp(
            light, lamp, water.attenuation, scene.scattered_share, focal * scene.halo_rad, aspect
        )
    add_glow(light, lamps, water.attenuation, focal)
    frame = taken(light, scene, rng, variety().cameras[scene.camera].interlaced)
    size = np.array([camera.width, camera.height])
    in_view = np.asarray(((pixels >= -0.5) & (pixels < size - 0.5)).all(axis=1))
    if dock is None:
        R, t = np.full((3, 3), np.nan), np.full(3, np.nan)
    return frame, Truth(camera, dock, R, t, pixels, in_view, lamp_rgb)


def _lamp(
    pixel: Floats, place: Floats, radius_m: float, light: Floats, focal: float, scene: Scene
) -> Lamp:
    range_m = float(np.linalg.norm(place))
    return Lamp(pixel, focal * radius_m / range_m, range_m, light, scene.lamp_profile)
