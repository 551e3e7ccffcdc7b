"""What stands behind a URL: a live stream, or a video file on a server."""

from __future__ import annotations

import re
from functools import partial

import cv2

from chromadock.sources.base import OnSkip, Source
from chromadock.sources.capture import frame_count
from chromadock.sources.live import Live
from chromadock.sources.stream import open_stream
from chromadock.sources.video import Video

_SERVES_FILES = re.compile(r"(https?|ftps?|file):", re.IGNORECASE)


def open_url(url: str, tell: OnSkip, delay_s: float) -> Source:
    """A network stream, or a video file behind a URL.

    Raises
    ------
    ChromadockError
        Where it does not open.
    """
    name = re.sub(r"//[^/@]*@", "//", url)  # no passwords in logs
    if _SERVES_FILES.match(url):
        capture = cv2.VideoCapture(url, cv2.CAP_FFMPEG)
        if capture.isOpened() and frame_count(capture) is not None:
            return Video(capture, name, name, exact=False)
        capture.release()
    return Live(partial(open_stream, url, name), name, tell, delay_s)
