"""What the commands that talk to a dock have in common."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from chromadock.errors import ChromadockError

if TYPE_CHECKING:
    from chromadock.link import DockClient

_DEFAULT_TIMEOUT_S = 2.0
_MOST_TIMEOUT_S = 600.0
_NOTICE = 5

Port = Annotated[
    str | None,
    typer.Option(
        "--port",
        help="Serial port, or any pyserial URL such as socket://localhost:5760.",
        show_default="the only port with a dock",
    ),
]
Timeout = Annotated[float, typer.Option("--timeout", help="Seconds to wait for an answer.")]
Baud = Annotated[int, typer.Option("--baud", help="Speed of the port: the dock's LINK_BAUD.")]
System = Annotated[
    int | None,
    typer.Option(
        "--system",
        help="Which dock of several on one line: its SYSTEM_ID.",
        show_default="the only one",
    ),
]
Log = Annotated[
    Path | None,
    typer.Option("--log", help="Write all bytes of both directions, with times."),
]

TIMEOUT = _DEFAULT_TIMEOUT_S
BAUD = 921600


def connect(
    port: str | None,
    timeout: float,
    baud: int,
    system: int | None = None,
    log: Path | None = None,
    tell: bool = False,
) -> DockClient:
    """The dock, checked; with ``tell`` its warnings go to stderr as they come.

    Raises
    ------
    ChromadockError
        One line with the mend.
    """
    # Here, as the dialect takes a third of a second to load.
    from chromadock.link import open_dock

    if not 0 < timeout <= _MOST_TIMEOUT_S:
        raise ChromadockError(f"--timeout is {timeout:g}: give seconds, 0 .. {_MOST_TIMEOUT_S:g}")
    if baud <= 0:
        raise ChromadockError(f"--baud is {baud}: give the dock's LINK_BAUD, usually {BAUD}")
    if system is not None and not 0 < system < 255:
        raise ChromadockError(f"--system is {system}: give the dock's SYSTEM_ID, 1 .. 254")
    return open_dock(port, baud, timeout, log, _tell if tell else None, system)


def _tell(severity: int, text: str) -> None:
    if severity <= _NOTICE:
        print(f"dock: {text}", file=sys.stderr)
