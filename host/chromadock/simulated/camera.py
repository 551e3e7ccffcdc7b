"""The simulated dock's camera: QQVGA frames in RGB565 from any source, again and again."""

from __future__ import annotations

from collections.abc import Generator
from threading import Event, Thread
from typing import Protocol

import numpy as np

from chromadock.errors import ChromadockError
from chromadock.link.rgb565 import HEIGHT, WIDTH, to_qqvga, to_rgb565
from chromadock.sources import Source, open_source

WATER_BGR = (200, 160, 40)
"""Blue water, where no source is given."""


class Camera(Protocol):
    """Gives frames of 160x120 in RGB565, big-endian."""

    def frame(self) -> bytes:
        """The frame of now.

        Raises
        ------
        ChromadockError
            Where the source breaks off.
        """

    def close(self) -> None:
        """Let go of the source."""


def open_camera(source: str | None) -> Camera:
    """Frames of ``source``, see ``chromadock.sources``; plain blue water where it is None.

    Files start again at their end; live sources give their newest frame.

    Raises
    ------
    ChromadockError
        Where the source does not open.
    """
    if source is None:
        return PlainWater()
    opened = open_source(source)
    return LiveCamera(opened) if opened.live else Recording(opened, source)


class PlainWater:
    """The same colour for ever."""

    def __init__(self) -> None:
        self._data = to_rgb565(np.full((HEIGHT, WIDTH, 3), WATER_BGR, np.uint8))

    def frame(self) -> bytes:
        """See ``Camera``."""
        return self._data

    def close(self) -> None:
        """See ``Camera``."""


class Recording:
    """Pictures or a video, frame by frame, from the start again at the end."""

    def __init__(self, opened: Source, name: str) -> None:
        self._opened = opened
        self._name = name
        self._frames = self._endless()

    def frame(self) -> bytes:
        """See ``Camera``."""
        return next(self._frames)

    def close(self) -> None:
        """See ``Camera``."""
        self._frames.close()
        self._opened.close()

    def _endless(self) -> Generator[bytes, None, None]:
        while True:
            count = 0
            for frame in self._opened:
                count += 1
                yield to_rgb565(to_qqvga(frame.image))
            if count == 0:
                raise ChromadockError(f"{self._name}: no frame can be read: give another source")
            self._opened.close()
            self._opened = open_source(self._name)


class LiveCamera:
    """The newest frame of a source that keeps its own pace."""

    def __init__(self, opened: Source) -> None:
        self._opened = opened
        self._stop = Event()
        self._fault: ChromadockError | None = None
        frames = iter(opened)
        self._newest = to_rgb565(to_qqvga(next(frames).image))
        # Waiting for it here would hold up the serial port.
        self._thread = Thread(target=self._follow, daemon=True)
        self._thread.start()

    def frame(self) -> bytes:
        """See ``Camera``."""
        if self._fault is not None:
            raise self._fault
        return self._newest

    def close(self) -> None:
        """See ``Camera``."""
        self._stop.set()
        self._thread.join(1.0)
        self._opened.close()

    def _follow(self) -> None:
        try:
            for frame in self._opened:
                self._newest = to_rgb565(to_qqvga(frame.image))
                if self._stop.is_set():
                    return
        except ChromadockError as error:
            self._fault = error
