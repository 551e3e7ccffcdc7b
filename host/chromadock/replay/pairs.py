"""The same frame before and now."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from chromadock.results.detection import Detection
from chromadock.results.pose import Pose
from chromadock.results.track import TrackedPose


@dataclass(frozen=True)
class Pair:
    """Results of one frame: ``old`` recorded (None where that is missing), ``new`` of the
    replay."""

    old: Detection | None
    new: Detection


def locked(detection: Detection | None) -> bool:
    """Whether the track tracks the dock."""
    return (
        detection is not None
        and detection.track is not None
        and detection.track.state == "tracking"
    )


def pose_of(detection: Detection | None) -> TrackedPose | Pose | None:
    """The track's pose while it tracks; where there is no track, the frame's own."""
    if detection is None:
        return None
    if detection.track is None:
        return detection.pose
    return detection.track.pose if locked(detection) else None


def place_difference_m(pair: Pair) -> float | None:
    """How far apart both poses are, metres; None unless there are both."""
    old, new = pose_of(pair.old), pose_of(pair.new)
    if old is None or new is None:
        return None
    return float(np.linalg.norm(np.subtract(new.t, old.t)))


def attitude_difference_deg(pair: Pair) -> float | None:
    """The angle of the turn from one pose to the other, degrees, 0..180; None likewise."""
    old, new = pose_of(pair.old), pose_of(pair.new)
    if old is None or new is None:
        return None
    # Of the turn's quaternion: the cosine alone loses small angles to rounding.
    same = abs(float(np.dot(old.q_wxyz, new.q_wxyz)))
    w, axis = np.asarray(old.q_wxyz)[0], np.asarray(old.q_wxyz)[1:]
    v, other = np.asarray(new.q_wxyz)[0], np.asarray(new.q_wxyz)[1:]
    sine = float(np.linalg.norm(w * other - v * axis - np.cross(axis, other)))
    return math.degrees(2 * math.atan2(sine, same))
