"""Frames by OpenCV's VideoCapture: video files, cameras, pipelines and URLs."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.errors import ChromadockError
from chromadock.sources.base import DEFAULT_FPS, Frame, Source
from chromadock.sources.container import counts_frames, missing_bytes

_TAIL_S = 0.25
"""Sound often outlasts the picture by this much, and makes a guessed frame count too high."""


class _Capture(Source):
    """The part that all of them share: an opened VideoCapture."""

    def __init__(self, capture: cv2.VideoCapture) -> None:
        self._capture = capture
        fps = capture.get(cv2.CAP_PROP_FPS)
        self.fps = fps if math.isfinite(fps) and 0 < fps <= 1000 else DEFAULT_FPS
        count = capture.get(cv2.CAP_PROP_FRAME_COUNT)
        self.count = int(count) if math.isfinite(count) and 0 < count < 2**31 else None

    def _read(self) -> NDArray[np.uint8] | None:
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


class VideoFile(_Capture):
    """A video file, each frame at its own timestamp.

    Raises ``ChromadockError`` when opened, where the file is cut short or no video; and at
    the end, where fewer frames could be decoded than the file declares.
    """

    def __init__(self, path: Path) -> None:
        missing = missing_bytes(path)
        if missing:
            raise ChromadockError(
                f"{path}: the video is cut short ({missing} bytes are missing): copy it again, "
                "or repair it with ffmpeg"
            )
        capture = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
        if not capture.isOpened():
            raise ChromadockError(
                f"{path}: cannot be read as a video or picture: check that it is one and whole"
            )
        super().__init__(capture)
        self._path = path
        self._exact = counts_frames(path)

    def __iter__(self) -> Iterator[Frame]:
        last = -1.0
        index = 0
        while (image := self._read()) is not None:
            stamp = self._capture.get(cv2.CAP_PROP_POS_MSEC) / 1000
            if not math.isfinite(stamp) or stamp <= last:  # raw streams carry no time
                stamp = 0.0 if index == 0 else last + 1 / self.fps
            yield Frame(image, self._path.name, index, stamp)
            last = stamp
            index += 1
        self._check_end(index, last)

    def _check_end(self, decoded: int, last_s: float) -> None:
        if decoded == 0:
            raise ChromadockError(
                f"{self._path}: no frame could be decoded: convert the video with ffmpeg"
            )
        if self.count is None or decoded >= self.count:
            return
        short_s = self.count / self.fps - (last_s + 1 / self.fps)
        if self._exact or short_s > _TAIL_S:
            raise ChromadockError(
                f"{self._path}: only {decoded} of {self.count} frames could be decoded: "
                "the video is damaged; copy it again, or repair it with ffmpeg"
            )


class Live(_Capture):
    """A camera, pipeline or stream; frames carry the seconds since the first one.

    ``endless`` says that running dry is a fault, as with a camera that was unplugged.
    """

    live = True

    def __init__(self, capture: cv2.VideoCapture, name: str, endless: bool) -> None:
        super().__init__(capture)
        self.count = None
        self._name = name
        self._endless = endless

    def __iter__(self) -> Iterator[Frame]:
        start: float | None = None
        index = 0
        while (image := self._read()) is not None:
            now = time.monotonic()
            start = now if start is None else start
            yield Frame(image, self._name, index, now - start)
            index += 1
        if self._endless or index == 0:
            raise ChromadockError(
                f"{self._name}: no more frames after {index}: check the cable or the network"
            )


def open_live(place: int | str) -> Live:
    """A camera by index or device, a GStreamer pipeline (with ``!``) or a URL.

    Raises
    ------
    ChromadockError
        Where it does not open.
    """
    if isinstance(place, int):
        capture, name = cv2.VideoCapture(place), f"camera {place}"
        mend = "check that it is plugged in, or try another index (ls /dev/video*)"
    elif "!" in place and "://" not in place.split("!")[0].split()[0]:
        capture, name = _pipeline(place), "pipeline"
        mend = f"try it with gst-launch-1.0 first; it must end in appsink: {place}"
    elif "://" in place:
        capture, name = cv2.VideoCapture(place, cv2.CAP_FFMPEG), place
        mend = "check the address, and that the stream runs"
    else:
        capture, name = cv2.VideoCapture(place, cv2.CAP_V4L2), place
        mend = "check that it is a camera and that no other program uses it"
    if not capture.isOpened():
        raise ChromadockError(f"{name}: does not open: {mend}")
    endless = not (isinstance(place, str) and ("!" in place or "://" in place))
    return Live(capture, name, endless)


def _pipeline(text: str) -> cv2.VideoCapture:
    # The wheels on PyPI come without GStreamer, Debian's python3-opencv with it.
    if not any(
        cv2.videoio_registry.getBackendName(b) == "GSTREAMER"
        for b in cv2.videoio_registry.getStreamBackends()
    ):
        raise ChromadockError(
            "pipeline: this OpenCV is built without GStreamer: "
            "install Debian's python3-opencv, or give a device or URL"
        )
    return cv2.VideoCapture(text, cv2.CAP_GSTREAMER)
