"""Bytes to and from an autopilot, by pymavlink's connections.

They are opened by ``mavutil`` and, of a TCP or a serial port, used directly from then on: its own
methods would print on standard output, and keep to themselves what goes wrong.  Messages are packed
and parsed elsewhere: ``mavutil``'s own parser starts with MAVLink 1.
"""

from __future__ import annotations

import contextlib
import errno
import os
import select
import socket
from typing import Any

from pymavlink import mavutil

from chromadock.autopilot.settings import Address

WRITE_TIMEOUT_S = 0.5
"""A port that takes nothing for so long is as good as gone."""

_CHUNK = 65536


class Transport:
    """An open address.

    Raises
    ------
    OSError
        By this and by every method but ``close``: it cannot be opened, or has gone away.
    """

    def __init__(self, address: Address) -> None:
        self._kind = address.kind
        self._link: Any
        if self._kind == "serial":
            if not os.path.exists(address.place):  # noqa: PTH110 - a device, of which only this
                raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), address.place)
            self._link = mavutil.mavserial(address.place, address.number)
            self._link.port.write_timeout = WRITE_TIMEOUT_S
            self._link.port.exclusive = True
            return
        # Looked up once and here: mavutil would do it at every message, and hide that it failed.
        place = f"{socket.gethostbyname(address.place)}:{address.number}"
        if self._kind == "tcp":
            self._link = mavutil.mavtcp(place, retries=1)
            self._link.port.settimeout(WRITE_TIMEOUT_S)
        else:
            self._link = mavutil.mavudp(place, input=self._kind == "udpin")

    def fileno(self) -> int:
        """For ``select``."""
        return int(self._link.port.fileno())

    def read(self) -> bytes:
        """What has come, without waiting."""
        if self._kind.startswith("udp"):
            return bytes(self._link.recv() or b"")
        if self._kind == "serial":
            return bytes(self._link.port.read(_CHUNK))
        if not select.select([self], [], [], 0)[0]:
            return b""
        data = self._link.port.recv(_CHUNK)
        if not data:
            raise ConnectionResetError(errno.ECONNRESET, os.strerror(errno.ECONNRESET))
        return bytes(data)

    def write(self, data: bytes) -> None:
        """Send ``data``; by UDP to everyone who has sent something, or to the given address."""
        if self._kind.startswith("udp"):
            self._link.write(data)
        elif self._kind == "tcp":
            self._link.port.sendall(data)
        else:
            self._link.port.write(data)

    def close(self) -> None:
        """Let go of the port."""
        with contextlib.suppress(OSError):  # it is gone already
            self._link.close()
