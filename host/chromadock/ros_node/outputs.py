"""Which message of a picture goes to which topic of the node."""

from __future__ import annotations

from collections.abc import Iterator

from chromadock.results.detection import Detection
from chromadock.ros.detections import detections
from chromadock.ros.fields import Fields
from chromadock.ros.header import FrameIds
from chromadock.ros.pose import dock_pose_for_nav2, pose_stamped, tracked_pose, transforms

POSE = "~/pose"
DETECTIONS = "~/detections"
NAV2_POSE = "detected_dock_pose"
DIAGNOSTICS = "/diagnostics"
TF = "/tf"

KINDS = {
    POSE: "geometry_msgs/msg/PoseWithCovarianceStamped",
    NAV2_POSE: "geometry_msgs/msg/PoseStamped",
    TF: "tf2_msgs/msg/TFMessage",
    DETECTIONS: "vision_msgs/msg/Detection2DArray",
    DIAGNOSTICS: "diagnostic_msgs/msg/DiagnosticArray",
}
"""Each topic's type."""


def outputs(detection: Detection, stamp_ns: int, ids: FrameIds) -> Iterator[tuple[str, Fields]]:
    """Topic and fields of every message of one picture, all with its stamp.

    Poses are told of a dock that is tracked and was measured in this very picture: what a track
    only expects is for whoever steers to work out, who knows how the vehicle moves.
    """
    yield DETECTIONS, detections(detection, stamp_ns, ids.camera)
    pose, track = tracked_pose(detection), detection.track
    if pose is not None and track is not None and track.age_s == 0:
        yield POSE, pose_stamped(pose, stamp_ns, ids)
        yield NAV2_POSE, dock_pose_for_nav2(pose, stamp_ns, ids)
        yield TF, transforms(pose, stamp_ns, ids)
