"""Keeps the libraries' own chatter off the screen: our one line says it better."""

from __future__ import annotations

import logging
import os


def quiet_libraries() -> None:
    """Silence OpenCV, FFmpeg and Pillow, unless the user asked to hear them.

    For the command line only; a program that imports this package keeps its own
    settings.  Set ``OPENCV_LOG_LEVEL`` or ``OPENCV_FFMPEG_LOGLEVEL`` to hear them.
    Call it before OpenCV is loaded, which reads the first of them then.
    """
    os.environ.setdefault("OPENCV_LOG_LEVEL", "SILENT")
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")  # "quiet"
    # With no handler at all, Python prints warnings of loggers to stderr itself.
    logging.getLogger("PIL").addHandler(logging.NullHandler())
