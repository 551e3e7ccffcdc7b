"""``chromadock run``: what a vehicle does, by its file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from chromadock.cli.vehicle_options import Changes, DryRun, JsonLines, changes_of


def run(
    vehicle: Annotated[
        Path,
        typer.Argument(
            metavar="VEHICLE.toml",
            help="The vehicle's settings: `chromadock config init` writes them.",
            show_default=False,
        ),
    ],
    set_: Changes = None,
    dry_run: DryRun = False,
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
    json: JsonLines = False,
    record: Annotated[
        Path | None,
        typer.Option(
            metavar="DIVE.mcap",
            help="Record frames, results and settings there; takes precedence over outputs.record.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Find the dock in what the camera of VEHICLE.toml sees, and pass on where it is.

    docs/configuration.md has every key of the file.
    """
    from chromadock.cli.run_vehicle import run_once, run_with_retries
    from chromadock.output.addresses import check_output

    changes = changes_of(set_)
    if record is not None:
        changes["outputs.record"] = str(record)
    for text in out or []:
        check_output(text)  # a slip there is no fault that passes
    run_it = run_with_retries if retry else run_once
    raise typer.Exit(run_it(vehicle, changes, out or [], json=json, dry_run=dry_run))
