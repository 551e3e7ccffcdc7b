"""Rigid transforms between frames; ``T_a_b`` takes points of frame b to frame a."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Transform:
    """``p_a = R @ p_b + t``: rotation (3, 3) and translation (3,) in metres."""

    R: Floats
    t: Floats

    def __matmul__(self, other: Transform) -> Transform:
        """``T_a_b @ T_b_c`` is ``T_a_c``."""
        return Transform(self.R @ other.R, self.R @ other.t + self.t)

    def inverse(self) -> Transform:
        """``T_b_a``."""
        return Transform(self.R.T, -self.R.T @ self.t)

    def points(self, points_b: ArrayLike) -> Floats:
        """(..., 3) points of frame b in frame a."""
        return np.asarray(np.asarray(points_b, np.float64) @ self.R.T + self.t)

    def directions(self, directions_b: ArrayLike) -> Floats:
        """(..., 3) vectors of frame b in frame a."""
        return np.asarray(np.asarray(directions_b, np.float64) @ self.R.T)


def turned(yaw_deg: float, pitch_deg: float, roll_deg: float) -> Floats:
    """(3, 3) rotation of a body with x right, y down, z forward: yaw, then pitch, then roll.

    Each is about the axes that the ones before have turned.  Positive yaw turns the nose
    right, positive pitch lifts it, positive roll lowers the right side.
    """
    yaw, pitch, roll = (math.radians(angle) for angle in (yaw_deg, pitch_deg, roll_deg))
    cy, sy = math.cos(yaw), math.sin(yaw)
    cp, sp = math.cos(pitch), math.sin(pitch)
    cr, sr = math.cos(roll), math.sin(roll)
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_x = np.array([[1, 0, 0], [0, cp, -sp], [0, sp, cp]])
    about_z = np.array([[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]])
    return np.asarray(about_y @ about_x @ about_z)


def level(heading_deg: float) -> Floats:
    """(3, 3) ``R_world_body`` of a level body (x right, y down, z forward) on a heading.

    World: x north, y east, z down.  Heading 0 looks north, 90 east.
    """
    heading = math.radians(heading_deg)
    north, east = math.cos(heading), math.sin(heading)
    return np.array([[-east, 0, north], [north, 0, east], [0, 1, 0]])


def looking(direction: ArrayLike) -> Floats:
    """(3, 3) rotation that takes z to a direction with x kept level; both in a frame with y down.

    ``direction`` is (3,), of any length, and not vertical.
    """
    x, y, z = np.asarray(direction, np.float64).tolist()
    across = math.hypot(x, z)
    length = math.hypot(across, y)
    return np.array(
        [
            [z / across, -x * y / (across * length), x / length],
            [0.0, across / length, y / length],
            [-x / across, -y * z / (across * length), z / length],
        ]
    )
