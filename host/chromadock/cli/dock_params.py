"""``chromadock dock params``: read and set the dock's parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from chromadock.cli.dock_options import BAUD, TIMEOUT, Baud, Port, System, Timeout, connect
from chromadock.text import plural

params = typer.Typer(help="Read and set the dock's parameters.", no_args_is_help=False)

_UNSAVED = "until the next restart: `chromadock dock params save` keeps it"

Name = Annotated[str, typer.Argument(metavar="NAME", help="As in `params list`.")]


@params.command("list")
def list_all(
    port: Port = None, timeout: Timeout = TIMEOUT, baud: Baud = BAUD, system: System = None
) -> None:
    """Show all parameters with units, ranges and defaults."""
    from rich.console import Console
    from rich.table import Table

    from chromadock.link.values import TABLE, show, show_range

    with connect(port, timeout, baud, system) as dock:
        values = dock.parameters()
    table = Table(box=None, pad_edge=False)
    for heading in ("name", "value", "range", "default"):
        table.add_column(heading, no_wrap=heading != "range")
    for name, value in values.items():
        row = TABLE.get(name)
        if row is None:
            table.add_row(name, f"{value:g}", "not known here", "")
            continue
        changed = "" if abs(value - row.default) < 1e-3 else "bold"
        table.add_row(
            name, show(row, value), show_range(row), show(row, row.default), style=changed
        )
    console = Console()
    if not console.is_terminal:  # whole lines for programs that read them
        console = Console(width=160)
    console.print(table)


@params.command("get")
def get(
    name: Name,
    port: Port = None,
    timeout: Timeout = TIMEOUT,
    baud: Baud = BAUD,
    system: System = None,
) -> None:
    """Show one parameter."""
    from chromadock.link.values import parameter, show, show_range

    row = parameter(name)
    with connect(port, timeout, baud, system) as dock:
        value = dock.parameter(row.name)
    print(f"{row.name} = {show(row, value)}  ({show_range(row)})  {row.text}")


@params.command("set", context_settings={"ignore_unknown_options": True})
def set_one(
    name: Name,
    value: Annotated[str, typer.Argument(metavar="VALUE", help="A number or a name.")],
    port: Port = None,
    timeout: Timeout = TIMEOUT,
    baud: Baud = BAUD,
    system: System = None,
) -> None:
    """Set one parameter; it takes effect at once."""
    from chromadock.link.values import parameter, parse, show

    row = parameter(name)
    wanted = parse(row, value)
    with connect(port, timeout, baud, system) as dock:
        taken = dock.set_parameter(row.name, wanted)
    print(f"{row.name} = {show(row, taken)} {_UNSAVED}")


@params.command("save")
def save(
    port: Port = None, timeout: Timeout = TIMEOUT, baud: Baud = BAUD, system: System = None
) -> None:
    """Write the parameters to the dock's flash, so that they outlast a restart."""
    with connect(port, timeout, baud, system) as dock:
        dock.save()
    print("saved in the dock's flash")


@params.command("load")
def load(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="TOML with lines NAME = value.")],
    port: Port = None,
    timeout: Timeout = TIMEOUT,
    baud: Baud = BAUD,
    system: System = None,
) -> None:
    """Set every parameter in FILE; nothing is sent if anything in it is wrong."""
    from chromadock.link.values import read_file

    values = read_file(file)
    with connect(port, timeout, baud, system) as dock:
        for name, value in values.items():
            dock.set_parameter(name, value)
    print(f"{plural(len(values), 'parameter')} set {_UNSAVED}")


@params.command("reset")
def reset(
    port: Port = None, timeout: Timeout = TIMEOUT, baud: Baud = BAUD, system: System = None
) -> None:
    """Set all parameters to their defaults; LED_LIMIT and LED_ANODE stay."""
    with connect(port, timeout, baud, system) as dock:
        dock.reset()
    print(f"all parameters but LED_LIMIT and LED_ANODE at their defaults {_UNSAVED}")
