"""The picture, and the camera that it was taken with."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.ros.fields import Fields
from chromadock.ros.header import header

QUALITY = 95
_HOW = (
    *(cv2.IMWRITE_JPEG_QUALITY, QUALITY),
    *(cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444),
)
"""Colour at full resolution: lamps far away are a few pixels, and are known by their hue.
Nothing without loss is fast enough: docs/recording.md has the figures."""


def compressed_image(image: NDArray[np.uint8], stamp_ns: int) -> Fields:
    """``sensor_msgs/CompressedImage`` of an HxWx3 uint8 BGR picture, as JPEG."""
    _, data = cv2.imencode(".jpg", image, _HOW)
    return {"header": header(stamp_ns), "format": "jpeg", "data": data.tobytes()}


def camera_info(camera: CameraModel, stamp_ns: int) -> Fields:
    """``sensor_msgs/CameraInfo``, for pictures as they are, not rectified."""
    model, coefficients = _distortion(camera)
    K = camera.matrix
    return {
        "header": header(stamp_ns),
        "height": camera.height,
        "width": camera.width,
        "distortion_model": model,
        "d": coefficients,
        "k": K.ravel().tolist(),
        "r": np.eye(3).ravel().tolist(),
        "p": np.hstack([K, np.zeros((3, 1))]).ravel().tolist(),
        "binning_x": 0,
        "binning_y": 0,
        "roi": {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False},
    }


_LEAST = {"plumb_bob": 5, "equidistant": 4, "rational_polynomial": 8}
"""Coefficients that ROS's lens models have at least; OpenCV leaves out the last ones that are 0."""


def _distortion(camera: CameraModel) -> tuple[str, list[float]]:
    """ROS's model, by whose names the lenses are called, and coefficients."""
    coefficients = camera.distortion.tolist()
    return camera.lens, coefficients + [0.0] * (_LEAST[camera.lens] - len(coefficients))
