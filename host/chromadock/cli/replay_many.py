"""What ``chromadock replay`` does with many recordings."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console

from chromadock.cli.cluster_options import aside, open_cluster, progress_bar
from chromadock.cli.exit_status import EXIT_SKIPPED
from chromadock.output.jsonlines import JsonLines, json_line
from chromadock.replay.recordings import jobs_of
from chromadock.replay.run import make_folder
from chromadock.replay.summary import summarised
from chromadock.replay.table import table_of_many

if TYPE_CHECKING:
    from chromadock.replay.many import Row

_WIDE = 1000
"""Columns of what goes to no terminal, at most: each recording stays on its line there."""


def replay_many(
    paths: Sequence[Path],
    changes: Mapping[str, Any],
    out: Path | None,
    json: bool,
    scheduler: str | None,
    workers: int | None,
) -> int:
    """Replay all of them side by side, compare, and tell; the exit status."""
    if out is not None:
        make_folder(out)
    jobs = jobs_of(paths, out)
    with open_cluster(scheduler, workers, len(jobs)) as client, progress_bar("recordings") as told:
        from chromadock.replay.many import replay_all

        rows = replay_all(jobs, changes, client, told)
    for row in rows:
        for line in (*row.lines, *([] if row.fault is None else [f"error: {row.fault}"])):
            aside(line)
    frames = [frame for row in rows if row.result is not None for frame in row.result.frames]
    total = summarised(frames, one_run=False)
    figures = {"recordings": [_figures(row) for row in rows], "all": total.to_dict()}
    if json:
        print(json_line(figures))
    else:
        shown = [
            (str(row.job.path), None if row.result is None else row.result.summary) for row in rows
        ]
        Console(width=None if sys.stdout.isatty() else _WIDE).print(table_of_many(shown, total))
    if out is not None:
        with JsonLines(out / "comparison.json") as file:
            file.write(figures)
    whole = all(row.result is not None and row.result.whole for row in rows)
    return 0 if whole else EXIT_SKIPPED


def _figures(row: Row) -> dict[str, Any]:
    """One recording's, as JSON has them."""
    which = {"recording": str(row.job.path)}
    if row.job.out is not None:
        which["folder"] = row.job.out.name
    if row.result is None:
        return {**which, "fault": row.fault}
    return {**which, "whole": row.result.whole, **row.result.summary.to_dict()}
