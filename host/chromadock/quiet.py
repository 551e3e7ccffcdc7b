"""Keeps the libraries' own chatter off the screen: our one line says it better."""

from __future__ import annotations

import logging
import os

import cv2


def quiet_libraries() -> None:
    """Silence OpenCV, FFmpeg and Pillow, unless the user asked to hear them.

    For the command line only; a program that imports this package keeps its own
    settings.  Set ``OPENCV_LOG_LEVEL`` or ``OPENCV_FFMPEG_LOGLEVEL`` to hear them.
    """
    # Read when the first video is opened, so it is early enough here.  -8 is "quiet".
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    if "OPENCV_LOG_LEVEL" not in os.environ:
        if hasattr(cv2, "setLogLevel"):  # OpenCV 4
            cv2.setLogLevel(0)
        else:
            cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
    # With no handler at all, Python prints warnings of loggers to stderr itself.
    logging.getLogger("PIL").addHandler(logging.NullHandler())
