"""The filters that are compared: each makes a mask of the same frame.

What follows the mask is the same for all: the paper's blobs, constellation and EPnP.  Beside
them stands the robust method, which has its own (``finders``).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.colour.hsv import rgb_from_hsv
from chromadock.colour.marker import observed_colour
from chromadock.evaluate.tuned import Tuned
from chromadock.evaluate.view import View
from chromadock.paper.mask import colour_mask_of_hsv, foreground_of_grey, in_box

ADAPTIVE = {"adaptive ternary": "ternary", "adaptive complement": "complement"}
"""The paper's mask about the colour that this mapping expects, on foreground pixels."""

STATIC = {"static pool": "pool", "static lake": "lake"}
"""One box in HSV for all frames, tuned on the scene of this name."""

INTENSITY = "intensity"
"""One threshold of the blurred grey for all frames, tuned on the same scenes: the filter of
the literature before colour (Knutson 2024, section II.B), whose blobs the Laplacian of
Gaussian then looks for."""

MASKS = (*ADAPTIVE, *STATIC, INTENSITY)
"""Filters whose mask is all that they are."""

ROBUST = "robust"
"""The robust method with the run's own mapping; its mask is what stands out in that colour."""

FILTERS = (ROBUST, *MASKS)


def filter_mask(name: str, view: View, tuned: Tuned) -> NDArray[np.uint8]:
    """The pixels that the filter ``name`` (one of MASKS) lets pass, (H, W) uint8, 0 or 255."""
    if name in ADAPTIVE:
        hue = view.marker_hues[ADAPTIVE[name]]
        observed = observed_colour(view.background.rgb, rgb_from_hsv(hue, 255, 255))
        foreground = foreground_of_grey(view.grey, view.background.bin)
        return colour_mask_of_hsv(view.hsv, observed) & foreground
    if name in STATIC:
        box = tuned.boxes[STATIC[name]]
        return in_box(view.hsv, box.low, box.high)
    return np.asarray(cv2.threshold(view.grey, tuned.grey - 1, 255, cv2.THRESH_BINARY)[1], np.uint8)
