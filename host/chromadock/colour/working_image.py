"""Any frame to the 80 x 60 image that the decision is made on."""

from __future__ import annotations

from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock import method

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
    whole = height % method.WORKING_HEIGHT == 0 and width % method.WORKING_WIDTH == 0
    small = height <= method.MAX_FRAME_HEIGHT and width <= method.MAX_FRAME_WIDTH
    sums, count = _equal_boxes(pixels) if whole and small else _unequal_boxes(pixels)
    full = np.asarray(scale, dtype=np.float64) * count
    # Exact: no quotient of integers below 2^53 rounds up to a whole number.
    return np.asarray((510 * sums + full) / (2 * full)).astype(np.uint8)


def smooth(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """3 x 3 binomial blur of the working image, edge pixels repeated outwards."""
    return np.asarray(cv2.GaussianBlur(image, (3, 3), 0, borderType=cv2.BORDER_REPLICATE), np.uint8)


def _equal_boxes(pixels: NDArray[np.uint8]) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Sums (60, 80, 3) and counts (1, 80, 1) of a frame whose cells have all the same whole size.

    Exact, and four times as fast as the other: the 64 rows at most of a cell of the largest
    frame add up in 16 bits, its 64 x 64 pixels in float32, which holds integers up to 2^24.
    """
    rows = pixels.shape[0] // method.WORKING_HEIGHT
    columns = pixels.shape[1] // method.WORKING_WIDTH
    stacked = pixels.reshape(method.WORKING_HEIGHT, rows, -1)
    upright = np.add.reduce(stacked, axis=1, dtype=np.uint16)
    # OpenCV's product keeps to the threads that OpenCV is allowed; numpy's starts its own.
    cells = upright.reshape(-1, 3 * columns).astype(np.float32)
    sums = cv2.gemm(cells, _by_channel(columns), 1, np.empty(0), 0)
    sums = sums.reshape(method.WORKING_HEIGHT, method.WORKING_WIDTH, 3)
    # A count for each column: numpy is slow to repeat a single one for three channels.
    return sums.astype(np.float64), np.full((1, method.WORKING_WIDTH, 1), rows * columns)


@cache
def _by_channel(columns: int) -> NDArray[np.float32]:
    """(3 columns, 3): adds up the pixels of a row, each channel to itself."""
    return np.tile(np.eye(3, dtype=np.float32), (columns, 1))


def _unequal_boxes(pixels: NDArray[np.uint8]) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Sums (60, 80, 3) and counts (60, 80, 1) for any size."""
    y0, y1 = _boxes(pixels.shape[0], method.WORKING_HEIGHT)
    x0, x1 = _boxes(pixels.shape[1], method.WORKING_WIDTH)
    # Sums may wrap in 32 bits; their differences, the boxes, do not.
    integral = cv2.integral(pixels).view(np.uint32)
    top, bottom = integral[y0], integral[y1]
    sums = (bottom[:, x1] - bottom[:, x0] - top[:, x1] + top[:, x0]).astype(np.float64)
    return sums, ((y1 - y0)[:, None] * (x1 - x0)[None, :])[..., None]


def _boxes(size: int, cells: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """First and one past the last source pixel of each cell."""
    edges = np.arange(cells + 1) * size // cells
    return edges[:-1], np.maximum(edges[1:], edges[:-1] + 1)
