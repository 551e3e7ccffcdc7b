"""Results as JSON lines, into a file that is whole at every moment or in datagrams."""

from __future__ import annotations

import os
import socket
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.output.base import cannot_write
from chromadock.output.jsonlines import json_line
from chromadock.output.results import ResultOutput, result_record
from chromadock.results.detection import Detection
from chromadock.sources import Frame


class LinesFile(ResultOutput):
    """A line a frame, appended at once: a log that a kill or a full disk cannot spoil.

    What is in the file already stays: a vehicle that is started again goes on in its log.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._file = path.open("ab", buffering=0)
        except OSError as error:
            raise cannot_write(path, error) from None

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        """Append a whole line, or nothing."""
        line = json_line(result_record(frame, detection, age_s)).encode() + b"\n"
        end = os.fstat(self._file.fileno()).st_size
        try:
            written = self._file.write(line)
        except OSError as error:
            raise cannot_write(self._path, error) from None
        if written != len(line):
            os.truncate(self._file.fileno(), end)
            raise ChromadockError(f"{self._path}: the disk is full: make room")

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class LinesUdp(ResultOutput):
    """A datagram a frame, sent whether anybody listens or not."""

    def __init__(self, host: str, port: int) -> None:
        self._name = f"udp:{host}:{port}"
        try:
            found = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)
        except OSError:
            raise ChromadockError(
                f"--out {self._name}: no such host: give its address, such as udp:192.168.2.1:9000"
            ) from None
        family, kind, *_, address = found[0]
        self._address = address
        self._socket = socket.socket(family, kind)
        self._socket.setblocking(False)

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        """Send one datagram."""
        line = json_line(result_record(frame, detection, age_s)).encode()
        try:
            self._socket.sendto(line, self._address)
        except OSError as error:
            # What nobody listens for is told by the answer to the datagram before.
            if not isinstance(error, ConnectionRefusedError):
                raise ChromadockError(
                    f"{self._name}: cannot be reached ({error.strerror})"
                ) from None

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()
