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
    from chromadock.cli.detect_frames import detect_frames
    from chromadock.cli.report import Report
    from chromadock.output import Surroundings
    from chromadock.output.run_setup import RunSetup
    from chromadock.sources import open_source
    from chromadock.toml_file import change
    from chromadock.vehicle.building import (
        camera_of,
        camera_settings_of,
        detector_of,
        dock_of,
        outputs_of,
    )
    from chromadock.vehicle.reading import read_vehicle

    changes = dict(change(text, "camera.source=1") for text in set_ or [])
    if record is not None:
        changes["outputs.record"] = str(record)
    settings = read_vehicle(vehicle, changes)
    camera, dock = camera_of(settings), dock_of(settings)
    detector = detector_of(settings, camera, dock)
    report = Report(json=json, calibrated=camera is not None)
    frames = open_source(
        settings.camera.source,
        on_fault=report.fault,
        on_note=report.note,
        delay_s=settings.camera.delay_s,
        camera=camera_settings_of(settings),
    )
    overlay = Path(settings.outputs.overlay) if settings.outputs.overlay else None
    outputs = outputs_of(settings)
    around = Surroundings(RunSetup(settings, camera), report.notice, dry_run)
    raise typer.Exit(
        detect_frames(frames, detector, camera, dock, overlay, outputs, around, report)
    )
