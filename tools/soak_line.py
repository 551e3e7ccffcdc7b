"""A bad line between a dock and a client: it damages bytes both ways, and listens in where
they are still whole."""

from __future__ import annotations

import random
import select
import socket
from collections.abc import Callable
from typing import Any

from chromadock import dialect
from chromadock.link.framing import FrameFinder
from chromadock.simulated.damage import Damage

CHUNK = 65536


class BadLine:
    """One client at ``url``, the dock at ``dock_url`` behind it.

    Attributes
    ----------
    moved
        Bytes towards the client and towards the dock.
    damaged
        How many of them arrived as others.
    """

    def __init__(
        self, dock_url: str, share: float, seed: int, on_message: Callable[[Any], None]
    ) -> None:
        host, _, port = dock_url.removeprefix("socket://").rpartition(":")
        self._dock = socket.create_connection((host, int(port)))
        self._server = socket.create_server(("127.0.0.1", 0))
        self._client: socket.socket | None = None
        self._down = Damage(share, random.Random(seed))
        self._up = Damage(share, random.Random(seed + 1))
        self._finder = FrameFinder()
        self._on_message = on_message
        self._sender = dialect.MAVLink(None, 254, 1)
        self.url = f"socket://127.0.0.1:{self._server.getsockname()[1]}"
        self.moved = [0, 0]
        self.damaged = [0, 0]

    def step(self, timeout_s: float) -> None:
        """Move what is there, after waiting at most ``timeout_s`` seconds for it."""
        ends = [self._dock, self._client or self._server]
        for end in select.select(ends, [], [], timeout_s)[0]:
            if end is self._server:
                self._client, _ = self._server.accept()
                continue
            if end not in (self._dock, self._client):
                continue  # the client hung up while the dock's bytes were passed on
            data = end.recv(CHUNK)
            if end is self._client:
                if not data:
                    self._client.close()
                    self._client = None
                self._dock.sendall(self._spoilt(data, self._up, 1))
            elif not data:
                raise ConnectionError("the dock closed its port")
            else:
                self._from_dock(data)

    def say(self, message: Any, damaged: bool = True) -> None:
        """A message of a second host to the dock."""
        data = bytes(message.pack(self._sender))
        self._dock.sendall(self._spoilt(data, self._up, 1) if damaged else data)

    def close(self) -> None:
        """Hang up."""
        for end in (self._client, self._dock, self._server):
            if end is not None:
                end.close()

    def _from_dock(self, data: bytes) -> None:
        for message in self._finder.feed(data):
            self._on_message(message)
        if self._client is not None:
            try:
                self._client.sendall(self._spoilt(data, self._down, 0))
            except OSError:
                self._client.close()
                self._client = None

    def _spoilt(self, data: bytes, damage: Damage, way: int) -> bytes:
        out = damage.apply(data)
        self.moved[way] += len(data)
        self.damaged[way] += sum(a != b for a, b in zip(data, out, strict=True))
        return out
