"""Compare dockcore, the host's own code and the OpenCV on the path over all 2^24 colours.

Prints ``<OpenCV version> <colours compared> <differences>``; run by test_tables.py
under each OpenCV.
"""

from __future__ import annotations

import sys

import cv2
import numpy as np

from chromadock.colour.background import background_colour
from chromadock.colour.hsv import hsv_from_rgb as host_hsv
from chromadock_firmware import hsv_from_rgb as c_hsv

CHUNK = 1 << 20
CODES = {180: cv2.COLOR_RGB2HSV, 256: cv2.COLOR_RGB2HSV_FULL}


def exact_hue(rgb: np.ndarray) -> np.ndarray:
    """Hue 0..1535 by plain division, halves up."""
    r, g, b = rgb.astype(np.int64).T
    value = rgb.max(axis=1).astype(np.int64)
    chroma = value - rgb.min(axis=1)
    distance = np.select([value == r, value == g], [g - b, b - r + 2 * chroma], r - g + 4 * chroma)
    divisor = np.maximum(chroma, 1)
    return (512 * distance + divisor) // (2 * divisor) % 1536


def in_other_intervals(rgb: np.ndarray, intervals: np.ndarray) -> int:
    """How many of (N, 3) colours the host has in another grey interval than (N,) 0..4."""
    others = 0
    for interval in np.unique(intervals).tolist():
        own = rgb[intervals == interval]
        others += len(own) - background_colour(own[None]).bin_counts[interval]
    return others


def main(hue_range: int) -> None:
    compared = different = 0
    for start in range(0, 1 << 24, CHUNK):
        index = np.arange(start, start + CHUNK, dtype=np.uint32)
        rgb = np.stack((index >> 16, index >> 8 & 255, index & 255), -1).astype(np.uint8)
        by_c = np.stack(c_hsv(rgb, hue_range), -1)
        by_host = np.stack(host_hsv(rgb, hue_range)[:3], -1)
        different += int((by_c != by_host).any(-1).sum())
        if hue_range in CODES:
            by_opencv = cv2.cvtColor(rgb[None], CODES[hue_range])[0]
            different += int((by_c != by_opencv).any(-1).sum())
        else:
            different += int((by_c[:, 0] != exact_hue(rgb)).sum())
            # The bins of the background step, whose grey comes from OpenCV on the host.
            r, g, b = rgb.astype(np.int64).T
            grey = (9798 * r + 19235 * g + 3735 * b + 16384) >> 15
            different += in_other_intervals(rgb, grey * 5 >> 8)
        compared += len(rgb)
    print(cv2.__version__, compared, different)


if __name__ == "__main__":
    main(int(sys.argv[1]))
