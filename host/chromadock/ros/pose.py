"""Where the dock is: as a pose with covariance, and as a transform."""

from __future__ import annotations

from collections.abc import Sequence

from chromadock.results.detection import Detection
from chromadock.results.pose import Pose
from chromadock.results.track import TrackedPose
from chromadock.ros.fields import Fields
from chromadock.ros.header import FRAME_IDS, FrameIds, header

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


def pose_stamped(pose: TrackedPose, stamp_ns: int, ids: FrameIds = FRAME_IDS) -> Fields:
    """``geometry_msgs/PoseWithCovarianceStamped``: the dock's own axes in the camera's frame."""
    return {"header": header(stamp_ns, ids.camera), "pose": pose_with_covariance(pose)}


def dock_pose_for_nav2(pose: TrackedPose, stamp_ns: int, ids: FrameIds = FRAME_IDS) -> Fields:
    """``geometry_msgs/PoseStamped`` of the dock as Nav2's docking server wants it detected.

    Nav2 drives along +x of its dock, into it.  Its SimpleChargingDock gets that from a detected
    pose by ``external_detection_rotation_*``, whose defaults (roll -90, pitch 90, yaw 0 degrees)
    make +x of -z: they are for a printed tag, x right, y up, z towards whoever looks at it.  The
    dock's own axes (x right, y down, z away) are those after half a turn about x, so the pose is
    told after that half turn and the defaults hold.
    """
    w, x, y, z = pose.q_wxyz
    half_turned = (-x, w, z, -y)  # the quaternion times (0, 1, 0, 0)
    return {
        "header": header(stamp_ns, ids.camera),
        "pose": {"position": xyz(pose.t), "orientation": quaternion(half_turned)},
    }


def transforms(pose: TrackedPose, stamp_ns: int, ids: FrameIds = FRAME_IDS) -> Fields:
    """``tf2_msgs/TFMessage`` from the camera's frame to the dock's."""
    return {
        "transforms": [
            {
                "header": header(stamp_ns, ids.camera),
                "child_frame_id": ids.dock,
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
