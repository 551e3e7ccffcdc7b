"""``chromadock run``: what a vehicle does, by its file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def run(
    vehicle: Annotated[
        Path,
        typer.Argument(
            metavar="VEHICLE.toml",
            help="The vehicle's settings: `chromadock config init` writes them.",
            show_default=False,
        ),
    ],
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Goes before a key of the file, e.g. camera.source=1; may be repeated.",
        ),
    ] = None,
    dry_run: Annotated[
        bool,
        typer.Option("--dry-run", help="Send an autopilot nothing: say what it would understand."),
    ] = False,
    out: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KIND:PLACE",
            help="Where else each result goes, beside outputs.results; may be repeated.",
            show_default=False,
        ),
    ] = None,
    retry: Annotated[
        bool,
        typer.Option(
            "--retry",
            help="Where the file or the camera is at fault, say so, on the pages of --out http: "
            "too, and try again instead of ending; a file that is missing is written.",
        ),
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object a frame.")] = False,
    record: Annotated[
        Path | None,
        typer.Option(
            metavar="DIVE.mcap",
            help="Goes before outputs.record: record frames, results and settings.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Find the dock in what the camera of VEHICLE.toml sees, and pass on where it is.

    docs/configuration.md has every key of the file.
    """
    from chromadock.cli.run_vehicle import run_once, run_with_retries
    from chromadock.output.addresses import check_output
    from chromadock.toml_file import change

    changes = dict(change(text, "camera.source=1") for text in set_ or [])
    if record is not None:
        changes["outputs.record"] = str(record)
    for text in out or []:
        check_output(text)  # a slip there is no fault that passes
    run_it = run_with_retries if retry else run_once
    raise typer.Exit(run_it(vehicle, changes, out or [], json=json, dry_run=dry_run))
