"""Where the dock is: drawn such that the camera sees it whole."""

from __future__ import annotations

import cv2
import numpy as np

from chromadock.camera import CameraModel
from chromadock.variety.scene import Floats

TRIALS = 300
MARGIN = 12 / 640
"""Of the markers from the frame's edge, in shares of the width."""
MOUNTING_DEG = {"upright": 0.0, "side": 90.0, "upside_down": 180.0}

Range = tuple[float, float]


def rotation(pitch_deg: float, yaw_deg: float, roll_deg: float) -> Floats:
    """R_camera_dock (3, 3) of a dock turned about the camera's x, then y, then z."""
    turned = np.eye(3)
    for axis, angle in enumerate(np.radians([pitch_deg, yaw_deg, roll_deg])):
        turned = turned @ cv2.Rodrigues(np.eye(3)[axis] * angle)[0]
    return turned


def pose_in_view(
    camera: CameraModel,
    points: Floats,
    range_m: float,
    angles_deg: dict[str, Range],
    mounting: str,
    rng: np.random.Generator,
) -> tuple[Floats, Floats, Floats] | None:
    """R (3, 3), t (3,) metres and pitch, yaw, roll in degrees of a dock at z = ``range_m``.

    None if none of ``TRIALS`` has all its points in the frame.

    Parameters
    ----------
    points : (N, 3) metres, dock frame; without any, wherever its centre is in the frame.
    angles_deg : least and greatest ``pitch_deg``, ``yaw_deg``, ``roll_deg``.
    mounting : how the camera is turned about its axis.
    """
    size = np.array([camera.width, camera.height])
    margin = MARGIN * camera.width
    turn = cv2.Rodrigues(np.array([0, 0, np.radians(MOUNTING_DEG[mounting])]))[0]
    low, high = np.array([angles_deg[n] for n in ("pitch_deg", "yaw_deg", "roll_deg")]).T
    angles = rng.uniform(low, high, (TRIALS, 3))
    corner = camera.undistort([size / 2 - 0.5, np.zeros(2), size - 1.0])
    sideways = rng.uniform(corner[1], corner[2], (TRIALS, 2))
    shown = points if len(points) else np.zeros((1, 3))
    for angle, (x, y) in zip(angles, sideways, strict=True):
        R = turn @ rotation(*angle)
        t = range_m * np.array([x, y, 1.0])
        pixels = camera.project(shown @ R.T + t)
        if (pixels > margin).all() and (pixels < size - margin).all():
            return R, t, angle
    return None
