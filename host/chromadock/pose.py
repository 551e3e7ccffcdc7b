"""The dock's pose from its markers' pixels."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.detection import Pose
from chromadock.rotation import quaternion_from_matrix


def epnp(
    points_dock: NDArray[np.float64], pixels: NDArray[np.float64], camera: CameraModel
) -> Pose | None:
    """``T_camera_dock`` by EPnP (Lepetit, Moreno-Noguer, Fua, IJCV 2009).

    Parameters
    ----------
    points_dock : (N, 3) float64, metres, dock frame; N >= 4.
    pixels : (N, 2) float64, the same markers in the image.

    Returns
    -------
    The pose, or None where there is none in front of the camera.
    """
    rays = camera.undistort(pixels)
    solved, rotation, translation = cv2.solvePnP(
        points_dock, rays, np.eye(3), None, flags=cv2.SOLVEPNP_EPNP
    )
    if not solved or not (np.isfinite(rotation).all() and np.isfinite(translation).all()):
        return None
    R = np.asarray(cv2.Rodrigues(rotation)[0], dtype=np.float64)
    points_camera = points_dock @ R.T + translation.ravel()
    if (points_camera[:, 2] <= 0).any():
        return None
    error = camera.project(points_camera) - pixels
    x, y, z = translation.ravel().tolist()
    return Pose(
        t=(x, y, z),
        q_wxyz=quaternion_from_matrix(R),
        reprojection_px=float(np.sqrt((error**2).sum(axis=1).mean())),
    )
