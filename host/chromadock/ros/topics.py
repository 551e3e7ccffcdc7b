"""Which message of a frame goes to which topic."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.results.detection import Detection
from chromadock.ros.attitude import imu
from chromadock.ros.detections import detections
from chromadock.ros.diagnostics import diagnostics
from chromadock.ros.fields import Fields
from chromadock.ros.image import camera_info, compressed_image
from chromadock.ros.pose import pose_stamped, tracked_pose, transforms
from chromadock.track.attitude import Attitude

IMAGE = "/chromadock/image"
CAMERA_INFO = "/chromadock/camera_info"
ATTITUDE = "/chromadock/attitude"
POSE = "/chromadock/pose"
DETECTIONS = "/chromadock/detections"
RECORD = "/chromadock/detection"
DIAGNOSTICS = "/diagnostics"
TF = "/tf"

TOPICS = {
    IMAGE: "sensor_msgs/msg/CompressedImage",
    CAMERA_INFO: "sensor_msgs/msg/CameraInfo",
    ATTITUDE: "sensor_msgs/msg/Imu",
    POSE: "geometry_msgs/msg/PoseWithCovarianceStamped",
    DETECTIONS: "vision_msgs/msg/Detection2DArray",
    RECORD: "std_msgs/msg/String",
    DIAGNOSTICS: "diagnostic_msgs/msg/DiagnosticArray",
    TF: "tf2_msgs/msg/TFMessage",
}
"""Each topic's type."""

METADATA = "chromadock"
"""Name of the record of metadata in a recording, which has ``START``."""
START = "start_unix_ns"
"""Unix nanoseconds at which ``Frame.time_s`` was 0."""


def start_of(metadata: Mapping[str, Mapping[str, str]]) -> int | None:
    """The same of a file's metadata, by the names of its records; None where Chromadock has not
    recorded it."""
    said = metadata.get(METADATA, {}).get(START, "")
    return int(said) if said.removeprefix("-").isdecimal() else None


def messages(
    image: NDArray[np.uint8],
    attitude: Attitude | None,
    detection: Detection,
    line: str,
    age_s: float | None,
    stamp_ns: int,
    camera: CameraModel | None,
    dropped: int,
) -> Iterator[tuple[str, Fields]]:
    """Topic and fields of every message of one frame.

    Parameters
    ----------
    image : HxWx3 uint8 BGR.
    attitude : the vehicle's when the frame was taken; None where nobody told it.
    line : the result as JSON.
    age_s : the picture's when its result was out, seconds; None of a recording.
    stamp_ns : when the frame was taken, Unix nanoseconds: in all headers.
    camera : calibrated; None for a usual lens.
    dropped : see ``diagnostics``.
    """
    height, width = image.shape[:2]
    used = camera or CameraModel.nominal(width, height)
    if attitude is not None:  # before the picture: what a kill leaves of a frame has both
        yield ATTITUDE, imu(attitude, stamp_ns)
    yield IMAGE, compressed_image(image, stamp_ns)
    yield CAMERA_INFO, camera_info(used, stamp_ns)
    yield RECORD, {"data": line}
    yield DETECTIONS, detections(detection, stamp_ns)
    yield DIAGNOSTICS, diagnostics(detection, age_s, dropped, stamp_ns)
    pose = tracked_pose(detection)
    if pose is not None:
        yield POSE, pose_stamped(pose, stamp_ns)
        yield TF, transforms(pose, stamp_ns)
