"""The dock's pose by one frame."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pose:
    """``T_camera_dock``: the dock in the camera frame (OpenCV: x right, y down, z forward).

    ``t`` in metres; ``q_wxyz`` a unit quaternion that turns dock axes into camera
    axes; ``reprojection_px`` the root mean square distance of the reprojected
    markers from the measured ones.  ``covariance``: 6 x 6 by rows, of x, y, z, metres, and of
    turns about the camera's x, y and z axes, radians, as in ROS's PoseWithCovariance; None
    where a method does not know it.  ``alternative``: the other pose that the markers leave
    open, if they do.
    """

    t: tuple[float, float, float]
    q_wxyz: tuple[float, float, float, float]
    reprojection_px: float
    alternative: Pose | None = None
    covariance: tuple[float, ...] | None = None
