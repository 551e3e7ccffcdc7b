"""``chromadock doctor``: look the vehicle over before it goes into the water."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from chromadock.cli.vehicle_options import Changes, changes_of


def doctor(
    vehicle: Annotated[
        Path | None,
        typer.Argument(
            metavar="VEHICLE.toml",
            help="The vehicle's settings; without them the first camera is looked at.",
            show_default=False,
        ),
    ] = None,
    set_: Changes = None,
    dock: Annotated[
        bool, typer.Option("--dock", help="Ask the dock on the serial line, too.")
    ] = False,
    port: Annotated[
        str | None,
        typer.Option(help="The dock's serial port.", show_default="the only port with a dock"),
    ] = None,
) -> None:
    """Look at camera, calibration, clock, disk, ports and autopilot: a line each, with the mend.

    Exit status 1 where there is a fault; warnings alone are 0.
    """
    from chromadock.cli.exit_status import EXIT_FAULTS
    from chromadock.doctor.examination import examined
    from chromadock.vehicle.reading import read_vehicle, settings_of

    changes = changes_of(set_)
    settings = settings_of(changes) if vehicle is None else read_vehicle(vehicle, changes)
    faults = 0
    for finding in examined(settings, port, dock or port is not None):
        faults += finding.level == "fault"
        print(f"{finding.level:<8} {finding.subject}: {finding.words}", flush=True)
    raise typer.Exit(EXIT_FAULTS if faults else 0)
