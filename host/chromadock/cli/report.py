"""What the user sees of a run: a line a frame, a progress bar, a summary."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from chromadock.output import json_line, result_record
from chromadock.results.detection import MOST_CLIPPED, Detection, Marker
from chromadock.sources import Frame
from chromadock.text import plural

if TYPE_CHECKING:
    from rich.progress import Progress

_LONG = 20
"""Sources with fewer frames are done before a bar could be read."""

_COMPARED_FRAMES = 15
_DISAGREEMENT_DEG = 75.0
"""The mean of so many tracked frames says whether dock and vehicle agree: single ones err by
more, and water and crosstalk turn the light of a dock that agrees by up to about 60 degrees."""

_MISFIT_FRAMES, _MISFIT_SHARE = 3, 1 / 3
"""One frame may be a chance, and in a long run some frames are; of a file that is off, most."""

_AGES = 100_000
"""So many of the newest pictures' ages are kept: an hour's at 30 frames a second."""

_HEADER = (
    "   frame   time s  state       range m        x        y        z  error px"
    "  track             m  file"
)


class Report:
    """Results to standard output, everything else to standard error.

    With ``json`` a line is one object, else a row of a table.  ``calibrated`` says that
    the distances rest on a calibration.
    """

    def __init__(self, json: bool, calibrated: bool) -> None:
        self._json = json
        self._calibrated = calibrated
        self._bar: Progress | None = None
        self._frames = 0
        self._found = 0
        self._tracked = 0
        self._off: list[complex] = []
        self._clipped = 0
        self._unlit = 0
        self._seen = 0
        self._misfits = 0
        self._misfit_told = False
        self._ages_s: deque[float] = deque(maxlen=_AGES)

    def frame(self, frame: Frame, detection: Detection, age_s: float | None = None) -> None:
        """Tell of one frame; ``age_s``: how old the picture of a live source is by now, seconds."""
        if age_s is not None:
            self._ages_s.append(age_s)
        if detection.pose is not None and not self._calibrated:
            self._calibrated = True  # once is enough
            self._aside("warning: no --camera: a usual lens is assumed, so distances are rough")
        if detection.marker.given is not None and not self._frames:
            self._aside(_looked_for(detection.marker))
        if detection.track is not None and detection.track.pose is not None:
            self._compare(detection.marker)
        self._advise(detection)
        if self._json:
            self._print(json_line(result_record(frame, detection, age_s)))
        else:
            if not self._frames:
                self._print(_HEADER)
            self._print(_row(frame, detection))
        self._frames += 1
        self._found += detection.found
        self._tracked += detection.track is not None and detection.track.state == "tracking"
        if self._bar is not None:
            self._bar.update(self._bar.task_ids[0], completed=frame.index + 1)

    def _advise(self, detection: Detection) -> None:
        """Say once what several frames have shown to be amiss."""
        if detection.found and detection.evidence is not None and detection.clipped is None:
            self._unlit += 1
            if self._unlit == _COMPARED_FRAMES:
                self._aside(
                    "warning: the dock is found by the dark holders of its lamps, which hardly "
                    "shine here: check that they are lit, and as bright as they may be"
                )
        if detection.clipped is not None and detection.clipped > MOST_CLIPPED:
            self._clipped += 1
            if self._clipped == _COMPARED_FRAMES:
                stops = max(round(detection.stops_over or 0.0), 1)
                self._aside(
                    f"warning: most lamps are overexposed: shorten this camera's exposure by about "
                    f"{stops} stop{'s' if stops > 1 else ''} (to 1/{2**stops}), or dim the dock, "
                    "for a range that is more exact"
                )
        self._seen += detection.markers is not None or detection.misfit is not None
        if detection.misfit is not None:
            self._misfits += 1
            often = self._misfits >= max(_MISFIT_FRAMES, _MISFIT_SHARE * self._seen)
            if often and not self._misfit_told:
                self._misfit_told = True
                self._aside(
                    f"warning: something stands like the dock ({detection.misfit.evidence:.0f} "
                    f"decades of evidence), but {detection.misfit.error_px:.2g} pixels off: check "
                    "the markers in --dock and the calibration in --camera"
                )

    def _compare(self, marker: Marker) -> None:
        """Say once that the dock is of another colour than expected."""
        if marker.received_deg is None or marker.hue_deg is None:
            return
        self._off.append(np.exp(1j * np.radians(marker.received_deg - marker.hue_deg)))
        if len(self._off) == _COMPARED_FRAMES:
            off_deg = float(np.degrees(np.angle(sum(self._off))))
            if abs(off_deg) > _DISAGREEMENT_DEG:
                said, mend = "what this camera's water says", "on both cameras"
                if marker.given is not None:
                    said, mend = marker.given, "on this camera, or correct the dock's colour"
                self._aside(
                    f"warning: the dock's light is {off_deg:+.0f} degrees of hue from {said}: "
                    f"lock white balance and gain {mend}"
                )

    def fault(self, line: str) -> None:
        """Tell of what could not be read."""
        self._aside(f"error: {line}")

    def note(self, line: str) -> None:
        """Tell of what had to be assumed, or of a source that comes and goes."""
        self.notice(f"warning: {line}")

    def notice(self, line: str) -> None:
        """Tell of anything else, whichever thread it is."""
        self._aside(line)

    def summary(self, skipped: int, dropped: int) -> None:
        """The last line.

        ``skipped`` frames could not be read; ``dropped`` ones of a live source gave way to newer
        ones.
        """
        tracked = f"{self._tracked} tracked, " if self._tracked else ""
        words = f"{plural(self._frames, 'frame')}, {self._found} found, {tracked}{skipped} skipped"
        if self._ages_s:
            median, most = np.quantile(self._ages_s, (0.5, 0.99)) * 1000
            words += (
                f", {dropped} dropped for newer ones; age of the picture when its result was out "
                f"{median:.0f} ms in the median, {most:.0f} ms at most in 99 of 100"
            )
        print(words, file=sys.stderr if self._json else sys.stdout, flush=True)

    @contextmanager
    def progress(self, count: int | None) -> Iterator[None]:
        """A bar on standard error, if that is a terminal and the source long."""
        if not sys.stderr.isatty() or (count is not None and count < _LONG):
            yield
            return
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )

        columns = (
            TextColumn("detecting"), BarColumn(), MofNCompleteColumn(),
            TimeElapsedColumn(), TimeRemainingColumn(),
        )  # fmt: skip
        bar = Progress(
            *columns, console=Console(stderr=True), transient=True,
            redirect_stdout=False, redirect_stderr=False,
        )  # fmt: skip
        bar.add_task("", total=count)
        with bar:
            self._bar = bar
            try:
                yield
            finally:
                self._bar = None

    def _print(self, line: str) -> None:
        """A line of results.  Above the bar, where both are on the screen."""
        if self._bar is not None and sys.stdout.isatty():
            self._above_bar(line)
        else:
            print(line, flush=True)

    def _aside(self, line: str) -> None:
        line = f"chromadock: {line}"
        if self._bar is not None:
            self._above_bar(line)
        else:
            print(line, file=sys.stderr, flush=True)

    def _above_bar(self, line: str) -> None:
        assert self._bar is not None
        self._bar.console.print(line, markup=False, highlight=False, soft_wrap=True)


def _looked_for(marker: Marker) -> str:
    """The colour that was given beforehand."""
    if marker.hue_deg is None:
        return f"looking for markers of colour {marker.given}, whatever the water is"
    return (
        f"looking for markers of colour {marker.given}, hue {marker.hue_deg:.0f} degrees, "
        "whatever the water is"
    )


def _row(frame: Frame, detection: Detection) -> str:
    """One frame in the columns of ``_HEADER``; metres in the camera frame."""
    return f"{_frame_columns(frame, detection)}  {_track_columns(detection)}  {frame.name}"


def _track_columns(detection: Detection) -> str:
    """State and range of the track, in the 13 and 6 columns that they have."""
    track = detection.track
    if track is None:
        return f"{'-':<13}{'-':>6}"
    away = "-" if track.pose is None else f"{float(np.linalg.norm(track.pose.t)):.2f}"
    return f"{track.state.replace('_', ' '):<13}{away:>6}"


def _frame_columns(frame: Frame, detection: Detection) -> str:
    start = f"{frame.index:8d} {frame.time_s:8.3f}  {detection.state.replace('_', ' '):<10}"
    pose = detection.pose
    if pose is None:
        return f"{start}{'-':>9}{'-':>9}{'-':>9}{'-':>9}{'-':>10}"
    x, y, z = pose.t
    away = float(np.linalg.norm(pose.t))
    return f"{start}{away:9.3f}{x:9.3f}{y:9.3f}{z:9.3f}{pose.reprojection_px:10.2f}"
