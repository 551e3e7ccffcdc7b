"""Video files, and URLs of such."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import cv2

from chromadock.errors import ChromadockError
from chromadock.sources.base import Frame
from chromadock.sources.capture import Capture, frame_count
from chromadock.sources.container import counts_frames, missing_bytes

_TAIL_S = 0.25
"""Sound often outlasts the picture by this much, and makes a guessed count too high."""


class Video(Capture):
    """A video with an end, each frame at its own timestamp.

    At the end it raises ``ChromadockError`` where fewer frames could be decoded than were
    declared.  ``exact`` says that the declared number is not a guess.
    """

    def __init__(self, capture: cv2.VideoCapture, name: str, place: str, exact: bool) -> None:
        super().__init__(capture, name)
        self.count = frame_count(capture)
        self._place = place
        self._exact = exact

    def __iter__(self) -> Iterator[Frame]:
        last = -1.0
        index = 0
        while (image := self.read()) is not None:
            stamp = self._capture.get(cv2.CAP_PROP_POS_MSEC) / 1000
            if not math.isfinite(stamp) or stamp <= last:  # raw streams carry no time
                stamp = 0.0 if index == 0 else last + 1 / self.fps
            yield Frame(image, self._name, index, stamp)
            last = stamp
            index += 1
        self._check_end(index, last)

    def _check_end(self, decoded: int, last_s: float) -> None:
        if decoded == 0:
            raise ChromadockError(
                f"{self._place}: no frame could be decoded: convert the video with ffmpeg"
            )
        if self.count is None or decoded >= self.count:
            return
        short_s = self.count / self.fps - (last_s + 1 / self.fps)
        if self._exact or short_s > _TAIL_S:
            raise ChromadockError(
                f"{self._place}: only {decoded} of {self.count} frames could be decoded: "
                "the video is damaged, so copy it again or repair it with ffmpeg"
            )


def open_video(path: Path) -> Video:
    """Open a video file.

    Raises
    ------
    ChromadockError
        Where it is cut short or no video at all.
    """
    missing = missing_bytes(path)
    if missing:
        raise ChromadockError(
            f"{path}: the video is cut short ({missing} bytes are missing): "
            "copy it again, or repair it with ffmpeg"
        )
    capture = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
    if _is_prose(path) or not capture.isOpened():
        raise ChromadockError(
            f"{path}: cannot be read as a video or picture: check that it is one, and whole"
        )
    video = Video(capture, path.name, str(path), counts_frames(path))
    video.places = frozenset([path])
    return video


def _is_prose(path: Path) -> bool:
    """True for plain text, which FFmpeg would render as the film of a terminal; playlists
    and stream descriptions are text as well, but lead to a video."""
    with path.open("rb") as file:
        head = file.read(4096)
    if head.startswith((b"#EXTM3U", b"v=0")):
        return False
    try:
        text = head.decode("utf-8")
    except UnicodeDecodeError as error:
        if error.start < len(head) - 4:  # else only the last letter is cut
            return False
        text = head[: error.start].decode("utf-8")
    return all(letter.isprintable() or letter.isspace() for letter in text)
