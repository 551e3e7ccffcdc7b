"""What bounds the water: the surface above, a floor and a wall where there are any."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.ambient import Ambient
from chromadock.sim.spectrum import reflectance

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Floor:
    """A flat floor: its depth below the surface, metres, and linear sRGB reflectance, 0..1."""

    depth_m: float
    colour: tuple[float, float, float]


@dataclass(frozen=True)
class Wall:
    """A round wall about the camera: its distance, metres, and linear sRGB reflectance, 0..1."""

    distance_m: float
    colour: tuple[float, float, float]


class Ends(NamedTuple):
    """Where lines of sight end.

    Attributes
    ----------
    length_m
        (n,) metres; infinite in open water.
    floor, wall
        (n,) bool: it is there that they end.
    """

    length_m: Floats
    floor: NDArray[np.bool_]
    wall: NDArray[np.bool_]


@dataclass(frozen=True)
class Basin:
    """A body of water with a floor or not, a wall or not."""

    floor: Floor | None = None
    wall: Wall | None = None

    def ends(self, d_z: Floats, depth_m: float) -> Ends:
        """Where lines of sight end that go ``d_z`` (n,) metres deeper a metre from ``depth_m``."""
        with np.errstate(divide="ignore", invalid="ignore"):
            length = np.where(d_z < 0, depth_m / np.abs(d_z), np.inf)
            floor = (d_z > 0) & (self.floor is not None)
            if self.floor:
                below = max(self.floor.depth_m - depth_m, 0.0)
                length = np.where(floor, below / np.abs(d_z), length)
            wall = np.zeros_like(floor)
            if self.wall:
                distance = self.wall.distance_m / np.sqrt(1 - d_z**2)
                wall = distance < length
                length = np.minimum(length, distance)
        return Ends(length, floor & ~wall, wall)

    def radiance(
        self, ends: Ends, d_z: Floats, depth_m: float, ambient: Ambient, time_s: float
    ) -> Floats:
        """(n, 61) radiance of floor and wall at the eye, matt and lit as if they lay level."""
        length = np.where(ends.floor | ends.wall, ends.length_m, 0)[:, None]
        deep = depth_m + d_z[:, None] * length
        left = np.exp(-ambient.kd * deep - ambient.water.c * length) / np.pi
        paint = ends.floor[:, None] * self._floor_paint + ends.wall[:, None] * self._wall_paint
        return np.asarray(ambient.downwelling(0.0, time_s) * left * paint)

    @cached_property
    def _floor_paint(self) -> Floats | float:
        return reflectance(self.floor.colour) if self.floor else 0.0

    @cached_property
    def _wall_paint(self) -> Floats | float:
        return reflectance(self.wall.colour) if self.wall else 0.0
