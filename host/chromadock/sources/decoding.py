"""Decodes the picture stream of a video, and finds out which frames cannot be decoded."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import av
from av.container import InputContainer
from av.video.frame import VideoFrame
from av.video.stream import VideoStream

from chromadock.text import one_line


@dataclass(frozen=True)
class Lost:
    """In the place of a frame that cannot be decoded.

    ``pts`` is its presentation time stamp in units of the stream's ``time_base``, None where
    the container has none.
    """

    pts: int | None


class Decoding:
    """Frames of ``stream``, and a ``Lost`` for each that cannot be decoded, as they are shown.

    Attributes
    ----------
    packets
        How many compressed frames were read from the container so far.
    broken_off
        Why reading the container failed, None where its end was reached.
    """

    def __init__(self, container: InputContainer, stream: VideoStream) -> None:
        self.packets = 0
        self.broken_off: str | None = None
        self._container = container
        self._stream = stream
        self._pending: set[int] = set()
        self._failed: set[int] = set()
        # Threads that work on several frames at once tell of an error some packets later, or,
        # near the end of the file, never; those that share one frame tell at once.
        stream.thread_type = "SLICE"
        if stream.codec_context.name == "mjpeg":
            # Else it fills what is missing of a frame with grey and says nothing.
            stream.codec_context.options = {"err_detect": "explode"}

    def __iter__(self) -> Iterator[VideoFrame | Lost]:
        for packet in self._read():
            yield from self._decode(packet)
        yield from self._decode(None)
        yield from self._overtaken(math.inf)

    def _read(self) -> Iterator[av.Packet[VideoStream]]:
        """Packets of the stream up to the end of the file, or to where it cannot be read."""
        try:
            for packet in self._container.demux(self._stream):
                if packet.size:  # an empty one would tell the decoder that the end has come
                    self.packets += 1
                    yield packet
        except av.FFmpegError as error:
            self.broken_off = one_line(error.strerror)

    def _decode(self, packet: av.Packet[VideoStream] | None) -> Iterator[VideoFrame | Lost]:
        """What the decoder makes of one packet more; of the end, where it is None."""
        stamp = None
        if packet is not None:
            stamp = packet.dts if packet.pts is None else packet.pts
            if stamp is not None and not packet.is_discard:  # outside of the edit: never shown
                self._pending.add(stamp)
                if packet.is_corrupt:  # how a demuxer marks a packet that the file's end cut
                    self._failed.add(stamp)
        try:
            frames = self._stream.decode(packet)
        except av.FFmpegError:
            if stamp is not None:
                self._failed.add(stamp)
            elif packet is not None:
                yield Lost(None)
            return
        for frame in frames:
            shown = frame.dts if frame.pts is None else frame.pts
            if shown is None:
                yield frame
                continue
            yield from self._overtaken(shown)
            self._pending.discard(shown)
            yield Lost(shown) if frame.is_corrupt or shown in self._failed else frame
            self._failed.discard(shown)

    def _overtaken(self, stamp: float) -> Iterator[Lost]:
        """The packets of which no frame came although a later one did.

        Some packets have nothing to show (VP8's hidden references, the place holders of
        packed B frames), so they are lost only together with one that failed: the frames
        after that one, which refer to it, often vanish without an error.
        """
        gone = {waiting for waiting in self._pending if waiting < stamp}
        self._pending -= gone
        if not self._failed.isdisjoint(gone):
            self._failed -= gone
            for lost in sorted(gone):
                yield Lost(lost)
