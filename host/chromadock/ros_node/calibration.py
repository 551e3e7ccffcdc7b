"""The camera that CameraInfo messages describe."""

from __future__ import annotations

from typing import Any

from chromadock.camera import CameraModel
from chromadock.camera_file import calibration_of
from chromadock.errors import ChromadockError

Description = dict[str, Any]
"""What a CameraInfo says of the camera, by the names of a calibration file's keys."""


def description_of(message: Any) -> Description:
    """What a ``sensor_msgs/CameraInfo`` says of the camera: all but the header, which is another
    one for each picture."""
    roi = message.roi
    return {
        "width": message.width,
        "height": message.height,
        "distortion_model": message.distortion_model,
        "d": [float(number) for number in message.d],
        "k": [float(number) for number in message.k],
        "binning_x": message.binning_x,
        "binning_y": message.binning_y,
        "roi": {name: getattr(roi, name) for name in ("x_offset", "y_offset", "width", "height")},
    }


def described_camera(description: Description, topic: str) -> CameraModel:
    """The camera, for the pictures that the ``sensor_msgs/CameraInfo`` comes with.

    Region of interest and binning are applied; an empty ``distortion_model`` is a pinhole.

    Parameters
    ----------
    topic : what messages call it.

    Raises
    ------
    ChromadockError
        One line where the camera is not calibrated (by sensor_msgs, K[0] is 0 then), of a lens that
        is not known here, or of numbers that are no camera's.
    """
    if description["k"][0] == 0:
        raise ChromadockError(
            f"{topic}: the camera is not calibrated (its matrix k begins with 0): calibrate it in "
            "water and have its driver load that, or set the parameter camera.calibration"
        )
    read = calibration_of(description, topic)
    name = topic + read.window
    return CameraModel(read.width, read.height, read.matrix, read.distortion, name, read.lens)
