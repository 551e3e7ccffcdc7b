"""Network streams, through FFmpeg's libraries."""

from __future__ import annotations

from collections.abc import Iterator

import av
import numpy as np
from av.format import Flags

from chromadock.choices import DEFAULT_FPS
from chromadock.errors import ChromadockError
from chromadock.sources.grabber import Grabber, Shot

OPEN_S = 10.0
READ_S = 5.0
"""A stream that says nothing for so long is gone."""

_OPTIONS = {
    "fflags": "nobuffer",  # FFmpeg keeps nothing back that has come
    "flags": "low_delay",
    "rtsp_transport": "tcp",  # a lost packet of UDP spoils the picture up to the next key frame
}


class Stream(Grabber):
    """An opened network stream; stamps are its own presentation times.

    Some forms have none, such as a web camera's Motion JPEG; FFmpeg counts 25 pictures a second
    there, however many come.
    """

    def __init__(self, container: av.container.InputContainer) -> None:
        self._container = container
        self._video = container.streams.video[0]
        self._stamped = Flags.no_timestamps not in Flags(container.format.flags)
        # Threads that decode whole frames side by side hold back as many frames as they are.
        self._video.codec_context.thread_type = "SLICE"
        rate = self._video.average_rate or self._video.guessed_rate
        self.fps = float(rate) if rate else DEFAULT_FPS
        self._shots = self._decoded()

    def grab(self) -> Shot | None:
        """Wait for the next picture; None where the stream has ended or broken off."""
        try:
            return next(self._shots, None)
        except (av.error.FFmpegError, OSError):
            return None

    def close(self) -> None:
        """End the connection."""
        self._container.close()

    def _decoded(self) -> Iterator[Shot]:
        for packet in self._container.demux(self._video):
            try:
                frames = packet.decode()
            except av.error.InvalidDataError:
                continue  # begun in the middle, or a packet was lost: later ones are whole again
            for frame in frames:
                image = np.asarray(frame.to_ndarray(format="bgr24"), np.uint8)
                yield Shot(image, frame.time if self._stamped else None)


def open_stream(url: str, name: str) -> Stream:
    """Connect to a stream.

    Raises
    ------
    ChromadockError
        Where nobody answers, or what is sent has no picture.
    """
    try:
        container = av.open(url, options=_OPTIONS, timeout=(OPEN_S, READ_S))
    except (av.error.FFmpegError, OSError, ValueError):
        raise ChromadockError(
            f"{name}: does not open: check the address, and that the stream runs"
        ) from None
    if not container.streams.video:
        container.close()
        raise ChromadockError(f"{name}: has no picture, only sound or data: check the address")
    return Stream(container)
