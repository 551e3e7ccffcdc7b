"""A serial port by any pyserial URL, opened so that the board is not held in reset."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import select
import threading
import time
from pathlib import Path
from typing import Any, TextIO

import serial

from chromadock.closable import Closable
from chromadock.errors import ChromadockError
from chromadock.output.base import cannot_write
from chromadock.text import one_line

BAUD = 921600
OPEN_TIMEOUT_S = 2.0
WRITE_TIMEOUT_S = 2.0
_CHUNK = 65536
_POLL_S = 0.005


class Connection(Closable):
    """Bytes to and from a port; a context manager.

    Parameters
    ----------
    url
        A device, or any URL that pyserial knows: ``socket://host:port``,
        ``rfc2217://host:port``, ``spy://...``; ``tcp:host:port``, as MAVLink programs write
        it, is ``socket://host:port``.
    baud
        Bits a second, where the port has such a thing.
    log
        Gets a line for each piece of bytes: seconds since the opening, ``<`` from the dock
        or ``>`` to it, hexadecimal.

    Raises
    ------
    ChromadockError
        One line: no such port, in use, no permission, not a port.
    """

    def __init__(self, url: str, baud: int = BAUD, log: Path | None = None) -> None:
        self.url = url
        self._log: TextIO | None = None
        self._start = time.monotonic()
        self._port = _opened(url, baud)
        if log is not None:
            try:
                self._log = log.open("w", encoding="ascii", buffering=1)
            except OSError as error:
                self.close()
                raise cannot_write(log, error) from None

    def read(self, timeout_s: float) -> bytes:
        """What has come, after waiting at most ``timeout_s`` seconds for the first byte.

        Raises
        ------
        ChromadockError
            Where the port went away.
        """
        try:
            data = self._read(max(timeout_s, 0.0))
        except (OSError, TypeError, ValueError) as error:  # pyserial's own are OSErrors
            raise self._gone(error) from None
        if data:
            self._write_log("<", data)
        return data

    def write(self, data: bytes) -> None:
        """Send all of ``data``.

        Raises
        ------
        ChromadockError
            Where the port went away, or takes nothing for two seconds.
        """
        self._write_log(">", data)
        try:
            self._port.write(data)
        except serial.SerialTimeoutException:
            raise ChromadockError(
                f"{self.url}: takes no bytes: check that a dock is at its other end"
            ) from None
        except (OSError, TypeError, ValueError) as error:
            raise self._gone(error) from None

    def close(self) -> None:
        """Let go of the port and finish the log."""
        with contextlib.suppress(OSError):  # it is gone already
            self._port.close()
        if self._log is not None:
            self._log.close()
            self._log = None

    def _read(self, timeout_s: float) -> bytes:
        try:
            select.select([self._port.fileno()], [], [], timeout_s)
        except (AttributeError, OSError) as error:
            if isinstance(error, OSError) and error.errno is not None:
                raise
            # No file behind it (loop://): nothing to wait on but time.
            end = time.monotonic() + timeout_s
            while not self._port.in_waiting and time.monotonic() < end:
                time.sleep(_POLL_S)
        data = bytearray(self._port.read(_CHUNK))
        while self._port.in_waiting:  # rfc2217:// gives but one byte at a time
            more = self._port.read(_CHUNK)
            if not more:
                break
            data += more
        return bytes(data)

    def _gone(self, error: Exception) -> ChromadockError:
        return ChromadockError(
            f"{self.url}: the port went away ({_reason(error)}): "
            "check the cable and the dock's power, then try again"
        )

    def _write_log(self, direction: str, data: bytes) -> None:
        if self._log is not None:
            self._log.write(f"{time.monotonic() - self._start:12.6f} {direction} {data.hex()}\n")


def _opened(url: str, baud: int) -> Any:
    """The open port, within ``OPEN_TIMEOUT_S`` or not at all."""
    result: list[Any] = []

    def run() -> None:
        try:
            result.append(_open(url, baud))
        except Exception as error:
            result.append(error)

    # A network address that swallows everything would hold us for longer.
    opener = threading.Thread(target=run, daemon=True)
    opener.start()
    opener.join(OPEN_TIMEOUT_S)
    if not result:
        raise ChromadockError(f"{url}: does not open: check the address and the cable")
    if isinstance(result[0], ChromadockError):
        raise result[0]
    if isinstance(result[0], Exception):
        raise _cannot_open(url, result[0]) from None
    return result[0]


def _open(url: str, baud: int) -> Any:
    address = _pyserial_url(url)
    port = serial.serial_for_url(
        address,
        do_not_open=True,
        baudrate=baud,
        timeout=0,
        # The one kind of port that refuses to be opened with it.
        write_timeout=None if address.startswith("rfc2217:") else WRITE_TIMEOUT_S,
        exclusive=True,
    )
    # Asserted RTS holds the ESP32-CAM-MB board in reset, DTR makes it wait for a download.
    port.dtr = False
    port.rts = False
    port.open()
    return port


def _pyserial_url(url: str) -> str:
    """``tcp:host:port`` as pyserial writes it.

    Raises
    ------
    ChromadockError
        For the addresses of MAVLink programs that no serial port can have.
    """
    kind, colon, rest = url.partition(":")
    if "://" in url or not colon:
        return url
    if kind == "tcp":
        return f"socket://{rest}"
    if kind in ("udp", "udpin", "udpout", "udpbcast", "tcpin", "mcast"):
        raise ChromadockError(
            f"{url}: no serial port: give a device such as /dev/ttyUSB0, or tcp:HOST:PORT of a "
            "program that listens there"
        )
    return url


def _cannot_open(url: str, error: Exception) -> ChromadockError:
    number = error.errno if isinstance(error, OSError) else None
    text = str(error)
    if number is None and (found := re.search(r"\[Errno (\d+)\]", text)):
        number = int(found.group(1))
    if "://" not in url and number == errno.ENOENT:
        return ChromadockError(
            f"{url}: no such port: check the cable and `ls /dev/ttyUSB* /dev/ttyACM*`, "
            "or leave out --port"
        )
    if number in (errno.EACCES, errno.EPERM):
        return ChromadockError(
            f"{url}: permission denied: run `sudo usermod -aG dialout $USER`, then log in again"
        )
    if number in (errno.EAGAIN, errno.EBUSY):
        return ChromadockError(
            f"{url}: in use by another program: close it (`fuser {url}` tells which)"
        )
    if number == errno.ECONNREFUSED:
        return ChromadockError(
            f"{url}: nothing listens there: start it first, or check host and port number"
        )
    return ChromadockError(
        f"{url}: cannot be opened as a serial port ({_reason(error)}): "
        "give a device such as /dev/ttyUSB0 or a URL such as socket://localhost:5760"
    )


def _reason(error: Exception) -> str:
    if isinstance(error, OSError) and error.errno and not isinstance(error, serial.SerialException):
        return os.strerror(error.errno)
    return one_line(error, 100) or type(error).__name__
