"""What came by topic and waits for the detector: of pictures the newest only."""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import dataclass
from typing import Any

MOST_ORIENTATIONS = 500
"""Of an IMU, while a picture is being looked at: a second at 500 Hz."""


@dataclass(frozen=True, slots=True)
class Arrived:
    """Messages since the last time: the newest picture and CameraInfo, or None, and all of the IMU,
    oldest first."""

    picture: Any | None
    camera_info: Any | None
    orientations: tuple[Any, ...]


class Inbox:
    """One thread puts messages in, another takes them out.

    Attributes
    ----------
    dropped
        Pictures so far that a newer one came after before anybody asked.
    """

    def __init__(self) -> None:
        self.dropped = 0
        self._picture: Any | None = None
        self._info: Any | None = None
        self._orientations: deque[Any] = deque(maxlen=MOST_ORIENTATIONS)
        self._fault: BaseException | None = None
        self._came = threading.Condition()

    def picture(self, message: Any) -> None:
        """Put in a picture."""
        with self._came:
            self.dropped += self._picture is not None
            self._picture = message
            self._came.notify()

    def camera_info(self, message: Any) -> None:
        """Put in a CameraInfo."""
        with self._came:
            self._info = message

    def orientation(self, message: Any) -> None:
        """Put in a message of an IMU."""
        with self._came:
            self._orientations.append(message)

    def fail(self, error: BaseException) -> None:
        """Have the other thread know what ended the one that puts messages in."""
        with self._came:
            self._fault = error
            self._came.notify()

    def take(self, timeout_s: float) -> Arrived:
        """All that came, as soon as there is a picture, or what there is after ``timeout_s``.

        Raises
        ------
        BaseException
            What the thread failed of that puts messages in.
        """
        with self._came:
            self._came.wait_for(lambda: self._picture is not None or self._fault, timeout_s)
            if self._fault is not None:
                raise self._fault
            arrived = Arrived(self._picture, self._info, tuple(self._orientations))
            self._picture = self._info = None
            self._orientations.clear()
        return arrived
