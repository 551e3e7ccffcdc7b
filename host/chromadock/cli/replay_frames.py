"""What ``chromadock replay`` does with one recording."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import track

from chromadock.cli.cluster_options import aside
from chromadock.cli.exit_status import EXIT_SKIPPED
from chromadock.output.jsonlines import json_line
from chromadock.replay.run import replayed
from chromadock.replay.table import table
from chromadock.sources import Frame, Source


def replay_frames(path: Path, changes: Mapping[str, Any], out: Path | None, json: bool) -> int:
    """Replay, compare, and tell; the exit status."""
    result = replayed(path, changes, out, aside, _watched)
    if json:
        print(json_line(result.summary.to_dict()))
    else:
        Console().print(table(result.summary))
    return 0 if result.whole else EXIT_SKIPPED


def _watched(frames: Source) -> Iterable[Frame]:
    """With a bar on standard error, if that is a terminal."""
    return track(
        frames, "replaying", frames.count, console=Console(stderr=True), transient=True,
        disable=not sys.stderr.isatty(),
    )  # fmt: skip
