"""The vehicle's attitude when a picture was taken, from an IMU's orientations."""

from __future__ import annotations

from typing import Any

import numpy as np

from chromadock.autopilot.history import AttitudeSample, History
from chromadock.autopilot.place import attitude_of
from chromadock.errors import ChromadockError
from chromadock.ros.header import stamp_ns_of
from chromadock.rotation import matrix_from_quaternion
from chromadock.stamps import BACK_S
from chromadock.track.attitude import Attitude

R_NED_ENU = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
"""East, north, up (REP 103) in north, east, down."""

R_FRD_FLU = np.diag([1.0, -1.0, -1.0])
"""Forward, left, up (REP 103) in forward, right, down."""

_UNKNOWN = -1.0
"""First element of the covariance of what an IMU does not tell, by sensor_msgs/Imu."""


class Attitudes:
    """The newest orientations, by ROS's clock."""

    def __init__(self) -> None:
        self._history: History[AttitudeSample] = History()
        self._newest_s = -np.inf

    def heard(self, message: Any) -> None:
        """Take in a ``sensor_msgs/Imu`` of an IMU whose axes are the vehicle's (forward, left, up).

        One without an orientation, or whose quaternion is none, tells nothing.  Where stamps go
        back, as when a bag begins again, what was heard before is forgotten.
        """
        if message.orientation_covariance[0] == _UNKNOWN:
            return
        q, rates = message.orientation, message.angular_velocity
        try:
            R_enu_flu = matrix_from_quaternion((q.w, q.x, q.y, q.z))
        except ChromadockError:
            return
        known = message.angular_velocity_covariance[0] != _UNKNOWN
        rates_flu = np.array([rates.x, rates.y, rates.z]) if known else np.zeros(3)
        stamp_s = stamp_ns_of(message) / 1e9
        if stamp_s < self._newest_s - BACK_S:
            self._history.clear()
        self._newest_s = stamp_s
        R_ned_frd = R_NED_ENU @ R_enu_flu @ R_FRD_FLU
        self._history.add(stamp_s, AttitudeSample(R_ned_frd, R_FRD_FLU @ rates_flu))

    def at(self, stamp_ns: int) -> Attitude | None:
        """At the time of a picture, nanoseconds; None where nothing near it was heard."""
        sample = self._history.at(stamp_ns / 1e9)
        return None if sample is None else attitude_of(sample.R)
