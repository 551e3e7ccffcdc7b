"""Two places on one bright thing, which are not two markers."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

SAMPLES = 15
"""Places between two markers that are looked at, and as many beyond each."""

LEAST_EXCESS = 10.0
"""Codes of 255 by which some channel of both ends is brighter than what is beyond them: of fainter
lamps noise hides whether it is dark between them."""

DIP = 6.0
LEAST_DIP = 0.1
"""Some channel is darker between two lamps by so many codes, or by so much of that excess: more
than noise and JPEG do to one."""


def on_one_thing(frame_bgr: NDArray[np.uint8], xy: NDArray[np.float64]) -> bool:
    """Whether it is as bright between a marker and the nearest other one as at both.

    So it is between two corners of a pale box, or two places on a diver's light.  Two lamps have
    something darker between them: even where their light runs into each other and clips, their
    cores are the brightest in the channel that clips last; and before a white bar the lamps are
    brighter than it in their colour.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    xy : (n, 2) pixels, two or more.
    """
    apart = np.linalg.norm(xy[:, None] - xy, axis=2)
    np.fill_diagonal(apart, np.inf)
    way = xy[apart.argmin(axis=1)] - xy
    steps = np.linspace(-1.0, 2.0, 3 * SAMPLES + 1)[:, None, None]
    light = _means(frame_bgr, xy + steps * way)
    before, there, behind = light[:SAMPLES], light[SAMPLES : 2 * SAMPLES + 1], light[-SAMPLES:]
    ends = np.minimum(there[0], there[-1])
    excess = ends - np.minimum(before.min(axis=0), behind.min(axis=0))
    dip = ends - there.min(axis=0)
    level = (dip < np.minimum(DIP, np.maximum(LEAST_DIP * excess, 0))).all(axis=1)
    return bool((level & (excess.max(axis=1) >= LEAST_EXCESS)).any())


def _means(frame_bgr: NDArray[np.uint8], places: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, n, 3) means of 3 x 3 pixels about (k, n, 2) places, of the nearest ones beyond the
    border."""
    corner = np.floor(places.min(axis=(0, 1))).astype(int) - 2
    end = np.ceil(places.max(axis=(0, 1))).astype(int) + 3
    height, width = frame_bgr.shape[:2]
    left, top = np.clip(corner, 0, (width - 1, height - 1)).tolist()
    right, bottom = np.clip(end, (left + 1, top + 1), (width, height)).tolist()
    smooth = cv2.blur(frame_bgr[top:bottom, left:right], (3, 3), borderType=cv2.BORDER_REPLICATE)
    size = (smooth.shape[1] - 1, smooth.shape[0] - 1)
    across, down = np.moveaxis(
        np.clip(np.rint(places - (left, top)), 0, size).astype(np.intp), 2, 0
    )
    return np.asarray(smooth[down, across], np.float64)
