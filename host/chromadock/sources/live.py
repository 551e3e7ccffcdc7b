"""Cameras, GStreamer pipelines and network streams."""

from __future__ import annotations

import time
from collections.abc import Iterator

import cv2

from chromadock.errors import ChromadockError
from chromadock.sources.address import without_secrets
from chromadock.sources.base import Frame, OnFault
from chromadock.sources.capture import Capture, frame_count
from chromadock.sources.video import Video
from chromadock.sources.video_opening import open_remote_video


class Live(Capture):
    """Frames as they come, each with the seconds since the first one.

    ``endless`` says that running dry is a fault, as with a camera that was unplugged.
    """

    live = True

    def __init__(self, capture: cv2.VideoCapture, name: str, endless: bool) -> None:
        super().__init__(capture, name)
        self._endless = endless

    def __iter__(self) -> Iterator[Frame]:
        start: float | None = None
        index = 0
        while (image := self.read()) is not None:
            now = time.monotonic()
            start = now if start is None else start
            yield Frame(image, self._name, index, now - start)
            index += 1
        if self._endless or index == 0:
            after = f" after {index}" if index else ""
            raise ChromadockError(
                f"{self._name}: delivers no more frames{after}: check the cable or the network"
            )


def open_camera(place: int | str) -> Live:
    """A camera by its index or device file.

    Raises
    ------
    ChromadockError
        Where it does not open.
    """
    if isinstance(place, int):
        name = f"camera {place}"
        capture = cv2.VideoCapture(place)
    else:
        name = place
        capture = cv2.VideoCapture(place, cv2.CAP_V4L2)
    _check_open(
        capture, name, "check that it is plugged in and free, or try another of ls /dev/video*"
    )
    return Live(capture, name, endless=True)


def open_pipeline(text: str) -> Live:
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
    _check_open(capture, "pipeline", "try it with gst-launch-1.0; it must end in appsink")
    return Live(capture, "pipeline", endless=False)


def open_url(url: str, on_fault: OnFault) -> Live | Video:
    """A network stream, or a video file behind a URL.

    Raises
    ------
    ChromadockError
        Where it does not open.
    """
    name = without_secrets(url)
    capture = cv2.VideoCapture(url, cv2.CAP_FFMPEG)
    _check_open(capture, name, "check the address, and that the stream runs")
    if frame_count(capture) is not None:
        capture.release()
        return open_remote_video(url, name, on_fault)
    return Live(capture, name, endless=False)


def _check_open(capture: cv2.VideoCapture, name: str, mend: str) -> None:
    if not capture.isOpened():
        raise ChromadockError(f"{name}: does not open: {mend}")
