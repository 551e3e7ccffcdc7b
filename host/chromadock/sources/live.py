"""Cameras and streams: the newest picture wins, and one that went away is waited for."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from chromadock.back_off import FIRST_RETRY_S, LONGEST_RETRY_S
from chromadock.errors import ChromadockError
from chromadock.sources.base import Frame, OnFault, Source, ignore
from chromadock.sources.capture_time import CaptureTime
from chromadock.sources.grabber import Grabber

_STOP_S = 2.0
"""A reader that hangs in a driver for longer is left behind."""

_Taken = tuple[NDArray[np.uint8], int, float]


class Live(Source):
    """Frames of a camera or stream; ``time_s`` is when each was *taken*, not when it was read.

    A thread reads all that comes and keeps the newest frame only: whoever is slower than the
    camera sees fewer frames, never older ones.  ``Frame.index`` counts all that came, ``dropped``
    those that nobody saw.

    Parameters
    ----------
    open_grabber
        Opens the source, at first and each time it went away.  Raises ``ChromadockError`` where
        it does not open, which is passed on at first, and is a reason to try again later.
    name
        Of frames and messages.
    tell
        Takes one line when the source goes away, and one when it is back.
    delay_s
        See ``CaptureTime``.
    """

    live = True

    def __init__(
        self,
        open_grabber: Callable[[], Grabber],
        name: str,
        tell: OnFault = ignore,
        delay_s: float = 0.0,
    ) -> None:
        self._open = open_grabber
        self._name = name
        self._tell = tell
        self._delay_s = delay_s
        self._grabber = open_grabber()
        self.fps = self._grabber.fps
        self.dropped = 0
        self._start_s = time.monotonic()
        self._came = 0
        self._newest: _Taken | None = None
        self._fault: BaseException | None = None
        self._ready = threading.Condition()
        self._stop = threading.Event()
        self._reader: threading.Thread | None = None

    def now(self) -> float:
        """This moment on the clock of the frames' ``time_s``."""
        return time.monotonic() - self._start_s

    def __iter__(self) -> Iterator[Frame]:
        if self._reader is None:
            self._reader = threading.Thread(target=self._read, name=self._name, daemon=True)
            self._reader.start()
        while not self._stop.is_set():
            with self._ready:
                # In turns, so that Ctrl-C is heard on every system.
                while self._newest is None and self._fault is None:
                    self._ready.wait(0.2)
                if self._newest is None:
                    assert self._fault is not None
                    raise self._fault
                (image, index, taken_s), self._newest = self._newest, None
            yield Frame(image, self._name, index, taken_s - self._start_s)

    def close(self) -> None:
        """Let go of the camera or the connection."""
        self._stop.set()
        if self._reader is not None:
            self._reader.join(_STOP_S)
            if self._reader.is_alive():
                return  # closed under its hands a driver may crash; it ends with the program
        self._grabber.close()

    def _read(self) -> None:
        try:
            while not self._stop.is_set():
                self._drain(CaptureTime(self._grabber.monotonic, self._delay_s))
                if not self._stop.is_set():
                    self._wait_for_it()
        except BaseException as error:  # of this thread, for the one that waits
            with self._ready:
                self._fault = error
                self._ready.notify()

    def _drain(self, clock: CaptureTime) -> None:
        """Keep the newest picture, until no more come."""
        while not self._stop.is_set():
            shot = self._grabber.grab()
            if shot is None:
                return
            taken_s = clock.of(shot.stamp_s, time.monotonic())
            with self._ready:
                self.dropped += self._newest is not None
                self._newest = (shot.image, self._came, taken_s)
                self._came += 1
                self._ready.notify()

    def _wait_for_it(self) -> None:
        """Open the source again, however long that takes."""
        lost_s = time.monotonic()
        self._tell(f"{self._name}: delivers no more frames: waiting until it is back")
        self._grabber.close()
        wait_s = FIRST_RETRY_S
        while not self._stop.wait(wait_s):
            try:
                self._grabber = self._open()
            except ChromadockError:
                wait_s = min(2 * wait_s, LONGEST_RETRY_S)
                continue
            self._tell(f"{self._name}: is back after {time.monotonic() - lost_s:.1f} s")
            return
