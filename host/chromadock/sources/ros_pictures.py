"""From ROS's messages of pictures to BGR."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.errors import ChromadockError
from chromadock.sources.still import decode_still

IMAGE, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"

_TO_BGR = {
    "bgr8": None,
    "8UC3": None,
    "rgb8": cv2.COLOR_RGB2BGR,
    "bgra8": cv2.COLOR_BGRA2BGR,
    "rgba8": cv2.COLOR_RGBA2BGR,
    "mono8": cv2.COLOR_GRAY2BGR,
    "8UC1": cv2.COLOR_GRAY2BGR,
    # OpenCV names the second and third pixel of the second row, ROS the first row.
    "bayer_rggb8": cv2.COLOR_BayerBG2BGR,
    "bayer_bggr8": cv2.COLOR_BayerRG2BGR,
    "bayer_gbrg8": cv2.COLOR_BayerGR2BGR,
    "bayer_grbg8": cv2.COLOR_BayerGB2BGR,
}
"""What turns each encoding into BGR."""

_CHANNELS = {"bgr8": 3, "8UC3": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4}


def picture(message: Any, name: str) -> NDArray[np.uint8]:
    """HxWx3 uint8 BGR of an ``Image`` or ``CompressedImage``.

    Raises
    ------
    ChromadockError
        One line with ``name``, where it is none, not whole, or of an encoding that is no
        picture of 8 bits.
    """
    if hasattr(message, "format"):
        return decode_still(bytes(message.data), name)
    encoding = message.encoding
    if encoding not in _TO_BGR:
        raise ChromadockError(
            f"{name}: pictures of encoding {encoding!r} cannot be read: "
            f"record one of {', '.join(_TO_BGR)}"
        )
    plain = _plain(message, _CHANNELS.get(encoding, 1), name)
    code = _TO_BGR[encoding]
    bgr = plain if code is None else cv2.cvtColor(plain, code)
    return np.ascontiguousarray(bgr, np.uint8)


def _plain(message: Any, channels: int, name: str) -> NDArray[np.uint8]:
    """HxW or HxWxchannels, without what pads the rows."""
    height, width, step = message.height, message.width, message.step
    data = np.asarray(message.data, np.uint8)
    if not height or not width or step < width * channels or data.size < height * step:
        raise ChromadockError(
            f"{name}: a picture of {width}x{height} pixels with {data.size} bytes: it is not whole"
        )
    rows = data[: height * step].reshape(height, step)[:, : width * channels]
    return rows.reshape(height, width, channels) if channels > 1 else rows
