"""``chromadock replay``: a recording with other settings."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from chromadock.cli.cluster_options import Scheduler, Workers, check_cluster
from chromadock.cli.vehicle_options import Changes, changes_of
from chromadock.errors import ChromadockError


def replay(
    recordings: Annotated[
        list[Path],
        typer.Argument(
            metavar="DIVE.mcap|DIVES/...",
            help="What `--record` wrote: files, and folders of them.",
            show_default=False,
        ),
    ],
    set_: Changes = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            help="Write comparison.json, frames.jsonl (the new results) and comparison.svg there; "
            "of several recordings each into a folder of its own.",
            show_default=False,
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print the figures as one JSON object.")
    ] = False,
    scheduler: Scheduler = None,
    workers: Workers = None,
) -> None:
    """Run the detector again over recordings, and compare with what it said then.

    Several are replayed side by side.  docs/recording.md tells what a recording has, and what it
    has not.
    """
    from chromadock.replay.recorded import check_changes
    from chromadock.replay.recordings import recordings as found_in

    check_cluster(scheduler, workers)
    changes = changes_of(set_)
    check_changes(changes)
    paths = found_in(recordings)
    if len(recordings) > 1 or recordings[0].is_dir():
        from chromadock.cli.replay_many import replay_many

        raise typer.Exit(replay_many(paths, changes, out, json, scheduler, workers))
    if scheduler is not None or workers is not None:
        raise ChromadockError(
            f"{recordings[0]}: one recording is replayed in this process: leave out --scheduler "
            "and --workers, or give several recordings or a folder"
        )
    from chromadock.cli.replay_frames import replay_frames

    raise typer.Exit(replay_frames(paths[0], changes, out, json))
