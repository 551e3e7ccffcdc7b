"""The simulated dock's port: a pseudo-terminal, or a TCP port of this computer."""

from __future__ import annotations

import contextlib
import os
import select
import socket
import tty
from abc import ABC, abstractmethod
from ipaddress import ip_address

from chromadock.errors import ChromadockError

_CHUNK = 4096


class Port(ABC):
    """Like a serial port without handshake: what nobody reads is lost.

    ``url`` is what ``--port`` takes.
    """

    url: str

    @abstractmethod
    def read(self, timeout_s: float) -> bytes:
        """What has come, after waiting at most ``timeout_s`` seconds for it."""

    @abstractmethod
    def write(self, data: bytes) -> int:
        """How many bytes went out; the others the reader was too slow for."""

    @abstractmethod
    def close(self) -> None:
        """Let go of the port."""


class PtyPort(Port):
    """A pseudo-terminal; clients may come and go."""

    def __init__(self) -> None:
        # The other end stays open here as well, or the first client to leave would end it.
        self._fd, self._other = os.openpty()
        tty.setraw(self._other)
        os.set_blocking(self._fd, False)
        self.url = os.ttyname(self._other)

    def read(self, timeout_s: float) -> bytes:
        """See ``Port``."""
        select.select([self._fd], [], [], timeout_s)
        try:
            return os.read(self._fd, _CHUNK)
        except BlockingIOError:
            return b""

    def write(self, data: bytes) -> int:
        """See ``Port``."""
        try:
            return os.write(self._fd, data)
        except BlockingIOError:
            return 0

    def close(self) -> None:
        """See ``Port``."""
        os.close(self._fd)
        os.close(self._other)


class TcpPort(Port):
    """One client at a time, as on a cable; a second one is turned away.

    Raises
    ------
    ChromadockError
        Where the address is not of this computer, or the port is taken.
    """

    def __init__(self, address: str) -> None:
        host, number = _parsed(address)
        self._client: socket.socket | None = None
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        self._server = socket.socket(family)
        self._server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self._server.bind((host, number))
        except OSError as error:
            self._server.close()
            raise ChromadockError(
                f"--tcp {address}: cannot listen there ({error.strerror}): choose another port, "
                "0 for any"
            ) from None
        self._server.listen()
        self._server.setblocking(False)
        shown = f"[{host}]" if ":" in host else host
        self.url = f"socket://{shown}:{self._server.getsockname()[1]}"

    def read(self, timeout_s: float) -> bytes:
        """See ``Port``."""
        waiting = [self._server] if self._client is None else [self._server, self._client]
        ready, _, _ = select.select(waiting, [], [], timeout_s)
        if self._client is None or self._client not in ready:
            # Only now: who left with a last word, and is back already, must not meet himself.
            if self._server in ready:
                self._accept()
            return b""
        try:
            data = self._client.recv(_CHUNK)
        except BlockingIOError:
            return b""
        except OSError:
            data = b""
        if not data:
            self._drop()
        return data

    def write(self, data: bytes) -> int:
        """See ``Port``."""
        if self._client is None:
            return len(data)
        try:
            return self._client.send(data)
        except BlockingIOError:
            return 0
        except OSError:
            self._drop()
            return len(data)

    def close(self) -> None:
        """See ``Port``."""
        self._drop()
        self._server.close()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            client, _ = self._server.accept()
            if self._client is not None:
                client.close()
                return
            client.setblocking(False)
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._client = client

    def _drop(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None


def _parsed(address: str) -> tuple[str, int]:
    host, colon, number = address.rpartition(":")
    host = host.strip("[]")
    if not colon or not (number.isascii() and number.isdigit()) or int(number) > 0xFFFF:
        raise ChromadockError(f"--tcp {address}: give HOST:PORT, for example localhost:5760")
    host = "127.0.0.1" if host in ("", "localhost") else host
    try:
        loopback = ip_address(host).is_loopback
    except ValueError:
        loopback = False
    if not loopback:
        raise ChromadockError(
            f"--tcp {address}: anyone could command it there: only localhost is allowed"
        )
    return host, int(number)
