"""The dock in the vehicle's own axes and in those of the earth.

Frames: ``camera`` (OpenCV: x right, y down, z forward); ``body`` (FRD: x forward, y right, z down);
``ned`` (north, east, down).  Only the directions of the camera are known (``Mounting``), not its
place in the vehicle: the origin of ``body`` is the camera here.  An autopilot that should know
better has parameters for it (docs/autopilot.md).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.mounting import R_BODY_CAMERA_FORWARD, Mounting
from chromadock.results.track import TrackedPose
from chromadock.rotation import UNKNOWN_ANGLE, matrix_from_quaternion

Floats = NDArray[np.float64]

ATTITUDE_ERROR_RAD = 0.02
"""Error of the vehicle's attitude at a frame's time, of the mounting, and of the time itself: one
degree together.  At 5 m it is 0.1 m of place, more than the camera's own error."""


@dataclass(frozen=True, eq=False, slots=True)
class Place:
    """``t`` (3,) metres and ``R`` (3, 3): a dock in some axes.

    Of the dock the axes are taken as those of a vehicle that lies in it, forward, right and down as
    it comes in: with ``R`` the identity the vehicle faces the dock squarely.
    """

    t: Floats
    R: Floats

    def turned(self, R: Floats) -> Place:
        """In the axes that ``R`` (3, 3) turns these into."""
        return Place(R @ self.t, R @ self.R)


def dock_in_body(pose: TrackedPose, mounting: Mounting) -> Place:
    """``T_body_dock`` of ``T_camera_dock``, the camera's place being the origin."""
    R_camera_dock = matrix_from_quaternion(pose.q_wxyz)
    seen = Place(np.array(pose.t), R_camera_dock @ R_BODY_CAMERA_FORWARD.T)
    return seen.turned(mounting.R_body_camera)


def place_covariance(pose: TrackedPose, R_ned_camera: Floats) -> Floats:
    """(3, 3) metres squared, of the dock against the vehicle in the axes north, east, down.

    That of the track, turned, and what the vehicle's attitude adds: a small turn w of the whole
    moves a place t by w x t.
    """
    tracked = np.reshape(pose.covariance, (6, 6))[:3, :3]
    t = R_ned_camera @ np.array(pose.t)
    sideways = float(t @ t) * np.eye(3) - np.outer(t, t)
    turned = R_ned_camera @ tracked @ R_ned_camera.T
    return np.asarray(turned + ATTITUDE_ERROR_RAD**2 * sideways, np.float64)


def upper_triangle(places: Floats) -> list[float]:
    """The 21 numbers of a pose's covariance in MAVLink: upper triangle by rows, of x, y, z, roll,
    pitch, yaw; from the (3, 3) covariance of the place, and angles that say nothing: they are the
    receiver's own, given back, and whoever weighs them so takes nothing from them."""
    whole = np.diag([0.0, 0.0, 0.0, UNKNOWN_ANGLE, UNKNOWN_ANGLE, UNKNOWN_ANGLE])
    whole[:3, :3] = places
    return [float(value) for value in whole[np.triu_indices(6)]]
