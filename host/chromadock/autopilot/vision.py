"""The vehicle's own position by the dock: VISION_POSITION_ESTIMATE (102) and ODOMETRY (331).

Both are of the vehicle in axes north, east, down whose origin is the dock.  North is by the
autopilot's own compass: the camera knows nothing of it.  ArduPilot is given back the roll, pitch
and yaw that it told itself, with a variance by which nothing is to be learnt from them.  PX4 is
given none: as it is delivered (``EKF2_EV_CTRL`` 15) it would take that yaw in place of its
compass's and so hold on to its own; where the attitude is not a number it takes the place alone
(``EKF2::UpdateExtVisionSample``).
"""

from __future__ import annotations

import math

from pymavlink.dialects.v20 import common as mavlink

from chromadock.autopilot.place import dock_in_body, place_covariance, upper_triangle
from chromadock.autopilot.receivers import Receiver
from chromadock.autopilot.wire import Message
from chromadock.mounting import Mounting
from chromadock.results.track import TrackedPose
from chromadock.track.attitude import Attitude

_NAN = math.nan


def vision_message(
    receiver: Receiver,
    time_s: float,
    pose: TrackedPose,
    mounting: Mounting,
    attitude: Attitude,
    reset_counter: int,
) -> Message:
    """Where the vehicle was at ``time_s``, in the message that ``receiver`` reads.

    Parameters
    ----------
    time_s : of the frame, seconds, on the clock of all messages of the link.
    pose : ``T_camera_dock`` then.
    mounting : how the camera sits in the vehicle.
    attitude : the vehicle's then, by its own ATTITUDE, with its yaw.
    reset_counter : 0..255, another one whenever the position may jump.
    """
    R_ned_body = attitude.R_world_body
    x, y, z = (-(R_ned_body @ dock_in_body(pose, mounting).t)).tolist()
    covariance = upper_triangle(place_covariance(pose, R_ned_body @ mounting.R_body_camera))
    if receiver.vision == "VISION_POSITION_ESTIMATE":
        return mavlink.MAVLink_vision_position_estimate_message(
            usec=round(time_s * 1e6),
            x=x,
            y=y,
            z=z,
            roll=attitude.roll_rad,
            pitch=attitude.pitch_rad,
            yaw=attitude.yaw_rad,
            covariance=covariance,
            reset_counter=reset_counter,
        )
    return mavlink.MAVLink_odometry_message(
        time_usec=round(time_s * 1e6),
        frame_id=mavlink.MAV_FRAME_LOCAL_NED,
        child_frame_id=mavlink.MAV_FRAME_BODY_FRD,
        x=x,
        y=y,
        z=z,
        q=[_NAN] * 4,
        # The track's velocity comes of the same places: told too, it would count twice.
        vx=_NAN,
        vy=_NAN,
        vz=_NAN,
        rollspeed=_NAN,
        pitchspeed=_NAN,
        yawspeed=_NAN,
        pose_covariance=covariance,
        velocity_covariance=[_NAN] * 21,
        reset_counter=reset_counter,
        estimator_type=mavlink.MAV_ESTIMATOR_TYPE_VISION,
        # 0 is unknown, 1 worst, 100 best.
        quality=max(1, round(100 * min(pose.weight, 1.0))),
    )
