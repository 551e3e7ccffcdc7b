"""``chromadock replay``: a recording with other settings."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def replay(
    recording: Annotated[
        Path,
        typer.Argument(
            metavar="DIVE.mcap",
            help="What `--record` wrote.",
            show_default=False,
        ),
    ],
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Goes before a key of the recorded settings, e.g. detector.method=paper; may be "
            "repeated.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="Write comparison.json, frames.jsonl (the new results) and comparison.svg there.",
            show_default=False,
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print the figures as one JSON object.")
    ] = False,
) -> None:
    """Run the detector again over a recording, and compare with what it said then.

    docs/recording.md tells what a recording has, and what it has not.
    """
    from chromadock.cli.replay_frames import replay_frames

    raise typer.Exit(replay_frames(recording, set_ or [], out, json))
