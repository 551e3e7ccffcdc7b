"""Where the dock is: as a pose with covariance, and as a transform."""

from __future__ import annotations

from collections.abc import Sequence

from chromadock.results.detection import Detection
from chromadock.results.pose import Pose
from chromadock.results.track import TrackedPose
from chromadock.ros.fields import Fields
from chromadock.ros.header import CAMERA_FRAME, DOCK_FRAME, header

_NOWHERE = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), None)


def tracked_pose(detection: Detection) -> TrackedPose | None:
    """``T_camera_dock`` of the track while it tracks, None otherwise: what is only remembered
    is for no one to steer by."""
    track = detection.track
    return None if track is None or track.state != "tracking" else track.pose


def pose_with_covariance(pose: TrackedPose | Pose | None) -> Fields:
    """``geometry_msgs/PoseWithCovariance``: 6 x 6 by rows, metres and radians, fixed axes.

    All 0, with no turn, for None: a message cannot leave it out.
    """
    t, q_wxyz, covariance = _NOWHERE if pose is None else (pose.t, pose.q_wxyz, pose.covariance)
    return {
        "pose": {"position": xyz(t), "orientation": quaternion(q_wxyz)},
        "covariance": list(covariance or [0.0] * 36),
    }


def pose_stamped(pose: TrackedPose, stamp_ns: int) -> Fields:
    """``geometry_msgs/PoseWithCovarianceStamped``."""
    return {"header": header(stamp_ns), "pose": pose_with_covariance(pose)}


def transforms(pose: TrackedPose, stamp_ns: int) -> Fields:
    """``tf2_msgs/TFMessage`` from the camera's frame to the dock's."""
    return {
        "transforms": [
            {
                "header": {**header(stamp_ns), "frame_id": CAMERA_FRAME},
                "child_frame_id": DOCK_FRAME,
                "transform": {"translation": xyz(pose.t), "rotation": quaternion(pose.q_wxyz)},
            }
        ]
    }


def xyz(t: Sequence[float]) -> Fields:
    """``geometry_msgs/Point`` or ``Vector3``."""
    return dict(zip("xyz", t, strict=True))


def quaternion(q_wxyz: Sequence[float]) -> Fields:
    """``geometry_msgs/Quaternion``; ROS keeps w last; by name it does not matter."""
    return dict(zip("wxyz", q_wxyz, strict=True))
