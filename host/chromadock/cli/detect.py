"""``chromadock detect``: find the dock in every frame of a source."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from chromadock.camera import CameraModel
from chromadock.cli.report import Report
from chromadock.detector import DEFAULT_METHOD, FALLBACK_HUE_DEG, MAPPINGS, METHODS, Detector
from chromadock.dock import DockGeometry
from chromadock.errors import ChromadockError
from chromadock.marker_colour import MarkerColour
from chromadock.method import DEFAULT_MAPPING_NAME
from chromadock.output import OverlayOutput, open_overlay
from chromadock.overlay import draw_overlay
from chromadock.sources import Frame, Source, open_source
from chromadock.sources.base import DEFAULT_FPS

EXIT_SKIPPED = 1
EXIT_INTERRUPTED = 130


def detect(
    source: Annotated[
        str,
        typer.Argument(
            metavar="SOURCE",
            help="Camera index or device, video, picture, folder or glob of pictures, "
            "GStreamer pipeline, or URL.",
            show_default=False,
        ),
    ],
    camera: Annotated[
        Path | None,
        typer.Option(help="camera_info YAML of your calibration.", show_default="a usual lens"),
    ] = None,
    dock: Annotated[
        Path | None,
        typer.Option(help="TOML file with the dock's markers.", show_default="the original one"),
    ] = None,
    method: Annotated[
        str, typer.Option(help=f"How to find it: {', '.join(METHODS)}.")
    ] = DEFAULT_METHOD,
    mapping: Annotated[
        str,
        typer.Option(help=f"From water to marker colour, as in the dock: {', '.join(MAPPINGS)}."),
    ] = DEFAULT_MAPPING_NAME,
    marker_colour: Annotated[
        str | None,
        typer.Option(
            metavar='"#RRGGBB"|white|any',
            help="Of lamps that have a colour of their own, whatever the water is.",
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
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object a frame.")] = False,
    overlay: Annotated[
        Path | None,
        typer.Option(help="Draw what was seen into a folder or a .mp4.", show_default=False),
    ] = None,
    fps: Annotated[
        float, typer.Option(help="Frames a second of a folder of pictures.")
    ] = DEFAULT_FPS,
) -> None:
    """Find the dock in every frame of SOURCE and tell where it is.

    From frame to frame it is tracked: through frames in which it is hidden, and with
    a marker out.  docs/track.md tells what the states mean.
    """
    geometry = DockGeometry.default() if dock is None else DockGeometry.from_toml(dock)
    model = None if camera is None else CameraModel.from_yaml(camera)
    detector = Detector(
        model,
        geometry,
        method=method,
        mapping=mapping,
        independent=independent,
        marker_colour=None if marker_colour is None else _colour(marker_colour),
        fallback_hue_deg=fallback_hue,
    )
    with ExitStack() as stack:
        report = Report(json=json, calibrated=model is not None)
        frames = stack.enter_context(open_source(source, fps, report.skipped))
        pictures = None
        if overlay is not None:
            _check_apart(overlay, frames)
            pictures = stack.enter_context(open_overlay(overlay, frames.count, frames.fps))
        stack.enter_context(report.progress(frames.count))
        interrupted = _run(frames, detector, model, geometry, pictures, report)
    report.summary()
    if interrupted:
        raise typer.Exit(EXIT_INTERRUPTED)
    if frames.errors:
        raise typer.Exit(EXIT_SKIPPED)


def _colour(text: str) -> MarkerColour:
    return MarkerColour.parse(text, "--marker-colour")


def _check_apart(overlay: Path, frames: Source) -> None:
    """An overlay named like its picture, in the picture's folder, would replace it."""
    if overlay.resolve() in {place.resolve() for place in frames.places}:
        raise ChromadockError(f"--overlay {overlay} would overwrite the source: choose another")


def _run(
    frames: Source,
    detector: Detector,
    model: CameraModel | None,
    geometry: DockGeometry,
    pictures: OverlayOutput | None,
    report: Report,
) -> bool:
    """Frame after frame; True where Ctrl-C ended a live source, which is its only end."""
    try:
        for frame in frames:
            _one(frame, detector, model, geometry, pictures, report)
    except KeyboardInterrupt:
        if not frames.live:
            raise
        return True
    return False


def _one(
    frame: Frame,
    detector: Detector,
    model: CameraModel | None,
    geometry: DockGeometry,
    pictures: OverlayOutput | None,
    report: Report,
) -> None:
    try:
        detection = detector.process(frame.image, frame.time_s)
    except ChromadockError as error:
        raise ChromadockError(f"{frame.name}: {error}") from None
    if pictures is not None:
        height, width = frame.image.shape[:2]
        camera = model or CameraModel.nominal(width, height)
        drawn = draw_overlay(frame.image, detector.mask, detection, camera, geometry)
        pictures.write(drawn, frame.name, frame.index)
    report.frame(frame, detection)
