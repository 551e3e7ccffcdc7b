"""What the commands that spread their work over processes have in common."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from chromadock.errors import ChromadockError
from chromadock.processors import processors

if TYPE_CHECKING:
    from distributed import Client

Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="tcp://HOST:PORT",
        help="A Dask scheduler whose workers do the work.",
        show_default="processes of this machine",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option("--workers", min=1, help="Processes of this machine.", show_default="one a core"),
]


def check_cluster(scheduler: str | None, workers: int | None) -> None:
    """Refuse both together.

    Raises
    ------
    ChromadockError
        One line.
    """
    if scheduler is not None and workers is not None:
        raise ChromadockError("--workers are this machine's: leave it out with --scheduler")


def open_cluster(
    scheduler: str | None, workers: int | None, most: int | None = None
) -> AbstractContextManager[Client]:
    """The processes that do the work, of this machine at most ``most`` where that is known.

    Raises
    ------
    ChromadockError
        Where Dask is not installed.
    """
    try:
        from chromadock.evaluate.cluster import cluster_of
    except ModuleNotFoundError as error:
        raise ChromadockError(
            f"work in several processes needs the package {error.name}: "
            "run `make setup` in the project's folder"
        ) from None
    count = workers or processors()
    return cluster_of(scheduler, count if most is None else min(count, most), aside)


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """A bar on standard error, if that is a terminal; takes how many of all are done."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    bar = Progress(
        TextColumn(what),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    )
    task = bar.add_task("", total=None)
    with bar:
        yield lambda done, total: bar.update(task, completed=done, total=total)


def aside(line: str) -> None:
    """A line for the user beside the output."""
    print(f"chromadock: {line}", file=sys.stderr, flush=True)
