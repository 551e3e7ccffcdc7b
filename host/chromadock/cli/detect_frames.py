"""What ``chromadock detect`` does with each frame of a source."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from chromadock.camera import CameraModel
from chromadock.cli.exit_status import EXIT_INTERRUPTED, EXIT_SKIPPED, Terminated
from chromadock.cli.report import Report
from chromadock.detector import Detector
from chromadock.dock import DockGeometry
from chromadock.errors import ChromadockError
from chromadock.output import (
    Guarded,
    OverlayOutput,
    ResultOutput,
    Surroundings,
    open_output,
    open_overlay,
)
from chromadock.overlay import draw_overlay
from chromadock.results.detection import Detection
from chromadock.sources import Frame, Source


def detect_frames(
    frames: Source,
    detector: Detector,
    model: CameraModel | None,
    geometry: DockGeometry,
    overlay: Path | None,
    outputs: Sequence[str | ResultOutput],
    around: Surroundings,
    report: Report,
) -> int:
    """Look for the dock in all ``frames``, and tell ``report`` and the ``outputs``.

    All are closed at the end, but for outputs that are open already.  ``around``: what the outputs
    need to know of the run.  Returns the exit status.
    """
    with ExitStack() as stack:
        stack.enter_context(frames)
        pictures = None
        if overlay is not None:
            _check_apart(overlay, frames)
            pictures = stack.enter_context(open_overlay(overlay, frames.count, frames.fps))
        results = [_guarded(output, around, stack) for output in outputs]
        for output in results:
            output.beside({str(name): other for name, other in zip(outputs, results, strict=True)})
        stack.enter_context(report.progress(frames.count))
        stopped = _run(frames, detector, model, geometry, pictures, results, report)
    report.summary(frames.errors, frames.dropped)
    if stopped is not None:
        return stopped
    return EXIT_SKIPPED if frames.errors or frames.cut_short else 0


def _guarded(output: str | ResultOutput, around: Surroundings, stack: ExitStack) -> Guarded:
    """The output, open; one that is opened here is closed with the ``stack``."""
    if isinstance(output, ResultOutput):
        return Guarded(output, around.tell)
    return stack.enter_context(Guarded(open_output(output, around), around.tell))


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
    results: Sequence[ResultOutput],
    report: Report,
) -> int | None:
    """Frame after frame; the exit status where Ctrl-C or SIGTERM ended a live source, which has no
    other end: what was written so far is kept then."""
    try:
        for taken in frames:
            frame = _with_attitude(taken, results, _age_s(frames, taken))
            detection = _one(frame, detector, model, geometry, pictures)
            age_s = _age_s(frames, frame)
            for output in results:
                output.write(frame, detection, age_s)
            report.frame(frame, detection, age_s)
    except (KeyboardInterrupt, Terminated) as stop:
        if not frames.live:
            raise
        return EXIT_INTERRUPTED if isinstance(stop, KeyboardInterrupt) else 0
    return None


def _with_attitude(frame: Frame, results: Sequence[ResultOutput], age_s: float | None) -> Frame:
    """The frame with the vehicle's attitude: its own as a recording has it, or else that of the
    first output that tells one."""
    if frame.attitude is not None:
        return frame
    attitudes = (output.attitude(frame.time_s, age_s) for output in results)
    return replace(frame, attitude=next(filter(None, attitudes), None))


def _age_s(frames: Source, frame: Frame) -> float | None:
    """How old a live source's picture is by now."""
    now_s = frames.now()
    return None if now_s is None else now_s - frame.time_s


def _one(
    frame: Frame,
    detector: Detector,
    model: CameraModel | None,
    geometry: DockGeometry,
    pictures: OverlayOutput | None,
) -> Detection:
    try:
        detection = detector.process(frame.image, frame.time_s, frame.attitude)
    except ChromadockError as error:
        raise ChromadockError(f"{frame.name}: {error}") from None
    if pictures is not None:
        height, width = frame.image.shape[:2]
        camera = model or CameraModel.nominal(width, height)
        drawn = draw_overlay(frame.image, detector.mask, detection, camera, geometry)
        pictures.write(drawn, frame.name, frame.index)
    return detection
