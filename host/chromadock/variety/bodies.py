"""Things that stand in the water: the dock's body, buoys, boxes, posts."""

from __future__ import annotations

import cv2
import numpy as np

from chromadock.camera import CameraModel
from chromadock.variety.light import Water
from chromadock.variety.scene import Floats, Image, Scene, Thing

BLACK = np.full(3, 0.03)
DARK = np.full(3, 0.06)
_SHIFT = 4  # cv2 draws at sixteenths of a pixel
_FAR = 8  # frames: what is farther out than that is not drawn


class Painter:
    """Paints onto linear RGB (H, W, 3), in place, with the water's haze.

    Parameters
    ----------
    light : what is painted on.
    camera : which sees it.
    water : by whose light.
    """

    def __init__(self, light: Image, camera: CameraModel, water: Water) -> None:
        self._light, self._camera, self._water = light, camera, water
        self._focal = float(camera.matrix[0, 0])
        self._aspect = float(camera.matrix[1, 1] / camera.matrix[0, 0])

    def disc(self, place: Floats, radius_m: float, reflectance: Floats) -> None:
        """A round thing at (3,) in the camera's frame; its reflectance is linear RGB (3,)."""
        centre = self._camera.project([place])[0]
        radius = self._focal * radius_m / place[2]
        angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
        ring = np.column_stack([np.cos(angle), self._aspect * np.sin(angle)])
        self._fill(centre + radius * ring, reflectance, float(place[2]))

    def box(self, place: Floats, half_m: tuple[float, float], reflectance: Floats) -> None:
        """An upright rectangle, half as wide and half as high as that."""
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half_m
        self._fill(self._outline(place, corners), reflectance, float(place[2]))

    def bar(self, start: Floats, end: Floats, width_m: float, reflectance: Floats) -> None:
        """A flat bar between two places, a little longer than from one to the other."""
        along = (end - start) / np.linalg.norm(end - start)
        across = np.cross(along, (0.0, 0.0, 1.0))
        across *= 0.5 * width_m / max(float(np.linalg.norm(across)), 1e-6)
        beyond = 0.4 * width_m * along
        steps = np.linspace(start - beyond, end + beyond, 8)
        outline = np.vstack([steps + across, steps[::-1] - across])
        middle = 0.5 * (start + end)
        if (outline[:, 2] > 0.05).all():
            self._fill(self._camera.project(outline), reflectance, float(middle[2]))

    def _outline(self, place: Floats, corners: Floats) -> Floats:
        centre = self._camera.project([place])[0]
        return np.asarray(centre + corners * self._focal / place[2] * (1, self._aspect))

    def _fill(self, outline: Floats, reflectance: Floats, range_m: float) -> None:
        height, width = self._light.shape[:2]
        if not np.isfinite(outline).all() or np.abs(outline).max() > _FAR * max(height, width):
            return
        x0, y0 = np.maximum(np.floor(outline.min(0)).astype(int) - 1, 0)
        x1, y1 = np.minimum(np.ceil(outline.max(0)).astype(int) + 2, (width, height))
        if x0 >= x1 or y0 >= y1:
            return
        covered = np.zeros((y1 - y0, x1 - x0), np.uint8)
        fixed = np.rint((outline - (x0, y0)) * 2**_SHIFT).astype(np.int32)
        cv2.fillPoly(covered, [fixed], 255, cv2.LINE_AA, _SHIFT)
        share = covered[..., None].astype(np.float32) / 255
        seen = self._water.seen(reflectance, range_m).astype(np.float32)
        window = self._light[y0:y1, x0:x1]
        window += share * (seen - window)


def paint_dock(painter: Painter, scene: Scene, lamps: Floats) -> None:
    """The dock's bars and the black holders about its lamps, (N, 3) in the camera's frame."""
    white = np.full(3, scene.bar_reflectance)
    colour = white if scene.build == "white bars" else DARK
    for i, j in scene.bars:
        painter.bar(lamps[i], lamps[j], scene.bar_width_m, colour)
    if scene.build != "lamps":
        for place, diameter in zip(lamps, scene.holders_m, strict=True):
            painter.disc(place, diameter / 2, BLACK)


def paint_thing(painter: Painter, thing: Thing, place: Floats, own: Floats) -> None:
    """What stands at (3,) in the camera's frame; ``own`` (3,) is the markers' linear colour."""
    reflectance = np.array(thing.colour) * (own if thing.own_colour else 1.0)
    size = thing.size_m
    if thing.kind == "disc":
        painter.disc(place, size, reflectance)
    elif thing.kind == "box":
        painter.box(place, (size * thing.aspect, size), reflectance)
    elif thing.kind == "post":
        painter.box(place, (size, 3 * float(place[2])), reflectance)
