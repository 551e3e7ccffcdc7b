"""The colour mask: foreground pixels near the colour expected of a marker."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock import method
from chromadock.colour.background import grey_range
from chromadock.colour.hsv import hsv_from_rgb

# OpenCV's 8-bit hue counts 180 steps a turn.
_HUE_STEPS = 180
_HUE_WINDOW = round(method.HUE_WINDOW_DEG * _HUE_STEPS / 360)
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
    grey = cv2.cvtColor(cv2.GaussianBlur(frame_bgr, (5, 5), 0), cv2.COLOR_BGR2GRAY)
    first, last = grey_range(background_bin)
    return np.asarray(cv2.bitwise_not(cv2.inRange(grey, first, last)), np.uint8)


def colour_mask(frame_bgr: NDArray[np.uint8], observed: tuple[int, int, int]) -> NDArray[np.uint8]:
    """Pixels within H +- 60 degrees, S and V +- 0.1765 of ``observed`` (R, G, B).

    The equation of C_mask; saturation and value are cut off at 0 and 1, hue wraps.
    Returns (H, W) uint8, 255 for a pixel that passes.
    """
    h, s, v, _ = (int(a) for a in hsv_from_rgb(np.array(observed, np.uint8), _HUE_STEPS))
    low_sv = (max(0, s - _SATURATION_WINDOW), max(0, v - _VALUE_WINDOW))
    high_sv = (min(255, s + _SATURATION_WINDOW), min(255, v + _VALUE_WINDOW))
    hsv = cv2.cvtColor(frame_bgr, cv2.COLOR_BGR2HSV)
    mask = np.zeros(hsv.shape[:2], np.uint8)
    for low, high in _hue_ranges(h - _HUE_WINDOW, h + _HUE_WINDOW):
        mask |= np.asarray(cv2.inRange(hsv, (low, *low_sv), (high, *high_sv)), np.uint8)
    return mask


def _hue_ranges(low: int, high: int) -> list[tuple[int, int]]:
    """An interval that may leave 0..179, as one or two within it."""
    top = _HUE_STEPS - 1
    if low < 0:
        return [(low + _HUE_STEPS, top), (0, high)]
    if high > top:
        return [(low, top), (0, high - _HUE_STEPS)]
    return [(low, high)]
