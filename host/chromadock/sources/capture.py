"""What everything read through OpenCV's VideoCapture shares."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.choices import DEFAULT_FPS
from chromadock.sources.base import Source


class Capture(Source):
    """An opened VideoCapture; ``name`` stands in frames and messages."""

    def __init__(self, capture: cv2.VideoCapture, name: str) -> None:
        self._capture = capture
        self._name = name
        fps = capture.get(cv2.CAP_PROP_FPS)
        self.fps = fps if math.isfinite(fps) and 0 < fps <= 1000 else DEFAULT_FPS

    def read(self) -> NDArray[np.uint8] | None:
        """The next frame HxWx3 uint8 BGR, None at the end."""
        try:
            ok, image = self._capture.read()
        except cv2.error:
            return None
        if not ok or image is None:
            return None
        if image.ndim == 2:  # some cameras and pipelines deliver grey
            image = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
        return np.asarray(image, dtype=np.uint8)

    def close(self) -> None:
        """Let go of the camera or file."""
        self._capture.release()


def frame_count(capture: cv2.VideoCapture) -> int | None:
    """The declared number of frames, None where there is none."""
    count = capture.get(cv2.CAP_PROP_FRAME_COUNT)
    return int(count) if math.isfinite(count) and 0 < count < 2**31 else None
