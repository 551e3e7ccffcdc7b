"""The dock's markers before one camera: drawn as lamps, and told as truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.camera import CameraModel
from chromadock.sim.backdrop import depth_of
from chromadock.sim.bodies import Bodies, View
from chromadock.sim.lamp_core import LENS_SIGMA_PX
from chromadock.sim.lights import Lamps
from chromadock.sim.rays import solid_angles, unit_rays
from chromadock.sim.scene import Scene
from chromadock.sim.shutter import Shutter
from chromadock.sim.truth import MarkerTruth

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

_ROUNDS = 4
"""A marker's row decides when it is taken, and that where it is: quickly the same again."""
_SAME_RAY = 1e-3
_DARK = 1e-3
"""cd/m^2: no water is taken for darker than this, or contrast would have no bounds."""


@dataclass(frozen=True, eq=False)
class Placed:
    """The N markers at a moment, each at its own row's time.

    Parameters
    ----------
    points, axes
        (N, 3) camera frame: where they are, metres, and unit vectors along which they shine.
    pixels
        (N, 2); NaN where the camera cannot see.
    in_view
        (N,) bool: in the image.
    visible
        (N,) share that no body hides, 0..1.
    """

    points: Floats
    axes: Floats
    pixels: Floats
    in_view: NDArray[np.bool_]
    visible: Floats


class Markers:
    """The scene's markers before one camera.

    Parameters
    ----------
    scene
        Their geometry and lamps.
    camera, shutter, view
        Whose images.
    lamps, bodies
        What draws them and what hides them.
    """

    def __init__(
        self,
        scene: Scene,
        camera: CameraModel,
        shutter: Shutter,
        view: View,
        lamps: Lamps,
        bodies: Bodies,
    ) -> None:
        self._scene = scene
        self._camera = camera
        self._shutter = shutter
        self._view = view
        self._lamps = lamps
        self._bodies = bodies

    def placed(self, time_s: float, hidden: bool = True) -> Placed:
        """Where they are in the frame of ``time_s``; without ``hidden``, as if nothing hid them."""
        geometry = self._scene.dock.points
        points, axes = np.empty_like(geometry), np.empty_like(geometry)
        for i, point in enumerate(geometry):
            points[i], axes[i] = self._at_own_row(point, time_s)
        pixels = self._camera.project(points)
        visible = np.ones(len(points))
        if hidden:
            visible = self._bodies.visible(points, self._scene.lamp.diameter_m, time_s)
        return Placed(points, axes, pixels, self._in_view(points, pixels), visible)

    def draw(self, light: Image, placed: Placed, led_share: ArrayLike, time_s: float) -> None:
        """Add the lamps, and their images in the surface, to a (H, W, 3) signal, in place."""
        if not np.any(led_share):
            return
        works = self._works(time_s)
        self._lamps.draw(light, placed.points, placed.axes, led_share, placed.visible * works)
        pose = self._view.T_world_camera(time_s)
        self._lamps.draw_mirrored(
            light,
            placed.points,
            placed.axes,
            led_share,
            works,
            waves=self._scene.waves,
            time_s=time_s,
            R_world_camera=pose.R,
            depth_m=depth_of(pose),
        )

    def irradiance(self, placed: Placed, led_share: ArrayLike, time_s: float) -> Floats:
        """(N, 3) unscattered light at the camera from each marker, signal sr; 0 where hidden."""
        ranges = np.linalg.norm(placed.points, axis=1)
        cosine = -np.einsum("ij,ij->i", placed.points, placed.axes) / ranges
        emitted = np.maximum(cosine, 0) ** self._scene.lamp.cosine_power
        shares = emitted * placed.visible * self._works(time_s)
        return np.asarray(shares[:, None] * self._lamps.signal(ranges, led_share))

    def truth(
        self, placed: Placed, led_share: ArrayLike, water: Floats, time_s: float
    ) -> tuple[MarkerTruth, ...]:
        """What is true of them before ``water`` (3,) signal."""
        ranges = np.linalg.norm(placed.points, axis=1)
        lit = self._scene.works(time_s) & np.any(led_share)
        contrast = self._peaks(placed, led_share, ranges, time_s) / np.maximum(water, _DARK)
        return tuple(
            MarkerTruth(
                name=name,
                pixel=None if np.isnan(pixel[0]) else (float(pixel[0]), float(pixel[1])),
                range_m=float(range_m),
                in_view=bool(in_view),
                visible=float(share),
                lit=bool(shines),
                contrast=(float(over[0]), float(over[1]), float(over[2])),
            )
            for name, pixel, range_m, in_view, share, shines, over in zip(
                self._scene.dock.names,
                placed.pixels,
                ranges,
                placed.in_view,
                placed.visible,
                lit,
                contrast,
                strict=True,
            )
        )

    def _at_own_row(self, point_dock: Floats, time_s: float) -> tuple[Floats, Floats]:
        """(3,) place and axis of one marker, camera frame, when its row is taken."""
        moment = time_s
        for _ in range(_ROUNDS):
            pose = self._view.T_world_camera(moment).inverse() @ self._view.T_world_dock(moment)
            point = pose.points(point_dock)
            row = self._camera.project(point)[0, 1]
            if not self._shutter.readout_s or np.isnan(row):
                break
            moment = self._shutter.row_time(time_s, float(np.clip(row, 0, self._camera.height)))
        return point, -pose.R[:, 2]

    def _in_view(self, points: Floats, pixels: Floats) -> NDArray[np.bool_]:
        """(N,) in the image, and not folded into it by the lens model from far aside."""
        size = np.array([self._camera.width, self._camera.height])
        within = (pixels >= -0.5) & (pixels <= size - 0.5)
        inside: NDArray[np.bool_] = within[:, 0] & within[:, 1]
        rays = unit_rays(self._camera, pixels[inside])
        directions = points[inside] / np.linalg.norm(points[inside], axis=1, keepdims=True)
        inside[inside] = np.linalg.norm(rays - directions, axis=1) < _SAME_RAY
        return inside

    def _works(self, time_s: float) -> Floats:
        """(N,) 1 where a lamp works, 0 where not."""
        return self._scene.works(time_s).astype(np.float64)

    def _peaks(self, placed: Placed, led_share: ArrayLike, ranges: Floats, time_s: float) -> Floats:
        """(N, 3) signal in the middle of each core: a disc that the lens blurs."""
        peaks = np.zeros((len(ranges), 3))
        seen = placed.in_view
        angles = solid_angles(self._camera, placed.pixels[seen])
        radius = self._scene.lamp.diameter_m / 2 / ranges[seen] / np.sqrt(angles)
        within = -np.expm1(-(radius**2) / (2 * LENS_SIGMA_PX**2)) / (np.pi * radius**2)
        energy = self.irradiance(placed, led_share, time_s)[seen]
        peaks[seen] = energy * (within / angles)[:, None]
        return peaks
