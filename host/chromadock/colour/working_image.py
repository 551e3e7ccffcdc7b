"""Any frame to the 80 x 60 image that the decision is made on."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock import method
from chromadock._native import ffi, lib

RGB888_SCALE = (255, 255, 255)
RGB565_SCALE = (31, 63, 31)


def unpack_rgb565(data: bytes, width: int, height: int) -> NDArray[np.uint8]:
    """Big-endian RGB565 to a (height, width, 3) array, R G B on RGB565_SCALE."""
    word = np.frombuffer(data, dtype=">u2").reshape(height, width).astype(np.uint16)
    return np.stack((word >> 11, word >> 5 & 63, word & 31), axis=-1).astype(np.uint8)


def working_image(
    pixels: NDArray[np.uint8], scale: tuple[int, int, int] = RGB888_SCALE
) -> NDArray[np.uint8]:
    """Box average of a frame.

    Cell ``i`` of ``n`` covers the pixels from ``floor(i * size / n)`` up to, not
    including, ``floor((i + 1) * size / n)``, at least one.

    Parameters
    ----------
    pixels : (H, W, 3) uint8, any channel order.
    scale : full scale of each channel, in the same order.

    Returns
    -------
    (60, 80, 3) uint8, same channel order, 0..255, rounded once, halves up.
    """
    height, width = pixels.shape[:2]
    means = np.empty((method.WORKING_HEIGHT, method.WORKING_WIDTH, 3), np.uint8)
    lib.boxes_mean(
        ffi.from_buffer("uint8_t[]", np.ascontiguousarray(pixels)),
        *(height, width, *means.shape[:2]),
        scale,
        ffi.new("boxes_part_t[]", method.WORKING_WIDTH),
        ffi.from_buffer("uint16_t[]", np.empty(3 * width + lib.BOXES_SPARE, np.uint16)),
        ffi.from_buffer("uint32_t[]", np.empty(means[0].size, np.uint32)),
        ffi.from_buffer("uint8_t[]", means),
    )
    return means


def smooth(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """3 x 3 binomial blur of the working image, edge pixels repeated outwards."""
    return np.asarray(cv2.GaussianBlur(image, (3, 3), 0, borderType=cv2.BORDER_REPLICATE), np.uint8)
