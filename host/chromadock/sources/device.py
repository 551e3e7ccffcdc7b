"""Cameras of this computer, and GStreamer pipelines, through OpenCV."""

from __future__ import annotations

import math
import sys

import cv2
import numpy as np

from chromadock.choices import DEFAULT_FPS
from chromadock.errors import ChromadockError
from chromadock.sources.grabber import Grabber, Shot


class Device(Grabber):
    """An opened ``VideoCapture``.

    The V4L2 back end tells when the driver had each picture, on the monotonic clock; others tell
    nothing that could be relied on.
    """

    def __init__(self, capture: cv2.VideoCapture) -> None:
        self._capture = capture
        fps = capture.get(cv2.CAP_PROP_FPS)
        self.fps = fps if math.isfinite(fps) and 0 < fps <= 1000 else DEFAULT_FPS
        self.monotonic = capture.get(cv2.CAP_PROP_BACKEND) == cv2.CAP_V4L2

    def grab(self) -> Shot | None:
        """Wait for the next picture; None where the device is gone."""
        try:
            ok, image = self._capture.read()
        except cv2.error:
            return None
        if not ok or image is None:
            return None
        if image.ndim == 2:  # some cameras and pipelines deliver grey
            image = cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
        stamp_s = None
        if self.monotonic:
            told_ms = self._capture.get(cv2.CAP_PROP_POS_MSEC)
            stamp_s = told_ms / 1000 if told_ms > 0 else None
        return Shot(np.asarray(image, np.uint8), stamp_s)

    def close(self) -> None:
        """Let go of the device."""
        self._capture.release()


def open_device(place: int | str, name: str) -> Device:
    """A camera by its index or device file.

    Raises
    ------
    ChromadockError
        Where it does not open.
    """
    linux = sys.platform == "linux"
    capture = cv2.VideoCapture(place, cv2.CAP_V4L2 if linux else cv2.CAP_ANY)
    mend = "check that it is plugged in and free, or try another of ls /dev/video*"
    return _opened(capture, name, mend)


def open_gstreamer(text: str) -> Device:
    """A GStreamer pipeline that ends in ``appsink``; never shown, as it may hold passwords.

    Raises
    ------
    ChromadockError
        Where OpenCV has no GStreamer, or the pipeline does not run.
    """
    # The wheels on PyPI come without GStreamer, Debian's python3-opencv has it.
    if not cv2.videoio_registry.hasBackend(cv2.CAP_GSTREAMER):
        raise ChromadockError(
            "pipeline: this OpenCV is built without GStreamer: "
            "use Debian's python3-opencv, or give a device or URL"
        )
    capture = cv2.VideoCapture(text, cv2.CAP_GSTREAMER)
    return _opened(capture, "pipeline", "try it with gst-launch-1.0; it must end in appsink")


def _opened(capture: cv2.VideoCapture, name: str, mend: str) -> Device:
    if not capture.isOpened():
        raise ChromadockError(f"{name}: does not open: {mend}")
    return Device(capture)
