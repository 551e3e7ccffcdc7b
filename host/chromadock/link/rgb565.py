"""Pictures in the camera's own format: RGB565, two bytes a pixel, the upper one first."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

WIDTH, HEIGHT = 160, 120
"""QQVGA, what the dock's camera delivers."""


def to_rgb565(image: NDArray[np.uint8]) -> bytes:
    """HxWx3 uint8 BGR as rows from the top; the lower bits are cut off, as in the camera."""
    b, g, r = (image[:, :, i].astype(np.uint16) for i in range(3))
    words = (r >> 3) << 11 | (g >> 2) << 5 | b >> 3
    return words.astype(">u2").tobytes()


def from_rgb565(data: bytes, width: int, height: int) -> NDArray[np.uint8]:
    """HxWx3 uint8 BGR; full scale becomes 255.  ``data`` has 2 * width * height bytes."""
    words = np.frombuffer(data, ">u2").reshape(height, width).astype(np.uint16)
    r, g, b = words >> 11, words >> 5 & 63, words & 31
    channels = (b << 3 | b >> 2, g << 2 | g >> 4, r << 3 | r >> 2)
    return np.stack(channels, axis=-1).astype(np.uint8)


def to_qqvga(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """HxWx3 uint8 at the dock camera's size, by averaging."""
    if image.shape[:2] == (HEIGHT, WIDTH):
        return image
    return np.asarray(cv2.resize(image, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA), np.uint8)
