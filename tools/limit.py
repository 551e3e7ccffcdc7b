"""What a single frame allows: whether its markers stand out of the noise."""

from __future__ import annotations

import cv2
import numpy as np

from chromadock import CameraModel
from chromadock.method import HUE_RANGE
from chromadock.robust.frame.peaks import MIN_SNR
from chromadock.robust.frame.response import respond
from chromadock.robust.weigh.shape import focal_px


def standing_out(
    frame_bgr: np.ndarray, camera: CameraModel, pixels: np.ndarray, hue_deg: float
) -> bool:
    """Whether each marker's brightest cell nearby is MIN_SNR or more, at any scale.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    pixels : (N, 2) true places of the markers, all in the frame.
    hue_deg : the colour that the markers should have.
    """
    hue = round(hue_deg * HUE_RANGE / 360) % HUE_RANGE
    best = np.zeros(len(pixels))
    response = respond(frame_bgr, hue, focal_px(camera))
    highest = cv2.dilate(response.snr, np.ones((3, 3), np.uint8)).ravel()
    for scale, cell in enumerate(response.layout.cells):
        x, y = np.floor((pixels + 0.5) / cell).astype(int).T
        best = np.maximum(best, highest[response.layout.at(scale, y, x)])
    return bool((best >= MIN_SNR).all())
