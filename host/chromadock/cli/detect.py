"""``chromadock detect``: find the dock in every frame of a source."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from chromadock.choices import (
    DEFAULT_FPS,
    DEFAULT_MAPPING,
    DEFAULT_METHOD,
    FALLBACK_HUE_DEG,
    MAPPINGS,
    METHODS,
)
from chromadock.cli.vehicle_options import DryRun, JsonLines
from chromadock.errors import ChromadockError


def detect(
    context: typer.Context,
    source: Annotated[
        str,
        typer.Argument(
            metavar="SOURCE",
            help="Camera index or device, video, picture, folder or glob of pictures, "
            "recording (MCAP, ROS bag), GStreamer pipeline, or URL.",
            show_default=False,
        ),
    ],
    camera: Annotated[
        Path | None,
        typer.Option(
            help="Camera file of your calibration: ROS, OpenCV or Kalibr.",
            show_default="a usual lens",
        ),
    ] = None,
    dock: Annotated[
        Path | None,
        typer.Option(
            help="TOML file with the dock's markers.",
            show_default="the rectangle of the original dock",
        ),
    ] = None,
    yes: Annotated[
        bool,
        typer.Option(
            "--yes", help="The dock is as its file says, even if more than 10 m wide or edge-on."
        ),
    ] = False,
    method: Annotated[
        str, typer.Option(help=f"How to find it: {', '.join(METHODS)}.")
    ] = DEFAULT_METHOD,
    mapping: Annotated[
        str,
        typer.Option(help=f"From water to marker colour, as in the dock: {', '.join(MAPPINGS)}."),
    ] = DEFAULT_MAPPING,
    marker_colour: Annotated[
        str | None,
        typer.Option(
            metavar='"#RRGGBB"|white|any',
            help="The lamps' colour, where they have one of their own whatever the water is.",
            show_default="the dock file's, or by the water",
        ),
    ] = None,
    fallback_hue: Annotated[
        float,
        typer.Option(
            metavar="DEG",
            help="Marker hue in grey water and at night: the dock's FALLBACK_HUE.",
        ),
    ] = FALLBACK_HUE_DEG,
    independent: Annotated[
        bool,
        typer.Option(
            "--independent",
            help="Treat every frame alone: no mean of the colour over time, no track.",
        ),
    ] = False,
    json: JsonLines = False,
    out: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KIND:PLACE",
            help="Where else each result goes, as often as you like: json:FILE, mcap:FILE, "
            "udp:HOST:PORT, http:[HOST:]PORT (a page), mavlink:ADDRESS?receiver=NAME.",
            show_default=False,
        ),
    ] = None,
    record: Annotated[
        Path | None,
        typer.Option(
            metavar="DIVE.mcap",
            help="Record frames, results and settings, for `chromadock replay`: --out mcap:FILE.",
            show_default=False,
        ),
    ] = None,
    dry_run: DryRun = False,
    overlay: Annotated[
        Path | None,
        typer.Option(help="Draw what was seen into a folder or a .mp4.", show_default=False),
    ] = None,
    fps: Annotated[
        float, typer.Option(help="Frames a second of a folder of pictures.")
    ] = DEFAULT_FPS,
    delay: Annotated[
        float,
        typer.Option(
            metavar="S",
            help="Seconds from capture to arrival of a camera's or stream's pictures, where known.",
        ),
    ] = 0.0,
) -> None:
    """Find the dock in every frame of SOURCE and tell where it is.

    From frame to frame it is tracked: through frames in which it is hidden, and with
    a marker out.  docs/track.md tells what the states mean.
    """
    from chromadock.camera import CameraModel
    from chromadock.cli.detect_frames import detect_frames
    from chromadock.cli.report import Report
    from chromadock.detector import Detector
    from chromadock.dock import DockGeometry
    from chromadock.marker_colour import MarkerColour
    from chromadock.output import Surroundings
    from chromadock.output.run_setup import RunSetup
    from chromadock.sources import open_source
    from chromadock.vehicle.building import outputs_of
    from chromadock.vehicle.reading import settings_of

    _check_one(context)
    geometry = DockGeometry.default() if dock is None else DockGeometry.from_toml(dock, yes)
    model = None if camera is None else CameraModel.from_yaml(camera)
    colour = None if marker_colour is None else MarkerColour.parse(marker_colour, "--marker-colour")
    detector = Detector(
        model,
        geometry,
        method=method,
        mapping=mapping,
        independent=independent,
        marker_colour=colour,
        fallback_hue_deg=fallback_hue,
    )
    report = Report(json=json, calibrated=model is not None)
    frames = open_source(source, fps, report.fault, report.note, delay)
    settings = settings_of(
        {
            "camera.source": source,
            "camera.calibration": _text(camera),
            "camera.delay_s": delay,
            "dock.file": _text(dock),
            "dock.mapping": mapping,
            "dock.colour": marker_colour or "",
            "dock.fallback_hue_deg": fallback_hue,
            "detector.method": method,
            "detector.independent": independent,
            "outputs.results": out or [],
            "outputs.record": _text(record),
            "outputs.overlay": _text(overlay),
        },
        "an option",
    )
    around = Surroundings(RunSetup(settings, model), report.notice, dry_run)
    outputs = outputs_of(settings)
    raise typer.Exit(
        detect_frames(frames, detector, model, geometry, overlay, outputs, around, report)
    )


def _text(path: Path | None) -> str:
    return "" if path is None else str(path)


def _check_one(context: typer.Context) -> None:
    """Of a pattern that is not quoted, the shell makes one argument for each file."""
    if context.args:
        raise ChromadockError(
            f"{1 + len(context.args)} sources are given: give one; put a pattern into quotes "
            "('*.png'), so that the shell leaves it alone, or give the folder"
        )
