"""What the vehicle knows of its own attitude, in the camera's axes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.errors import ChromadockError
from chromadock.mounting import R_BODY_CAMERA_FORWARD, Mounting, mounting_or_default
from chromadock.robust.weigh.shape import ATTITUDE_RAD

Floats = NDArray[np.float64]

LEVEL_RAD = 0.06
"""Error of the dock's pitch and roll as the vehicle's attitude has them, for a dock that should be
level: 3.4 degrees of bobbing, of mounting and of the IMU together."""


@dataclass(frozen=True, slots=True)
class Attitude:
    """The vehicle's attitude when a frame was taken, as MAVLink's ATTITUDE has it.

    Radians, of the body (FRD: x forward, y right, z down) in north, east, down: ``yaw_rad``
    about down, then ``pitch_rad`` about right, then ``roll_rad`` about forward.  ``yaw_rad``
    may be None; from any origin it does, since only its changes are used.

    Raises
    ------
    ChromadockError
        For a number that is not finite, or a roll or pitch beyond a full turn, which must be in
        degrees.
    """

    roll_rad: float
    pitch_rad: float
    yaw_rad: float | None = None

    def __post_init__(self) -> None:
        given = (self.roll_rad, self.pitch_rad, self.yaw_rad or 0.0)
        if not all(math.isfinite(angle) for angle in given):
            raise ChromadockError(
                f"attitude {given}: roll, pitch and yaw must be finite, in radians; "
                "leave the attitude out where it is not known"
            )
        if max(abs(self.roll_rad), abs(self.pitch_rad)) > 2 * math.pi:
            raise ChromadockError(
                f"attitude {given}: a roll or pitch of more than a full turn; "
                "give radians, not degrees"
            )

    @property
    def R_world_body(self) -> Floats:
        """(3, 3), world: north, east, down; an unknown yaw is taken for 0."""
        roll, pitch, yaw = self.roll_rad, self.pitch_rad, self.yaw_rad or 0.0
        about_z, about_y, about_x = (
            np.asarray(cv2.Rodrigues(np.array(turn))[0])
            for turn in ((0.0, 0.0, yaw), (0.0, pitch, 0.0), (roll, 0.0, 0.0))
        )
        return np.asarray(about_z @ about_y @ about_x, np.float64)

    def turn_since(self, earlier: Attitude, R_body_camera: Floats) -> Floats | None:
        """(3,) rotation vector of the camera since then, radians, in its own axes.

        None where either has no yaw.
        """
        if self.yaw_rad is None or earlier.yaw_rad is None:
            return None
        R_then_now = (earlier.R_world_body @ R_body_camera).T @ self.R_world_body @ R_body_camera
        return np.asarray(cv2.Rodrigues(R_then_now)[0], np.float64).ravel()


def attitude_of(R_world_body: Floats) -> Attitude:
    """Roll, pitch and yaw, radians, of a rotation: the inverse of ``Attitude.R_world_body``."""
    R = R_world_body
    return Attitude(
        math.atan2(R[2, 1], R[2, 2]),
        math.asin(max(-1.0, min(1.0, -float(R[2, 0])))),
        math.atan2(R[1, 0], R[0, 0]),
    )


def expected(attitude: Attitude | None, mounting: Mounting) -> tuple[Floats, Floats]:
    """How a vehicle that faces the dock sees it turned: ``R_camera_dock`` (3, 3), and the (3, 3)
    covariance, radians squared, of small turns from there about the camera's axes.

    Without an attitude the vehicle swims about level.  Its heading against the dock's axis is
    known to no better than robust/shape.py's ATTITUDE_RAD in either case, as the search takes it.
    """
    pitch, yaw, roll = ATTITUDE_RAD.tolist()
    tilt = LEVEL_RAD
    if attitude is None:
        attitude, tilt = Attitude(0.0, 0.0), max(pitch, roll)
    R_level_body = Attitude(attitude.roll_rad, attitude.pitch_rad).R_world_body
    R_camera_level = (R_level_body @ mounting.R_body_camera).T
    down = R_camera_level[:, 2]
    about_down = np.outer(down, down)
    covariance = tilt**2 * (np.eye(3) - about_down) + yaw**2 * about_down
    return R_camera_level @ R_BODY_CAMERA_FORWARD @ mounting.R_level_dock, covariance


def expected_if_told(
    attitude: Attitude | None, mounting: Mounting | None
) -> tuple[Floats | None, Floats | None]:
    """``expected``, for a search; None, None where the user told neither attitude nor mounting:
    the search then takes the camera for upright."""
    if attitude is None and mounting is None:
        return None, None
    return expected(attitude, mounting_or_default(mounting))
