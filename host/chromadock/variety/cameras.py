"""The cameras that take the scenes."""

from __future__ import annotations

import numpy as np

from chromadock.camera import CameraModel
from chromadock.variety.factors import variety


def camera_model(name: str, offset: tuple[float, float] = (0.0, 0.0)) -> CameraModel:
    """A camera of ``variety.toml``; ``offset`` of the principal point in shares of the width."""
    entry = variety().cameras[name]
    width, height = entry.size
    (fx, fy), (cx, cy) = entry.focal, entry.centre
    cx, cy = cx + width * offset[0], cy + width * offset[1]
    matrix = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    return CameraModel(width, height, matrix, np.array(entry.distortion), name)
