"""The water's colour as the vehicle works it out of its own camera's frame."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock import method
from chromadock.colour.background import BackgroundColour, background_colour
from chromadock.colour.working_image import smooth, working_image


def vehicle_background(frame_bgr: NDArray[np.uint8]) -> BackgroundColour:
    """Of a frame (H, W, 3) uint8, BGR; dark water means nothing below the vehicle's own threshold,
    for the vehicle sees the glow of the dock's lamps."""
    working_rgb = cv2.cvtColor(working_image(frame_bgr), cv2.COLOR_BGR2RGB)
    smoothed = smooth(np.asarray(working_rgb, np.uint8))
    return background_colour(smoothed, method.MIN_VALUE_VEHICLE)
