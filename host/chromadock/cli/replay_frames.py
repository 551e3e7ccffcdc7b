"""What ``chromadock replay`` does."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

from rich.console import Console
from rich.progress import track

from chromadock.cli.exit_status import EXIT_SKIPPED
from chromadock.cli.report import Report
from chromadock.errors import ChromadockError
from chromadock.output.base import cannot_write
from chromadock.output.jsonlines import JsonLines, json_line
from chromadock.output.results import result_record
from chromadock.replay.pairs import Pair
from chromadock.replay.recorded import Recorded, read_recorded
from chromadock.replay.summary import Summary, summarised
from chromadock.replay.table import table
from chromadock.sources import Source, open_source
from chromadock.toml_file import change


def replay_frames(path: Path, changes: Sequence[str], out: Path | None, json: bool) -> int:
    """Replay, compare, and tell; the exit status."""
    example = "detector.method=paper"
    recorded = read_recorded(path, dict(change(text, example) for text in changes))
    if out is not None:
        _make(out)
    report = Report(json=json, calibrated=recorded.camera is not None)
    with open_source(str(path), on_fault=report.fault) as frames:
        pairs = _run(recorded, frames, out)
    summary = summarised(pairs)
    if json:
        print(json_line(summary.to_dict()))
    else:
        Console().print(table(summary))
    if out is not None:
        _write(out, summary, pairs, report)
    return EXIT_SKIPPED if frames.errors or frames.cut_short else 0


def _run(recorded: Recorded, frames: Source, out: Path | None) -> list[Pair]:
    """Every frame anew, in its order."""
    shown = track(
        frames, "replaying", frames.count, console=Console(stderr=True), transient=True,
        disable=not sys.stderr.isatty(),
    )  # fmt: skip
    pairs = []
    lines = None if out is None else JsonLines(out / "frames.jsonl")
    try:
        for frame in shown:
            new = recorded.detector.process(frame.image, frame.time_s, frame.attitude)
            pairs.append(Pair(frame.time_s, recorded.results.get(frame.time_s), new))
            if lines is not None:
                lines.write(result_record(frame, new, None))
    except BaseException:
        if lines is not None:
            lines.drop()
        raise
    if lines is not None:
        lines.keep()
    return pairs


def _write(out: Path, summary: Summary, pairs: Sequence[Pair], report: Report) -> None:
    with JsonLines(out / "comparison.json") as file:
        file.write(summary.to_dict())
    if find_spec("matplotlib") is None:
        report.notice("no picture: matplotlib is not installed: pip install chromadock[sim]")
        return
    from chromadock.replay.picture import write_picture

    try:
        write_picture(out / "comparison.svg", pairs)
    except OSError as error:
        raise cannot_write(out / "comparison.svg", error) from None


def _make(out: Path) -> None:
    try:
        out.mkdir(exist_ok=True)
    except OSError as error:
        raise ChromadockError(
            f"--out {out}: no folder can be made there ({error.strerror}): give another"
        ) from None
