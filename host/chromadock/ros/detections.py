"""What was seen in the picture: the dock and its markers, as boxes."""

from __future__ import annotations

from collections.abc import Sequence

from chromadock.results.detection import Blob, Detection, Point
from chromadock.results.pose import Pose
from chromadock.ros.fields import Fields
from chromadock.ros.header import CAMERA_FRAME, DOCK_FRAME, header
from chromadock.ros.pose import pose_with_covariance

MARKER = "marker"


def detections(detection: Detection, stamp_ns: int, frame_id: str = CAMERA_FRAME) -> Fields:
    """``vision_msgs/Detection2DArray``: the dock and each of its markers; empty without them.

    The dock has the class ``dock``, the box about its markers and, where this frame alone gives
    one, its pose; a marker has the class ``marker``, its name as ``id`` and the box about its
    blob.  The score is 1 for a dock that was found, 0.5 for one that is uncertain or partial.
    """
    head = header(stamp_ns, frame_id)
    markers = detection.markers or {}
    score = 1.0 if detection.found else 0.5
    found = []
    if markers:
        found.append(_dock(list(markers.values()), detection.pose, score, head))
    for name, point in markers.items():
        side = 2 * _radius(point, detection.blobs)
        found.append(_one(MARKER, name, score, None, point, (side, side), head))
    return {"header": head, "detections": found}


def _dock(points: Sequence[Point], pose: Pose | None, score: float, head: Fields) -> Fields:
    xs, ys = zip(*points, strict=True)
    centre = ((min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2)
    size = (max(xs) - min(xs), max(ys) - min(ys))
    return _one(DOCK_FRAME, DOCK_FRAME, score, pose, centre, size, head)


def _one(
    class_id: str,
    name: str,
    score: float,
    pose: Pose | None,
    centre: Point,
    size: Point,
    head: Fields,
) -> Fields:
    return {
        "header": head,
        "results": [
            {
                "hypothesis": {"class_id": class_id, "score": score},
                "pose": pose_with_covariance(pose),
            }
        ],
        "bbox": {
            "center": {"position": {"x": centre[0], "y": centre[1]}, "theta": 0.0},
            "size_x": size[0],
            "size_y": size[1],
        },
        "id": name,
    }


def _radius(point: Point, blobs: Sequence[Blob]) -> float:
    """Of the blob about a marker's place; 0 where there is none."""
    return max(
        (
            blob.radius
            for blob in blobs
            if (blob.x - point[0]) ** 2 + (blob.y - point[1]) ** 2 <= blob.radius**2
        ),
        default=0.0,
    )
