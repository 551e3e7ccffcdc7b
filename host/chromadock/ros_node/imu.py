"""The vehicle's attitude when a picture was taken, from an IMU's orientations."""

from __future__ import annotations

from typing import Any

import numpy as np

from chromadock.autopilot.history import AttitudeSample, History
from chromadock.errors import ChromadockError
from chromadock.ros.attitude import NOT_MEASURED, R_FRD_FLU, rotation_of
from chromadock.ros.header import stamp_ns_of
from chromadock.stamps import BACK_S
from chromadock.track.attitude import Attitude, attitude_of


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
        if message.orientation_covariance[0] == NOT_MEASURED:
            return
        try:
            R_ned_frd = rotation_of(message)
        except ChromadockError:
            return
        rates = message.angular_velocity
        known = message.angular_velocity_covariance[0] != NOT_MEASURED
        rates_flu = np.array([rates.x, rates.y, rates.z]) if known else np.zeros(3)
        stamp_s = stamp_ns_of(message) / 1e9
        if stamp_s < self._newest_s - BACK_S:
            self._history.clear()
        self._newest_s = stamp_s
        self._history.add(stamp_s, AttitudeSample(R_ned_frd, R_FRD_FLU @ rates_flu))

    def at(self, stamp_ns: int) -> Attitude | None:
        """At the time of a picture, nanoseconds; None where nothing near it was heard."""
        sample = self._history.at(stamp_ns / 1e9)
        return None if sample is None else attitude_of(sample.R)
