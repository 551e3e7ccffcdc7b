"""One open port: its bytes for the messages, for pytest-embedded, and for the log."""

from __future__ import annotations

import select
import threading
import time
from collections.abc import Callable
from pathlib import Path

import serial

CHUNK = 65536
ROM_BAUD = 115200
"""The chip's boot loader speaks at this speed, whatever the firmware does."""


class Wire:
    """Reads in a thread, so that bytes are stamped when they come.

    It stands in for ``chromadock.link.Connection`` (``url``, ``read``, ``write``,
    ``close``), and feeds any number of listeners beside that.
    """

    def __init__(self, url: str, baud: int, log: Path) -> None:
        log.parent.mkdir(parents=True, exist_ok=True)
        self.log = log
        self._log = log.open("a", encoding="ascii", buffering=1)
        self._start = time.monotonic()
        self.url = url
        # Opening must not reset the board; another program at it is an error.
        self.port = serial.serial_for_url(
            url, do_not_open=True, baudrate=baud, timeout=0, write_timeout=5, exclusive=True
        )
        self.port.dtr = False
        self.port.rts = False
        self.port.open()
        self.baud = baud
        self.note(f"opened {url} at {baud} Bd")
        self._bytes = bytearray()
        self._changed = threading.Condition()
        self._listeners: list[Callable[[bytes], None]] = []
        self._fault: OSError | None = None
        self._closing = False
        self._thread = threading.Thread(target=self._follow, daemon=True)
        self._thread.start()

    def read(self, timeout_s: float) -> bytes:
        """What has come, after waiting at most ``timeout_s`` seconds for the first byte."""
        with self._changed:
            self._changed.wait_for(lambda: self._bytes or self._fault, max(timeout_s, 0.0))
            if self._fault is not None and not self._bytes:
                raise self._fault
            data = bytes(self._bytes)
            self._bytes.clear()
        return data

    def write(self, data: bytes) -> None:
        """Send all of it."""
        self._write_log(">", data)
        self.port.write(data)

    def written(self) -> float:
        """Wait until all bytes are out; the time then, as ``time.monotonic`` gives it."""
        self.port.flush()
        return time.monotonic()

    def listen(self, listener: Callable[[bytes], None]) -> Callable[[], None]:
        """Give ``listener`` all that comes from now on, until the returned function is called."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def pulse_reset(self) -> None:
        """The reset line of an ESP32-CAM-MB; DTR would ask for a download."""
        self.note("reset by RTS")
        self.port.dtr = False
        self.port.rts = True
        time.sleep(0.1)
        self.port.rts = False

    def speed(self, baud: int) -> None:
        """Change the port's speed; the simulated dock has none."""
        self.port.baudrate = baud

    def note(self, text: str) -> None:
        """Put a line into the log."""
        self._log.write(f"{time.monotonic() - self._start:12.6f} # {text}\n")

    def close(self) -> None:
        """Let go of the port, with its lines released."""
        self._closing = True
        self._thread.join()
        self.port.close()
        self.note("closed")
        self._log.close()

    def _follow(self) -> None:
        while not self._closing:
            try:
                if not select.select([self.port.fileno()], [], [], 0.05)[0]:
                    continue
                data = self.port.read(CHUNK)
            except (OSError, TypeError) as error:  # unplugged
                with self._changed:
                    self._fault = OSError(f"{self.url}: the port went away ({error})")
                    self._changed.notify_all()
                return
            self._write_log("<", data)
            for listener in list(self._listeners):
                listener(data)
            with self._changed:
                self._bytes += data
                self._changed.notify_all()

    def _write_log(self, direction: str, data: bytes) -> None:
        if data:
            self._log.write(f"{time.monotonic() - self._start:12.6f} {direction} {data.hex()}\n")


class Tap(serial.SerialBase):
    """The port that pytest-embedded sees: opening and closing it leaves the wire alone,
    for every opening of the real one may reset the board."""

    def __init__(self, wire: Wire) -> None:
        super().__init__()
        self._wire = wire
        self._port = self.name = wire.url
        self._heard = bytearray()
        self._lock = threading.Lock()
        self._leave = wire.listen(self._take)
        self.is_open = True

    def read_all(self) -> bytes:
        """What has come since the last call."""
        with self._lock:
            data = bytes(self._heard)
            self._heard.clear()
        return data

    def write(self, data: bytes) -> int:
        """Send it over the wire."""
        self._wire.write(data)
        return len(data)

    def close(self) -> None:
        """Hear no more."""
        if self.is_open:
            self.is_open = False
            self._leave()

    def _take(self, data: bytes) -> None:
        with self._lock:
            self._heard += data

    def _reconfigure_port(self, force_update: bool = False) -> None:
        """Leave the wire as it is."""
