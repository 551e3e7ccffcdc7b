"""``chromadock dock``: everything about the docking station itself."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

import typer

from chromadock.cli.dock_flash import flash
from chromadock.cli.dock_options import BAUD, TIMEOUT, Baud, Log, Port, System, Timeout, connect
from chromadock.cli.dock_params import params
from chromadock.cli.dock_pictures import inject, snapshot
from chromadock.cli.dock_simulate import simulate
from chromadock.errors import ChromadockError

if TYPE_CHECKING:
    from chromadock.link import DockClient

dock = typer.Typer(help="Talk to a dock, or simulate one.")
dock.command("simulate")(simulate)
dock.add_typer(params, name="params")
dock.command("snapshot")(snapshot)
dock.command("inject")(inject)
dock.command("flash")(flash)

_LINE_PERIOD_S = 1.0
_ASK_AGAIN_S = 0.5


@dock.command("info")
def info(
    port: Port = None,
    timeout: Timeout = TIMEOUT,
    baud: Baud = BAUD,
    system: System = None,
    log: Log = None,
) -> None:
    """Show the dock's version and what it sees, decides and shows now."""
    from rich.console import Console

    from chromadock.cli.dock_status import table

    with connect(port, timeout, baud, system, log) as client:
        status = client.status()
    print(f"port      {client.connection.url}")
    chip = f", chip {client.version.uid:012x}" if client.version.uid else ""
    print(f"name      {client.name}{chip}")
    print(f"firmware  {client.version.git_hash}")
    print(f"method    {client.version.method_digest} (the same as this program's)")
    print(f"reset     reason {status.reset_reason}")
    Console(highlight=False).print(table(status, ""))


@dock.command("watch")
def watch(
    port: Port = None,
    timeout: Timeout = TIMEOUT,
    baud: Baud = BAUD,
    system: System = None,
    log: Log = None,
    seconds: Annotated[
        float | None, typer.Option(help="Stop after so long.", show_default="Ctrl-C")
    ] = None,
) -> None:
    """Show the dock's state as it changes; a line a second where stdout is no terminal."""
    from rich.console import Console
    from rich.live import Live

    from chromadock.cli.dock_status import table

    console = Console(highlight=False)
    with connect(port, timeout, baud, system, log, tell=True) as client:
        title = f"dock at {client.connection.url}, firmware {client.version.git_hash}"
        end = None if seconds is None else time.monotonic() + seconds
        statuses = _statuses(client, timeout, end)
        if not console.is_terminal:
            _print_lines(statuses)
            return
        with Live(console=console, auto_refresh=False) as live:
            for status in statuses:
                live.update(table(status, title), refresh=True)


def _print_lines(statuses: Iterator[Any]) -> None:
    from chromadock.cli.dock_status import line

    due = 0.0
    for status in statuses:
        now = time.monotonic()
        if now >= due:
            due = now + _LINE_PERIOD_S
            print(line(status), flush=True)


def _statuses(client: DockClient, timeout_s: float, end: float | None) -> Iterator[Any]:
    """Every DOCK_STATUS until ``end``; raises where the dock says nothing for too long."""
    heard = seen = now = time.monotonic()
    while end is None or now < end:
        wait_s = min(_ASK_AGAIN_S, heard + timeout_s - now, *[] if end is None else [end - now])
        beats = client.messenger.heartbeats
        status = client.next_status(max(wait_s, 0.0))
        now = time.monotonic()
        if status is not None or client.messenger.heartbeats > beats:
            heard = now
        if status is not None:
            seen = now
            yield status
            continue
        if now - seen >= timeout_s:
            client.check_dialect()
        if now - heard >= timeout_s:
            raise ChromadockError(
                f"{client.connection.url}: the dock fell silent {timeout_s:g} s ago: "
                "check its power and the cable"
            )
        client.request_status()  # with REPORT_HZ 0 it sends none by itself


@dock.command("led", context_settings={"ignore_unknown_options": True})
def led(
    colour: Annotated[
        list[str],
        typer.Argument(
            metavar="R G B | HUE | auto",
            help="Duties 0..255, a hue in degrees, or auto: the marker colour.",
        ),
    ],
    port: Port = None,
    timeout: Timeout = TIMEOUT,
    baud: Baud = BAUD,
    system: System = None,
) -> None:
    """Set what the LEDs show until the next start."""
    values = _colour(colour)
    with connect(port, timeout, baud, system) as client:
        if not values:
            client.led_auto()
        elif len(values) == 1:
            client.led_hue(values[0])
        else:
            red, green, blue = map(int, values)
            client.led_raw(red, green, blue)
    print(f"LEDs: {' '.join(colour)}")


@dock.command("reboot")
def reboot(
    port: Port = None, timeout: Timeout = TIMEOUT, baud: Baud = BAUD, system: System = None
) -> None:
    """Restart the dock and wait until it is back."""
    with connect(port, timeout, baud, system) as client:
        client.reboot()
    print("the dock has restarted")


def _colour(words: list[str]) -> list[float]:
    """Three duties, one hue, or nothing for auto."""
    if words == ["auto"]:
        return []
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = []
    if len(values) == 1 and 0 <= values[0] <= 360:
        return values
    if len(values) == 3 and all(v == round(v) and 0 <= v <= 255 for v in map(_finite, values)):
        return values
    raise ChromadockError(
        f"led {' '.join(words)}: give three duties 0..255, one hue 0..360 in degrees, or auto"
    )


def _finite(value: float) -> float:
    return value if abs(value) < 1e9 else -1.0
