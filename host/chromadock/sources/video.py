"""The frames of a video."""

from __future__ import annotations

from collections.abc import Iterator

import av
import cv2
import numpy as np
from av.container import InputContainer
from av.video.frame import VideoFrame
from av.video.reformatter import VideoReformatter
from av.video.stream import VideoStream
from numpy.typing import NDArray

from chromadock.choices import DEFAULT_FPS
from chromadock.errors import ChromadockError
from chromadock.sources.base import Frame, OnFault, Source, ignore
from chromadock.sources.decoding import Decoding, Lost
from chromadock.sources.depth import Depth
from chromadock.sources.mosaic import check_no_mosaic
from chromadock.text import plural

_TURNS = {
    90: cv2.ROTATE_90_COUNTERCLOCKWISE,
    -90: cv2.ROTATE_90_CLOCKWISE,
    180: cv2.ROTATE_180,
    -180: cv2.ROTATE_180,
}
"""By the degrees, counterclockwise, that a phone wrote beside its upright or flipped frames."""


class Video(Source):
    """A video with an end, each frame at its own time stamp, counted from the stream's start.

    Frames that cannot be decoded are reported, counted in ``errors`` and left out; their index
    stays free.  Whether the end is missing is told after the last frame that there is.

    Parameters
    ----------
    container
        As PyAV opened it; this closes it.
    stream
        The one that is shown.
    name
        Stands in frames.
    place
        Stands in messages.
    on_fault
        Called with one line for each fault.
    on_note
        Called with one line for what had to be assumed.
    missing
        How many bytes are announced beyond the file's end.
    """

    def __init__(
        self,
        container: InputContainer,
        stream: VideoStream,
        name: str,
        place: str,
        on_fault: OnFault,
        on_note: OnFault = ignore,
        missing: int = 0,
    ) -> None:
        rate = stream.average_rate or stream.base_rate
        self.fps = float(rate) if rate and 0 < rate <= 1000 else DEFAULT_FPS
        self.count = _expected(container, stream, self.fps)
        self._container = container
        self._stream = stream
        self._name = name
        self._place = place
        self._on_fault = on_fault
        self._depth = Depth(on_note)
        self._missing = missing
        self._listed = sum(entry.size > 0 for entry in stream.index_entries)

    def __iter__(self) -> Iterator[Frame]:
        decoding = Decoding(self._container, self._stream)
        converter = VideoReformatter()
        lost: list[tuple[int, float]] = []  # since the last frame
        decoded, last, shown = 0, -1.0, 0.0
        for index, item in enumerate(decoding):
            last = self._time(item.pts, last, index)
            image = None if isinstance(item, Lost) else self._image(item, converter)
            if image is None:
                lost.append((index, last))
            else:
                self._tell(lost)
                lost = []
                decoded += 1
                shown = last
                if decoded == 1:
                    check_no_mosaic(image, self._place)
                yield Frame(image, self._name, index, last)
        if not decoded:
            raise self._nothing()
        if self._missing or decoding.broken_off:
            self._tell_cut(decoded, shown, decoding.broken_off)
        else:
            self._tell(lost)
            self._tell_gaps(decoding.packets)

    def _image(self, frame: VideoFrame, converter: VideoReformatter) -> NDArray[np.uint8] | None:
        """HxWx3 uint8 BGR, turned as the camera was held; None where it cannot be converted."""
        if frame.format.name.startswith("gray16"):
            image = self._depth.bgr(frame.to_ndarray().astype(np.uint16, copy=False), self._place)
        else:
            try:
                # Threads of its own cost more than they bring.
                plain = converter.reformat(
                    frame, format="bgr24", interpolation="BICUBIC", threads=1
                )
            except av.FFmpegError:
                return None
            image = np.asarray(plain.to_ndarray(), np.uint8)
        turn = _TURNS.get(frame.rotation)
        return image if turn is None else np.asarray(cv2.rotate(image, turn), np.uint8)

    def _time(self, pts: int | None, last_s: float, index: int) -> float:
        """Seconds from the stream's start; a frame's length after the last where none is told,
        as in raw streams, or where it would not be later."""
        start, base = self._stream.start_time, self._stream.time_base
        if pts is not None and base is not None:
            time_s = float((pts - (start or 0)) * base)
            if time_s > last_s and time_s >= 0:
                return time_s
        return 0.0 if index == 0 else last_s + 1 / self.fps

    def _nothing(self) -> ChromadockError:
        if self._missing:
            return nothing_left(self._place, self._missing)
        return ChromadockError(
            f"{self._place}: no frame could be decoded: convert the video with ffmpeg"
        )

    def _tell(self, lost: list[tuple[int, float]]) -> None:
        """Report frames in a row that could not be decoded."""
        if not lost:
            return
        self.errors += len(lost)
        (first, start_s), (last, end_s) = lost[0], lost[-1]
        which = f"frame {first} at {start_s:.3f} s"
        if len(lost) > 1:
            which = f"frames {first} to {last} from {start_s:.3f} to {end_s:.3f} s"
        self._on_fault(
            f"{self._place}: {which} cannot be decoded: copy the video again, "
            "or do without (skipped)"
        )

    def _tell_cut(self, frames: int, last_s: float, reason: str | None) -> None:
        """Report that the end is missing."""
        self.cut_short = True
        why = f"{self._missing} bytes are missing" if self._missing else reason
        self._on_fault(
            f"{self._place}: the video is cut short after {last_s:.3f} s ({why}): "
            f"{plural(frames, 'frame')} could be used; copy it again for the rest"
        )

    def _tell_gaps(self, packets: int) -> None:
        """Report what the container's index lists and the container does not have."""
        if packets < self._listed:
            gone = self._listed - packets
            self.errors += gone
            self._on_fault(
                f"{self._place}: {gone} of the {self._listed} frames in the video's index are "
                "not where it says: copy it again, or do without (skipped)"
            )

    def close(self) -> None:
        """Let go of the file."""
        self._container.close()


def nothing_left(place: str, missing: int) -> ChromadockError:
    """The error for a video that was cut so short that it has no frame."""
    return ChromadockError(
        f"{place}: the video is cut short ({missing} bytes are missing), "
        "and nothing of what is left can be read: copy it again"
    )


def _expected(container: InputContainer, stream: VideoStream, fps: float) -> int | None:
    """About how many frames there are; neither the header's number nor the duration, which
    may be the sound's, is a promise."""
    if stream.frames > 0:
        return stream.frames
    if stream.duration is not None and stream.time_base is not None:
        seconds = float(stream.duration * stream.time_base)
    elif container.duration is not None:
        seconds = container.duration / av.time_base
    else:
        return None
    return max(1, round(seconds * fps)) if seconds > 0 else None
