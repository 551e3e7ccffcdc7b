"""RGB and HSV on the hexcone, and hues as vectors, in integers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock import method, method_tables
from chromadock._native import ffi, lib


def _tables(hue_range: int, by_chroma: NDArray[np.int32], shift: int) -> Any:
    by_value = pointer(method_tables.SATURATION_DIVISION)
    return ffi.new(
        "hue_tables_t *", (hue_range, shift, pointer(by_chroma), method.OPENCV_SHIFT, by_value)
    )


def pointer(table: NDArray[np.int32]) -> Any:
    """Where the numbers of a table are: valid for as long as the table itself is."""
    return ffi.from_buffer("int32_t[]", table)


# By steps a turn.
_TABLES = {
    method.HUE_RANGE: _tables(method.HUE_RANGE, method_tables.HUE_DIVISION, method.HUE_SHIFT),
    180: _tables(180, method_tables.HUE_DIVISION_180, method.OPENCV_SHIFT),
    256: _tables(256, method_tables.HUE_DIVISION_256, method.OPENCV_SHIFT),
}

TABLES = _TABLES[method.HUE_RANGE]
"""Of the decision's own hues, for ``host/native/hue.h``."""


def hsv_from_rgb(
    rgb: NDArray[np.uint8], hue_range: int = method.HUE_RANGE
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Hue, saturation, value and chroma.

    With ``hue_range`` 180 or 256 the first three equal OpenCV's 8-bit
    ``COLOR_RGB2HSV`` and ``COLOR_RGB2HSV_FULL`` on every colour.

    Parameters
    ----------
    rgb : (..., 3) uint8.
    hue_range : 1536, 180 or 256 steps a turn; red 0, green a third, blue two thirds.

    Returns
    -------
    Four (...) int32: hue 0..hue_range-1, the others 0..255.
    """
    pixels = ffi.from_buffer("uint8_t[]", np.ascontiguousarray(rgb, np.uint8))
    hsvc = np.empty((4, *rgb.shape[:-1]), np.int32)
    lib.hue_of_pixels(_TABLES[hue_range], pixels, len(pixels) // 3, pointer(hsvc))
    hue, saturation, value, chroma = (np.asarray(plane) for plane in hsvc)
    return hue, saturation, value, chroma


def rgb_from_hsv(hue: int, saturation: int, value: int) -> tuple[int, int, int]:
    """The inverse for one colour; hue 0..1535, the others 0..255.

    A pure colour (saturation and value 255) goes to its hue and back unchanged.
    """
    low = value - (value * saturation + 127) // 255
    chroma = value - low
    sextant, step = hue >> 8, hue & 255
    rising = low + ((chroma * step + 128) >> 8)
    falling = low + ((chroma * (256 - step) + 128) >> 8)
    return (
        (value, rising, low),
        (falling, value, low),
        (low, value, rising),
        (low, falling, value),
        (rising, low, value),
        (value, low, falling),
    )[sextant]


def hue_cos(hue: NDArray[np.int32]) -> NDArray[np.int32]:
    """Cosine in units of ``method.TRIG_UNIT``; hue 0..1535."""
    return method_tables.SINE[hue + method.HUE_RANGE // 4]


def hue_sin(hue: NDArray[np.int32]) -> NDArray[np.int32]:
    """Sine in units of ``method.TRIG_UNIT``; hue 0..1535."""
    return method_tables.SINE[hue]


def hue_of_vector(x: int, y: int) -> int | None:
    """Hue 0..1535 of a vector; None of the zero vector, which has none."""
    near, far = sorted((abs(x), abs(y)))
    if far == 0:
        return None
    while far >= 1 << 21:  # the C keeps near * ATAN_STEPS within 32 bits
        near, far = near >> 1, far >> 1
    hue = int(method_tables.ARCTANGENT[(near * method.ATAN_STEPS + far // 2) // far])
    if abs(y) > abs(x):
        hue = method.HUE_RANGE // 4 - hue
    if x < 0:
        hue = method.HUE_RANGE // 2 - hue
    if y < 0:
        hue = method.HUE_RANGE - hue
    return hue % method.HUE_RANGE


def degrees(hue: int) -> float:
    """Hue steps to degrees, 0..360."""
    return hue * 360.0 / method.HUE_RANGE


def nearest_hue(hue_deg: float) -> int:
    """Degrees to the nearest step, halves up, as the dock rounds its parameters.

    ``ValueError`` where that is none of 0..1535: below 0, from 359.883 on, or not finite.
    """
    if not 0 <= hue_deg < 360:
        raise ValueError(f"no hue: {hue_deg}")
    hue = math.floor(hue_deg * method.HUE_RANGE / 360.0 + 0.5)
    if hue >= method.HUE_RANGE:
        raise ValueError(f"no hue: {hue_deg}")
    return hue
