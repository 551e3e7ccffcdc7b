"""The colour mask: foreground pixels near the colour expected of a marker."""

from __future__ import annotations

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

from chromadock import method
from chromadock.colour.background import grey_range
from chromadock.colour.hsv import hsv_from_rgb

# OpenCV's 8-bit hue counts 180 steps a turn.
HUE_STEPS = 180
_HUE_WINDOW = round(method.HUE_WINDOW_DEG * HUE_STEPS / 360)
_SATURATION_WINDOW = round(method.SATURATION_WINDOW * 255)
_VALUE_WINDOW = round(method.VALUE_WINDOW * 255)


def foreground(frame_bgr: NDArray[np.uint8], background_bin: int) -> NDArray[np.uint8]:
    """Pixels whose grey, after a 5 x 5 Gaussian blur, is outside the background's bin.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    background_bin : 0..4, from the background colour.

    Returns
    -------
    (H, W) uint8, 255 for foreground.
    """
    return foreground_of_grey(blurred_grey(frame_bgr), background_bin)


def blurred_grey(frame_bgr: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Grey of an (H, W, 3) uint8 frame after a 5 x 5 Gaussian blur."""
    return np.asarray(
        cv2.cvtColor(cv2.GaussianBlur(frame_bgr, (5, 5), 0), cv2.COLOR_BGR2GRAY), np.uint8
    )


def foreground_of_grey(grey: NDArray[np.uint8], background_bin: int) -> NDArray[np.uint8]:
    """``foreground`` of a frame whose ``blurred_grey`` is known."""
    first, last = grey_range(background_bin)
    return np.asarray(cv2.bitwise_not(cv2.inRange(grey, first, last)), np.uint8)


def colour_mask(frame_bgr: NDArray[np.uint8], observed: tuple[int, int, int]) -> NDArray[np.uint8]:
    """Pixels within H +- 60 degrees, S and V +- 0.1765 of ``observed`` (R, G, B).

    The equation of C_mask; saturation and value are cut off at 0 and 1, hue wraps.
    Returns (H, W) uint8, 255 for a pixel that passes.
    """
    return colour_mask_of_hsv(cv2.cvtColor(frame_bgr, cv2.COLOR_BGR2HSV), observed)


def colour_mask_of_hsv(hsv: MatLike, observed: tuple[int, int, int]) -> NDArray[np.uint8]:
    """``colour_mask`` of a frame whose (H, W, 3) OpenCV HSV is known."""
    h, s, v, _ = (int(a) for a in hsv_from_rgb(np.array(observed, np.uint8), HUE_STEPS))
    low_sv = (max(0, s - _SATURATION_WINDOW), max(0, v - _VALUE_WINDOW))
    high_sv = (min(255, s + _SATURATION_WINDOW), min(255, v + _VALUE_WINDOW))
    return in_box(hsv, (h - _HUE_WINDOW, *low_sv), (h + _HUE_WINDOW, *high_sv))


def in_box(
    hsv: MatLike, low: tuple[int, int, int], high: tuple[int, int, int]
) -> NDArray[np.uint8]:
    """Pixels of an (H, W, 3) OpenCV HSV image from ``low`` to ``high``, both included.

    Saturation and value are 0..255; hue is counted in HUE_STEPS and may leave its range by
    less than a turn: it wraps.  Returns (H, W) uint8, 255 for a pixel that passes.
    """
    mask = np.zeros(hsv.shape[:2], np.uint8)
    for first, last in _hue_ranges(low[0], high[0]):
        mask |= np.asarray(cv2.inRange(hsv, (first, *low[1:]), (last, *high[1:])), np.uint8)
    return mask


def _hue_ranges(low: int, high: int) -> list[tuple[int, int]]:
    """An interval that may leave 0..179, as one or two within it."""
    top = HUE_STEPS - 1
    if low < 0:
        return [(low + HUE_STEPS, top), (0, high)]
    if high > top:
        return [(low, top), (0, high - HUE_STEPS)]
    return [(low, high)]
