"""Serves the page, in threads that the detection never waits for."""

from __future__ import annotations

import contextlib
import shutil
import socket
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.output.page.answers import answer
from chromadock.output.page.picture import Picture
from chromadock.output.page.status import Status

MOST_CLIENTS = 16
"""At once; more are turned away."""
PATIENCE_S = 10.0
"""For a client that neither asks nor reads."""


class _Handler(BaseHTTPRequestHandler):
    """One request; whoever asks again connects again."""

    timeout = PATIENCE_S
    server: _Server

    def do_GET(self) -> None:
        """Answer."""
        reply = answer(self.path, self.server.status, self.server.picture, time.monotonic())
        with contextlib.ExitStack() as stack:
            if isinstance(reply.content, Path):
                file = stack.enter_context(reply.content.open("rb"))
            self.send_response(reply.status)
            self.send_header("Content-Type", reply.kind)
            self.send_header("Cache-Control", "no-store")
            self.send_header("X-Content-Type-Options", "nosniff")
            if isinstance(reply.content, bytes):
                self.send_header("Content-Length", str(len(reply.content)))
            self.end_headers()
            if self.command == "HEAD":
                return
            if isinstance(reply.content, bytes):
                self.wfile.write(reply.content)
            else:  # may grow meanwhile: its end is that of the connection
                shutil.copyfileobj(file, self.wfile, 1 << 16)

    do_HEAD = do_GET

    def log_message(self, *_words: object) -> None:
        """Say nothing: the screen is the run's."""


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    block_on_close = False  # a client that hangs does not keep the run from its end

    def __init__(self, host: str, port: int, status: Status) -> None:
        self.status = status
        self.picture = Picture()
        self._free = threading.Semaphore(MOST_CLIENTS)
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
        self.address_family = found[0][0]
        super().__init__((host, port), _Handler)

    def process_request(self, request: socket.socket, client_address: object) -> None:  # type: ignore[override]
        if self._free.acquire(blocking=False):
            super().process_request(request, client_address)
        else:
            self.shutdown_request(request)

    def process_request_thread(self, request: socket.socket, client_address: object) -> None:  # type: ignore[override]
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._free.release()

    def handle_error(self, request: object, client_address: object) -> None:
        """Say nothing of clients that went away, nor of files that are gone."""


class Server:
    """Serves a ``Status`` at an address until it is closed.

    Raises
    ------
    ChromadockError
        Where there is no such address, or its port is taken.
    """

    def __init__(self, host: str, port: int, status: Status) -> None:
        try:
            self._server = _Server(host, port, status)
        except (OSError, UnicodeError) as error:  # of a host that no name can be
            reason = getattr(error, "strerror", None) or "no such host"
            raise ChromadockError(
                f"--out http:{host}:{port}: cannot listen there ({reason}): give another"
            ) from None
        self._thread = threading.Thread(
            target=self._server.serve_forever, args=(0.1,), name="page", daemon=True
        )
        self._thread.start()

    def close(self) -> None:
        """Stop; answers that are under way end with the program."""
        self._server.shutdown()
        self._server.server_close()
