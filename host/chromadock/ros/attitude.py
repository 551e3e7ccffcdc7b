"""The vehicle's attitude as ROS has it, and back."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock.ros.fields import Fields
from chromadock.ros.header import VEHICLE_FRAME, header
from chromadock.ros.pose import quaternion, xyz
from chromadock.rotation import UNKNOWN_ANGLE, matrix_from_quaternion, quaternion_from_matrix
from chromadock.track.attitude import Attitude, attitude_of

R_ENU_NED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
"""The axes north, east, down in those of REP 103: east, north, up."""
R_FRD_FLU = np.diag([1.0, -1.0, -1.0])
"""The axes forward, left, up in those of MAVLink's body: forward, right, down."""

NOT_MEASURED = -1.0
"""First element of the covariance of what an Imu does not tell, by sensor_msgs/Imu."""
_NOT_MEASURED = [NOT_MEASURED] + [0.0] * 8
_UNKNOWN_YAW = [0.0] * 8 + [UNKNOWN_ANGLE]
_UNKNOWN = [0.0] * 9


def imu(attitude: Attitude, stamp_ns: int) -> Fields:
    """``sensor_msgs/Imu`` with the orientation alone: of ``base_link`` in east, north, up.

    Parameters
    ----------
    attitude : without yaw it is taken for 0, and has the variance of an angle that may be any.
    stamp_ns : of the frame at whose time the vehicle had it, Unix nanoseconds.
    """
    R_enu_flu = R_ENU_NED @ attitude.R_world_body @ R_FRD_FLU
    return {
        "header": header(stamp_ns, VEHICLE_FRAME),
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
    found = attitude_of(rotation_of(message))
    if message.orientation_covariance[8] < UNKNOWN_ANGLE:
        return found
    return Attitude(found.roll_rad, found.pitch_rad)


def rotation_of(message: Any) -> NDArray[np.float64]:
    """``R_ned_frd`` (3, 3), from the orientation of a ``sensor_msgs/Imu`` by REP 103.

    Raises
    ------
    ChromadockError
        Where its quaternion is none.
    """
    q = message.orientation
    R_enu_flu = matrix_from_quaternion((q.w, q.x, q.y, q.z))
    return np.asarray(R_ENU_NED.T @ R_enu_flu @ R_FRD_FLU.T, np.float64)
