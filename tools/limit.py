"""What a single frame allows: whether its markers stand out of the noise."""

from __future__ import annotations

import numpy as np

from chromadock import CameraModel
from chromadock.method import HUE_RANGE
from chromadock.robust.frame.peaks import MIN_SNR
from chromadock.robust.frame.response import respond
from chromadock.robust.weigh.shape import focal_px

_ABOUT = np.mgrid[-1:2, -1:2].reshape(2, 9, 1)


def standing_out(
    frame_bgr: np.ndarray,
    camera: CameraModel,
    pixels: np.ndarray,
    hue_deg: float,
    dark_bgr: np.ndarray | None = None,
) -> bool:
    """Whether each marker's brightest cell nearby is MIN_SNR or more, at any scale.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    pixels : (N, 2) true places of the markers, all in the frame.
    hue_deg : the colour that the markers should have.
    dark_bgr : the same picture with the dock's lamps out, if there is one: then as much must come
        of the lamps themselves, and not of the bars they stand on.
    """
    shines = _snr_near(frame_bgr, camera, pixels, hue_deg)
    if dark_bgr is not None:
        shines = np.minimum(shines, shines - _snr_near(dark_bgr, camera, pixels, hue_deg))
    return bool((shines.max(axis=0) >= MIN_SNR).all())


def _snr_near(
    frame_bgr: np.ndarray, camera: CameraModel, pixels: np.ndarray, hue_deg: float
) -> np.ndarray:
    """(9 S, N): the signal to noise of the cells at and about each marker, at all S scales."""
    hue = round(hue_deg * HUE_RANGE / 360) % HUE_RANGE
    response = respond(frame_bgr, hue, focal_px(camera))
    near = []
    for scale, cell in enumerate(response.layout.cells):
        x, y = np.floor((pixels + 0.5) / cell).astype(np.intp).T
        near.append(response.layout.at(scale, y + _ABOUT[0], x + _ABOUT[1]))
    return np.asarray(response.snr.ravel()[np.concatenate(near)])
