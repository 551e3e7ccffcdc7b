"""Overlays as a video file."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.draw import resized
from chromadock.errors import ChromadockError
from chromadock.output.base import OverlayOutput, partial_name

VIDEO_CODECS = {".mp4": "mp4v", ".avi": "MJPG", ".mkv": "mp4v"}
"""What OpenCV's wheels from PyPI can encode on every machine."""


class VideoOutput(OverlayOutput):
    """A video file; the first picture sets its size, others are fitted into that."""

    def __init__(self, path: Path, fps: float) -> None:
        self._path = path
        # FFmpeg takes what stands before a colon for a protocol, but not in a whole path.
        self._partial = partial_name(path).absolute()
        self._fps = fps
        self._writer: cv2.VideoWriter | None = None
        self._size = (0, 0)

    def write(self, picture: NDArray[np.uint8], name: str, index: int) -> None:
        """Encode one picture."""
        if self._writer is None:
            # Encoders halve the colour planes, so both sides must be even.
            height, width = (side + side % 2 for side in picture.shape[:2])
            self._size = (width, height)
            codec = cv2.VideoWriter_fourcc(*VIDEO_CODECS[self._path.suffix.lower()])  # type: ignore[attr-defined,unused-ignore]
            self._writer = cv2.VideoWriter(
                str(self._partial), cv2.CAP_FFMPEG, codec, self._fps, self._size
            )
            if not self._writer.isOpened():
                raise ChromadockError(
                    f"{self._path}: cannot write a video there: "
                    "check the disk and the name, or give a folder"
                )
        self._writer.write(fitted(picture, *self._size))

    def keep(self) -> None:
        """Close the video, see that it can be opened, and rename it."""
        if self._writer is None:
            return
        self._writer.release()
        # The encoder does not tell of a full disk; a video without its end does not open.
        check = cv2.VideoCapture(str(self._partial), cv2.CAP_FFMPEG)
        whole = check.isOpened()
        check.release()
        if not whole:
            self.drop()
            raise ChromadockError(f"{self._path}: the video could not be finished: disk full?")
        self._partial.replace(self._path)

    def drop(self) -> None:
        """Remove the video."""
        if self._writer is not None:
            self._writer.release()
        self._partial.unlink(missing_ok=True)


def fitted(picture: NDArray[np.uint8], width: int, height: int) -> NDArray[np.uint8]:
    """The picture HxWx3 scaled into ``height`` x ``width``, centred on black."""
    high, wide = picture.shape[:2]
    if (wide, high) == (width, height):
        return picture
    small = resized(picture, min(width / wide, height / high, 1.0))
    high, wide = small.shape[0], small.shape[1]
    page = np.zeros((height, width, 3), dtype=np.uint8)
    top, left = (height - high) // 2, (width - wide) // 2
    page[top : top + high, left : left + wide] = small
    return page
