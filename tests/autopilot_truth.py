"""Tracks with known places, for tests of the output to an autopilot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np

from chromadock import Mounting, Track
from chromadock.results.detection import Background, Detection, Marker
from chromadock.results.track import TrackedPose
from chromadock.rotation import quaternion_from_matrix

AHEAD = Mounting()
BEHIND = Mounting(np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))
"""Looks back: its right is the vehicle's left."""
BELOW = Mounting(np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
"""Looks down: the top of its picture is ahead."""


def turned(roll_deg: float, pitch_deg: float, yaw_deg: float) -> np.ndarray:
    """Body to north, east, down, by yaw, pitch, roll."""
    R = np.eye(3)
    for axis, angle in ((2, yaw_deg), (1, pitch_deg), (0, roll_deg)):
        R = R @ cv2.Rodrigues(np.eye(3)[axis] * np.radians(angle))[0]
    return R


def pose_at(
    body: Sequence[float],
    mounting: Mounting = AHEAD,
    R_camera_dock: np.ndarray | None = None,
    covariance: np.ndarray | None = None,
    weight: float = 0.9,
) -> TrackedPose:
    """Of a dock that is at ``body`` (forward, right, down), as the camera sees it."""
    x, y, z = (mounting.R_body_camera.T @ np.array(body, float)).tolist()
    R = np.eye(3) if R_camera_dock is None else R_camera_dock
    C = 1e-4 * np.eye(6) if covariance is None else covariance
    return TrackedPose((x, y, z), quaternion_from_matrix(R), tuple(C.ravel().tolist()), weight)


def tracked(time_s: float, pose: TrackedPose, **changes: object) -> Track:
    """Measured in the frame of ``time_s``, at rest."""
    still = Track("tracking", time_s, pose, None, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0)
    return replace(still, **changes)  # type: ignore[arg-type]


def detection(track: Track | None) -> Detection:
    """What a detector says of a frame, as far as the output reads it."""
    water = Background((0, 0, 0), None, 0.0)
    return Detection("found", water, Marker(None, None), None, 0.0, track=track)
