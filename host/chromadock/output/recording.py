"""A recording of all that a run saw and found."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.output.base import cannot_write
from chromadock.output.jsonlines import json_line
from chromadock.output.mcap_file import McapFile
from chromadock.output.results import ResultOutput, result_record
from chromadock.output.run_setup import RunSetup
from chromadock.results.detection import Detection
from chromadock.ros.topics import messages
from chromadock.sources import Frame

CHUNK_S = 0.25
"""So much of the run is in memory only."""
SYNC_S = 0.5
"""About so often what the system has is put on the disk; both together are less than a second."""
MOST_WAITING_BYTES = 64_000_000
"""Of pictures that wait for a slow disk: two seconds at 640 x 480 and 30 frames a second."""

_Waiting = tuple[Frame, Detection, float | None, int]


class Recording(ResultOutput):
    """Writes frames, attitudes, results and settings while the run goes on; see docs/recording.md.

    The settings stand at the start, and the file can be read up to its last whole piece though
    nothing came after that: neither a kill nor the loss of power takes more than the last second,
    and what waits for a disk or a computer that cannot keep up.
    A thread encodes and writes; ``write`` waits for the disk only where no camera waits for us.

    Parameters
    ----------
    path
        Of the new file; ``Recording.path`` tells what it became, as none is overwritten.
    setup
        What the run was set to; None where nobody knows.

    Raises
    ------
    ChromadockError
        Where there can be no such file, or one of the setup cannot be read.
    """

    def __init__(self, path: Path, setup: RunSetup | None = None) -> None:
        self._camera = None if setup is None else setup.camera
        self._file = McapFile(path, {} if setup is None else setup.files())
        self.path = self._file.path
        self._opened_ns = time.time_ns()
        self._start_ns: int | None = None
        self._any = False
        self._next_index = 0
        self._dropped = 0
        self._queue: deque[_Waiting] = deque()
        self._waiting_bytes = 0
        self._full: OSError | None = None
        self._bug: BaseException | None = None
        self._closing = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._work, name=str(path), daemon=True)
        self._thread.start()

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        """Have a frame and its result written.

        Raises
        ------
        ChromadockError
            Where the disk is full, or too slow for a camera; the frame is not in the file then.
        """
        stamp_ns = self._stamp(frame, age_s)
        size = frame.image.nbytes
        with self._changed:
            self._check()
            while self._queue and self._waiting_bytes + size > MOST_WAITING_BYTES:
                if age_s is not None:
                    raise ChromadockError(
                        f"{self.path}: the disk is too slow to record every frame: use a faster "
                        "one, or a smaller picture"
                    )
                self._changed.wait()
                self._check()
            self._queue.append((frame, detection, age_s, stamp_ns))
            self._waiting_bytes += size
            self._changed.notify_all()

    def close(self) -> None:
        """Write what waits, and the index.

        Raises
        ------
        ChromadockError
            Where the disk is full; what was written before can be read.
        """
        with self._changed:
            self._closing = True
            self._changed.notify_all()
        self._thread.join()
        self._file.close()
        self._check()

    def _check(self) -> None:
        """Raise what befell the thread."""
        if self._bug is not None:
            raise self._bug
        if self._full is not None:
            raise cannot_write(self.path, self._full)

    def _stamp(self, frame: Frame, age_s: float | None) -> int:
        """When the frame was taken, Unix nanoseconds.

        The wall clock is asked once: after that times are as far apart as the source has them,
        whoever sets that clock.  What is no live picture counts from the opening.
        """
        since_ns = round(frame.time_s * 1e9)
        if self._start_ns is None:
            self._start_ns = self._opened_ns
            if age_s is not None:
                self._start_ns = time.time_ns() - round(age_s * 1e9) - since_ns
        return self._start_ns + since_ns

    def _work(self) -> None:
        """The thread: encode what comes, give it to the system, and that to the disk."""
        try:
            self._try(self._file.flush)  # the settings
            synced_s = time.monotonic()
            while self._take(time.monotonic() + CHUNK_S):
                self._try(self._file.flush)
                if time.monotonic() - synced_s >= SYNC_S:
                    self._try(self._file.sync)
                    synced_s = time.monotonic()
            self._try(self._file.finish)
        except BaseException as error:  # of this thread, for the one that waits
            self._bug = error
        with self._changed:
            self._changed.notify_all()

    def _take(self, until_s: float) -> bool:
        """Encode what comes until then, on the monotonic clock; False once all is done."""
        while True:
            with self._changed:
                while not (self._queue or self._closing) or self._full is not None:
                    left_s = until_s - time.monotonic()
                    if left_s <= 0 or (self._closing and self._full is not None):
                        return not self._closing
                    self._changed.wait(left_s)
                if not self._queue:
                    return False
                frame, detection, age_s, stamp_ns = self._queue.popleft()
            self._put(frame, detection, age_s, stamp_ns)
            with self._changed:
                self._waiting_bytes -= frame.image.nbytes
                self._changed.notify_all()
            if time.monotonic() >= until_s:
                return True

    def _put(self, frame: Frame, detection: Detection, age_s: float | None, stamp_ns: int) -> None:
        if not self._any:
            self._file.start(stamp_ns - round(frame.time_s * 1e9))
            self._any = True
        self._dropped += max(frame.index - self._next_index, 0)
        self._next_index = frame.index + 1
        line = json_line(result_record(frame, detection, age_s))
        parts = messages(
            frame.image,
            frame.attitude,
            detection,
            line,
            age_s,
            stamp_ns,
            self._camera,
            self._dropped,
        )
        for topic, fields in parts:
            self._file.put(topic, fields, stamp_ns, frame.index)

    def _try(self, what: Callable[[], None]) -> None:
        """Remember whether the disk did it, for the next ``write``."""
        full = None
        try:
            what()
        except OSError as error:
            full = error
        with self._changed:
            self._full = full
            self._changed.notify_all()
