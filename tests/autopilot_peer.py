"""The other end of a link: speaks and reads as an autopilot does, and flies nothing."""

from __future__ import annotations

import contextlib
import select
import socket
import time
from collections.abc import Callable
from typing import Any

from patience import PATIENCE_S
from pymavlink.dialects.v20 import common as mavlink

SYSTEM, COMPONENT = 7, 1
PERIOD_S = 0.02


class Peer:
    """Heartbeats and attitudes of system 7, as a vehicle of ``mav_type`` sends them.

    ``read`` and ``write`` move bytes; ``messages`` are all that came, in order, ``buffers`` what
    they were made of.
    """

    def __init__(
        self,
        read: Callable[[], bytes],
        write: Callable[[bytes], object],
        mav_type: int,
        autopilot: int = mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
    ) -> None:
        self.messages: list[Any] = []
        self.position: tuple[float, float, float] | None = None
        self.roll, self.yaw = 0.0, 0.0
        self._read, self._write = read, write
        self._heartbeat = mavlink.MAVLink_heartbeat_message(mav_type, autopilot, 0, 0, 4, 3)
        self._parser = mavlink.MAVLink(None)
        self._parser.robust_parsing = True
        self._packer = mavlink.MAVLink(None, SYSTEM, COMPONENT)
        self._booted_s = time.monotonic() - 20.0

    def send(self, message: Any) -> None:
        """Anything."""
        self._write(message.pack(self._packer))
        self._packer.seq = (self._packer.seq + 1) % 256

    def step(self) -> None:
        """A fiftieth of a second of an autopilot's life."""
        ms = round((time.monotonic() - self._booted_s) * 1000)
        self.send(self._heartbeat)
        self.send(mavlink.MAVLink_attitude_message(ms, self.roll, 0.0, self.yaw, 0.0, 0.0, 0.0))
        if self.position is not None:
            still = (0.0, 0.0, 0.0)
            self.send(mavlink.MAVLink_local_position_ned_message(ms, *self.position, *still))
        self.messages += self._parser.parse_buffer(self._read()) or []
        time.sleep(PERIOD_S)

    def until(self, true: Callable[[], Any]) -> None:
        """Step until it is true."""
        end = time.monotonic() + PATIENCE_S
        while not true():
            assert time.monotonic() < end, [str(m) for m in self.messages[-5:]]
            self.step()

    def named(self, name: str) -> list[Any]:
        """What came of one kind."""
        return [message for message in self.messages if message.get_type() == name]


def udp_peer(port: int, mav_type: int, autopilot: int = 3) -> tuple[Peer, socket.socket]:
    """One that sends to ``port`` of this computer, and its socket."""
    end = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    end.connect(("127.0.0.1", port))
    end.setblocking(False)
    return Peer(lambda: waiting(end), lambda data: quietly(end, data), mav_type, autopilot), end


def quietly(end: socket.socket, data: bytes) -> None:
    """Sends; nobody need be there yet."""
    with contextlib.suppress(ConnectionRefusedError):
        end.send(data)


def waiting(end: socket.socket) -> bytes:
    """All bytes that wait at a socket."""
    data = b""
    while select.select([end], [], [], 0)[0]:
        try:
            more = end.recv(65536)
        except ConnectionRefusedError:
            continue
        if not more:
            break
        data += more
    return data


def free_port(kind: int = socket.SOCK_DGRAM) -> int:
    """A port number that nobody has."""
    with socket.socket(socket.AF_INET, kind) as end:
        end.bind(("127.0.0.1", 0))
        return int(end.getsockname()[1])
