"""Simulated docks, other peers and the command line, for tests of several files."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Thread
from types import SimpleNamespace
from unittest.mock import patch

import pytest
from serial.urlhandler import protocol_socket

from chromadock import cli, dialect
from chromadock.simulated import Fault, PtyPort, SimulatedDock, TcpPort, serve
from chromadock.simulated.camera import open_camera
from chromadock.simulated.loop import CLOCK

# pyserial waits 0.3 s after closing a socket, for servers that cannot bear a quick return.
protocol_socket.time = SimpleNamespace(sleep=lambda _seconds: None)


@contextlib.contextmanager
def running_dock(
    tcp: bool = False,
    source: str | None = None,
    fps: float = 20.0,
    settings: Path | None = None,
    faults: tuple[Fault, ...] = (),
    save_s: float = 0.0,
) -> Iterator[tuple[str, SimulatedDock]]:
    """A dock served by a thread: what ``--port`` takes, and the dock itself."""
    camera = open_camera(source)
    dock = SimulatedDock(camera, fps, settings, faults, 0, CLOCK(), save_s=save_s)
    with contextlib.closing(camera), served(dock, tcp) as url:
        yield url, dock


@contextlib.contextmanager
def served(dock: SimulatedDock, tcp: bool = False) -> Iterator[str]:
    """What ``--port`` takes for a dock, or for what behaves like one, served by a thread."""
    port = TcpPort("localhost:0") if tcp else PtyPort()
    stop = Event()
    thread = Thread(target=serve, args=(dock, port, stop))
    thread.start()
    try:
        yield port.url
    finally:
        stop.set()
        thread.join()
        port.close()


@contextlib.contextmanager
def peer(script: Callable[[socket.socket], None]) -> Iterator[str]:
    """Something else at a TCP port, which does ``script`` for its one client, then leaves."""
    server = socket.create_server(("127.0.0.1", 0))

    def run() -> None:
        with contextlib.suppress(OSError):
            client, _ = server.accept()
            with client:
                script(client)

    thread = Thread(target=run, daemon=True)
    thread.start()
    try:
        yield f"socket://127.0.0.1:{server.getsockname()[1]}"
    finally:
        server.close()
        thread.join(0.1)


def packed(
    *messages: dialect.MAVLink_message,
    system: int = dialect.DOCK_ID_SYSTEM,
    component: int = dialect.DOCK_ID_COMPONENT,
) -> bytes:
    """The messages on the wire, from the dock unless said otherwise."""
    mav = dialect.MAVLink(None, system, component)
    return b"".join(bytes(message.pack(mav)) for message in messages)


def heartbeat() -> dialect.MAVLink_message:
    """As any system sends it."""
    return dialect.MAVLink_heartbeat_message(
        dialect.MAV_TYPE_GENERIC, dialect.MAV_AUTOPILOT_INVALID, 0, 0, dialect.MAV_STATE_ACTIVE, 3
    )


@dataclass
class Done:
    """What a command left: its exit status and what it printed."""

    status: int
    out: str
    err: str


def chromadock(capsys: pytest.CaptureFixture[str], *arguments: object) -> Done:
    """The command line in this process."""
    capsys.readouterr()
    terminate, argv = signal.getsignal(signal.SIGTERM), sys.argv
    sys.argv = ["chromadock", *map(str, arguments)]
    try:
        # What it sets for its libraries must not reach the programs that later tests start.
        with patch.dict(os.environ):
            cli.main()
    except SystemExit as leaving:
        captured = capsys.readouterr()
        return Done(int(leaving.code or 0), captured.out, captured.err)
    finally:
        sys.argv = argv
        signal.signal(signal.SIGTERM, terminate)
