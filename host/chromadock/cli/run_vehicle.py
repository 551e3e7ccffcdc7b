"""What ``chromadock run`` does: once, or again and again until nothing is at fault."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from chromadock.back_off import FIRST_RETRY_S, LONGEST_RETRY_S
from chromadock.cli.config import write_shipped_file
from chromadock.cli.detect_frames import detect_frames
from chromadock.cli.exit_status import Terminated
from chromadock.cli.report import Report
from chromadock.errors import ChromadockError
from chromadock.output import ResultOutput, Surroundings, open_output
from chromadock.output.addresses import check_output
from chromadock.output.page.output import PageOutput
from chromadock.output.run_setup import RunSetup
from chromadock.sources import open_source
from chromadock.vehicle.building import (
    camera_of,
    camera_settings_of,
    detector_of,
    dock_of,
    outputs_of,
)
from chromadock.vehicle.reading import read_vehicle

_LOOK_S = 0.2
"""So often it is seen whether somebody has mended the file."""


def run_once(
    vehicle: Path,
    changes: Mapping[str, Any],
    more: Sequence[str | ResultOutput],
    *,
    json: bool,
    dry_run: bool,
) -> int:
    """Run by the file until its source ends; the exit status.

    Parameters
    ----------
    changes : values by dotted key that go before the file's.
    more : outputs beside the file's; pages that are open already show this run.

    Raises
    ------
    ChromadockError
        Where the file, the camera or an output is at fault.
    """
    settings = read_vehicle(vehicle, changes)
    for text in outputs_of(settings):
        check_output(text)  # before any is opened: a slip in one would leave a recording each try
    camera, dock = camera_of(settings), dock_of(settings)
    setup = RunSetup(settings, camera)
    for output in more:
        if isinstance(output, PageOutput):
            output.begin(setup)
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
    outputs = [*outputs_of(settings), *more]
    around = Surroundings(setup, report.notice, dry_run)
    return detect_frames(frames, detector, camera, dock, overlay, outputs, around, report)


def run_with_retries(
    vehicle: Path, changes: Mapping[str, Any], more: Sequence[str], *, json: bool, dry_run: bool
) -> int:
    """The same, but what is at fault is told, on the pages among ``more`` too, and tried again once
    the file has changed, or after a while.

    A file that is missing is written first.  SIGTERM is the ordinary end.

    Raises
    ------
    ChromadockError
        Where the file cannot be written, or a page cannot be served.
    """
    if not vehicle.exists():
        write_shipped_file(vehicle)
    report = Report(json=json, calibrated=True)
    with ExitStack() as stack:
        outputs: list[str | ResultOutput] = []
        for text in more:
            kept = text.startswith("http:")
            outputs.append(stack.enter_context(_opened(text, report)) if kept else text)
        wait_s = FIRST_RETRY_S
        try:
            while True:
                seen = _version(vehicle)
                begun_s = time.monotonic()
                try:
                    return run_once(vehicle, changes, outputs, json=json, dry_run=dry_run)
                except ChromadockError as error:
                    _tell(str(error), outputs, report)
                changed = _wait(vehicle, seen, wait_s)
                went_well = time.monotonic() - begun_s > 2 * LONGEST_RETRY_S
                wait_s = FIRST_RETRY_S if changed or went_well else min(2 * wait_s, LONGEST_RETRY_S)
        except Terminated:
            return 0


def _opened(text: str, report: Report) -> ResultOutput:
    return open_output(text, Surroundings(None, report.notice))


def _tell(line: str, outputs: Sequence[str | ResultOutput], report: Report) -> None:
    report.fault(line)
    for output in outputs:
        if isinstance(output, PageOutput):
            output.fails(line)


def _wait(vehicle: Path, seen: object, most_s: float) -> bool:
    """Wait until the file is another than the one that was seen, which is True, or so long."""
    end_s = time.monotonic() + most_s
    while time.monotonic() < end_s:
        time.sleep(_LOOK_S)
        if _version(vehicle) != seen:
            return True
    return False


def _version(path: Path) -> object:
    """What a file has that is another once somebody has written it."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
