"""The vehicle's attitude as ROS has it, and back."""

from __future__ import annotations

from typing import Any

import numpy as np

from chromadock.ros.fields import Fields
from chromadock.ros.header import VEHICLE_FRAME, header
from chromadock.ros.pose import quaternion, xyz
from chromadock.rotation import UNKNOWN_ANGLE, matrix_from_quaternion, quaternion_from_matrix
from chromadock.track.attitude import Attitude, attitude_of

_R_ENU_NED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
"""The axes north, east, down in those of REP 103: east, north, up."""
_R_FRD_FLU = np.diag([1.0, -1.0, -1.0])
"""The axes forward, left, up in those of MAVLink's body: forward, right, down."""

_NOT_MEASURED = [-1.0] + [0.0] * 8
"""The covariance with which sensor_msgs/Imu says that a quantity is not there."""
_UNKNOWN_YAW = [0.0] * 8 + [UNKNOWN_ANGLE]
_UNKNOWN = [0.0] * 9


def imu(attitude: Attitude, stamp_ns: int) -> Fields:
    """``sensor_msgs/Imu`` with the orientation alone: of ``base_link`` in east, north, up.

    Parameters
    ----------
    attitude : without yaw it is taken for 0, and has the variance of an angle that may be any.
    stamp_ns : of the frame at whose time the vehicle had it, Unix nanoseconds.
    """
    R_enu_flu = _R_ENU_NED @ attitude.R_world_body @ _R_FRD_FLU
    return {
        "header": {**header(stamp_ns), "frame_id": VEHICLE_FRAME},
        "orientation": quaternion(quaternion_from_matrix(R_enu_flu)),
        "orientation_covariance": _UNKNOWN_YAW if attitude.yaw_rad is None else _UNKNOWN,
        "angular_velocity": xyz((0.0, 0.0, 0.0)),
        "angular_velocity_covariance": _NOT_MEASURED,
        "linear_acceleration": xyz((0.0, 0.0, 0.0)),
        "linear_acceleration_covariance": _NOT_MEASURED,
    }


def attitude_from_imu(message: Any) -> Attitude:
    """The attitude that ``imu`` wrote.

    Parameters
    ----------
    message : a ``sensor_msgs/Imu``, its fields as attributes.

    Raises
    ------
    ChromadockError
        Where its orientation is none.
    """
    q = message.orientation
    R_enu_flu = matrix_from_quaternion((q.w, q.x, q.y, q.z))
    found = attitude_of(_R_ENU_NED.T @ R_enu_flu @ _R_FRD_FLU.T)
    if message.orientation_covariance[8] < UNKNOWN_ANGLE:
        return found
    return Attitude(found.roll_rad, found.pitch_rad)
