"""LANDING_TARGET (149): where the dock is, in the axes that the receiver takes it for.

ArduPilot (``AC_PrecLand::retrieve_los_meas``, commit 01c6d5da) takes every vector for one of a
camera that looks down, whatever its frame says, and turns it by ``PLND_ORIENT``: first by
``ROTATION_PITCH_90``, (x, y, z) -> (z, y, -x), which brings it ahead, then by the orientation
itself.  Only a camera that does look down is told true FRD axes.  What is sent is the inverse.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from pymavlink.dialects.v20 import common as mavlink

from chromadock.autopilot.place import Place, dock_in_body
from chromadock.autopilot.receivers import ROVER, Receiver
from chromadock.autopilot.wire import Message
from chromadock.mounting import Mounting
from chromadock.results.track import TrackedPose
from chromadock.rotation import quaternion_from_matrix
from chromadock.track.attitude import Attitude

Floats = NDArray[np.float64]
Vector = tuple[float, float, float]

FORWARD, BACK, DOWN = 0, 4, 25
"""PLND_ORIENT: what ArduPilot calls the way the camera looks."""

R_BODY_PLND: dict[int, Floats] = {
    FORWARD: np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
    BACK: np.array([[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]]),
    DOWN: np.eye(3),
}
"""By PLND_ORIENT: what ArduPilot turns a vector by that it is told, into the body's axes."""


def plnd_orient(receiver: Receiver, mounting: Mounting) -> int:
    """The PLND_ORIENT that the autopilot must have: the way nearest to the camera's own.

    Only a Rover has the parameter; a Copter takes the camera for one that looks down.
    """
    if receiver is not ROVER:
        return DOWN
    ahead, _, down = mounting.R_body_camera[:, 2].tolist()
    if down > abs(ahead):
        return DOWN
    return FORWARD if ahead >= 0 else BACK


def landing_target(
    receiver: Receiver,
    time_s: float,
    pose: TrackedPose,
    mounting: Mounting,
    attitude: Attitude | None = None,
    position: Vector | None = None,
) -> Message | None:
    """The message about a dock that was measured at ``time_s``.

    Parameters
    ----------
    receiver : one that listens to LANDING_TARGET.
    time_s : of the frame, seconds, on the clock of all messages of the link.
    pose : ``T_camera_dock`` then.
    mounting : how the camera sits in the vehicle.
    attitude, position : the vehicle's then, of ATTITUDE with its yaw, and x, y, z metres of
        LOCAL_POSITION_NED.  Only PX4 needs them, which is told where the dock is on earth.

    Returns
    -------
    None where the receiver needs what is not known.
    """
    dock = dock_in_body(pose, mounting)
    if receiver.absolute:
        if attitude is None or attitude.yaw_rad is None or position is None:
            return None
        on_earth = dock.turned(attitude.R_world_body)
        absolute = on_earth.t + np.array(position)
        return _message(time_s, mavlink.MAV_FRAME_LOCAL_NED, absolute, on_earth, (0.0, 0.0))
    sent = R_BODY_PLND[plnd_orient(receiver, mounting)].T @ dock.t
    x, y, z = sent.tolist()
    # As the receiver would take them if x, y and z were not valid: (-tan(y), tan(x), 1).
    angles = (math.atan2(y, z), math.atan2(-x, z))
    return _message(time_s, mavlink.MAV_FRAME_BODY_FRD, sent, dock, angles)


def _message(
    time_s: float, frame: int, sent: Floats, dock: Place, angles: tuple[float, float]
) -> Message:
    x, y, z = sent.tolist()
    return mavlink.MAVLink_landing_target_message(
        time_usec=round(time_s * 1e6),
        target_num=0,
        frame=frame,
        angle_x=angles[0],
        angle_y=angles[1],
        # ArduPilot divides x, y, z by it and multiplies by it later.
        distance=float(np.linalg.norm(dock.t)),
        size_x=0.0,
        size_y=0.0,
        x=x,
        y=y,
        z=z,
        q=quaternion_from_matrix(dock.R),
        type=mavlink.LANDING_TARGET_TYPE_VISION_OTHER,
        position_valid=1,
    )
