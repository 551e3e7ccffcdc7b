"""``chromadock dock snapshot`` and ``inject``: camera frames over the link."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from chromadock.cli.dock_options import BAUD, TIMEOUT, Baud, Log, Port, System, Timeout, connect
from chromadock.cli.exit_status import EXIT_SKIPPED
from chromadock.errors import ChromadockError


def snapshot(
    out: Annotated[Path, typer.Argument(metavar="OUT.png", help="Picture to write.")],
    port: Port = None,
    timeout: Timeout = TIMEOUT,
    baud: Baud = BAUD,
    system: System = None,
    log: Log = None,
) -> None:
    """Fetch the dock camera's next frame."""
    import cv2

    from chromadock.link.rgb565 import from_rgb565
    from chromadock.output.base import cannot_write, partial_name

    if out.suffix.lower() != ".png":
        raise ChromadockError(f"{out}: the name must end in .png")
    if not out.parent.is_dir():
        raise ChromadockError(f"{out}: there is no folder {out.parent}: make it first")
    with connect(port, timeout, baud, system, log) as dock:
        data, width, height = dock.snapshot()
    partial = partial_name(out)
    try:
        partial.write_bytes(cv2.imencode(".png", from_rgb565(data, width, height))[1].tobytes())
        partial.replace(out)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise cannot_write(out, error) from None
    print(f"wrote {out}: {width}x{height}")


def inject(
    frames: Annotated[
        list[str],
        typer.Argument(metavar="FRAME...", help="Pictures, folders or videos, in order."),
    ],
    port: Port = None,
    timeout: Timeout = TIMEOUT,
    baud: Baud = BAUD,
    system: System = None,
    log: Log = None,
) -> None:
    """Let the dock decide on these pictures instead of its camera's, and show what it says."""
    from chromadock.cli.dock_status import line
    from chromadock.link.rgb565 import HEIGHT, WIDTH, to_qqvga, to_rgb565
    from chromadock.sources import open_source

    whole = True
    for source in frames:  # all of them, before anything is sent
        open_source(source).close()
    with connect(port, timeout, baud, system, log) as dock:
        try:
            for source in frames:
                with open_source(source, on_fault=_fault, on_note=_note) as opened:
                    for frame in opened:
                        status = dock.inject(to_rgb565(to_qqvga(frame.image)), WIDTH, HEIGHT)
                        print(f"{frame.name}: {line(status).strip()}", flush=True)
                    whole = whole and not (opened.errors or opened.cut_short)
        finally:
            dock.end_injection()
    if not whole:
        raise typer.Exit(EXIT_SKIPPED)


def _fault(line: str) -> None:
    print(f"chromadock: error: {line}", file=sys.stderr, flush=True)


def _note(line: str) -> None:
    print(f"chromadock: warning: {line}", file=sys.stderr, flush=True)
