"""Many recordings, each by one of the processes of a cluster."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
from distributed import Client, Future, as_completed

from chromadock.errors import ChromadockError
from chromadock.evaluate.cluster import ClusterLostError, result_of
from chromadock.replay.recordings import Job
from chromadock.replay.run import Replayed, replayed
from chromadock.vehicle.reading import with_whole_paths

Progress = Callable[[int, int], None]
"""Takes the numbers of recordings that are done and of all."""


@dataclass(frozen=True)
class Row:
    """What became of one recording: its ``result``, or None and the ``fault``; ``lines`` that
    tell what could not be read or drawn."""

    job: Job
    result: Replayed | None
    fault: str | None = None
    lines: tuple[str, ...] = ()


def replay_all(
    jobs: Sequence[Job], changes: Mapping[str, Any], client: Client, progress: Progress
) -> list[Row]:
    """Replay recordings side by side; the rows are in the order of ``jobs``.

    The largest are begun first, for the last one is waited for.  A recording that cannot be
    replayed is a row with its fault, and the others are done.

    Parameters
    ----------
    changes : settings by dotted key; files among them are sought in the working directory.
    client : of the cluster, whose workers must see the recordings and the folders of the results
        under the same paths as this process.
    progress : is told after each recording.

    Raises
    ------
    ClusterLostError
        Where the scheduler goes away.
    """
    whole = with_whole_paths(changes)
    sizes = [_size(job.path) for job in jobs]
    largest_first = sorted(range(len(jobs)), key=lambda k: -sizes[k])
    futures: dict[Future[tuple[Replayed, tuple[str, ...]]], int] = {}
    for turn, k in enumerate(largest_first):
        # Not pure: the same file may have grown since it was replayed last.
        future = client.submit(_one, jobs[k], whole, priority=-turn, pure=False)
        futures[future] = k
    rows: dict[int, Row] = {}
    progress(0, len(jobs))
    for future in as_completed(futures):  # type: ignore[no-untyped-call]
        k = futures.pop(future)
        rows[k] = _row(jobs[k], future)
        progress(len(rows), len(jobs))
    return [rows[k] for k in range(len(jobs))]


def _one(job: Job, changes: Mapping[str, Any]) -> tuple[Replayed, tuple[str, ...]]:
    """By a worker: a recording's replay, and the lines for the user."""
    cv2.setNumThreads(1)
    lines: list[str] = []
    result = replayed(job.path.absolute(), changes, job.absolute_out, lines.append)
    return result, tuple(_shorter(line, job) for line in lines)


def _row(job: Job, future: Future[Any]) -> Row:
    try:
        result, lines = result_of(future)
    except ClusterLostError:
        raise
    except ChromadockError as error:
        return Row(job, None, _shorter(str(error), job))
    return Row(job, result, lines=lines)


def _shorter(line: str, job: Job) -> str:
    """With the recording called as the user does."""
    return line.replace(str(job.path.absolute()), str(job.path))


def _size(path: Path) -> int:
    """Bytes; 0 of a file that has gone, which its replay says."""
    try:
        return path.stat().st_size
    except OSError:
        return 0
