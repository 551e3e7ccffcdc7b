"""``chromadock evaluate``: the experiments, on many simulated frames."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from chromadock.errors import ChromadockError
from chromadock.processors import processors
from chromadock.text import plural

if TYPE_CHECKING:
    from chromadock.evaluate.run import Progress as Told

EXIT_INTERRUPTED = 130


def evaluate(
    experiments: Annotated[
        list[Path],
        typer.Argument(
            metavar="EXPERIMENT.toml",
            help="What to run, such as experiments/pool.toml.",
            show_default=False,
        ),
    ],
    out: Annotated[
        Path,
        typer.Option(help="Folder for report, tables and gallery; what is there is taken up."),
    ],
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="tcp://HOST:PORT",
            help="A Dask scheduler whose workers do the work.",
            show_default="processes of this machine",
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(min=1, help="Processes of this machine.", show_default="one a core"),
    ] = None,
    frames: Annotated[
        int | None,
        typer.Option(min=1, help="At most so many frames a run, for a quick look."),
    ] = None,
) -> None:
    """Run experiments on simulated frames and compare the filters in a report."""
    try:
        from chromadock.evaluate.cluster import local_cluster, remote_cluster
        from chromadock.evaluate.report import write_report
        from chromadock.evaluate.run import evaluate as run_all
        from chromadock.evaluate.runs import runs_of_files
    except ModuleNotFoundError as error:
        raise ChromadockError(
            f"an evaluation needs the package {error.name}: "
            "run `make setup` in the project's folder"
        ) from None
    if scheduler is not None and workers is not None:
        raise ChromadockError("--workers are this machine's: leave it out with --scheduler")
    runs = runs_of_files(experiments, frames, _aside)
    if not runs:
        raise ChromadockError("no experiment is left: nothing to evaluate")
    cluster = (
        local_cluster(workers or processors())
        if scheduler is None
        else remote_cluster(scheduler, _aside)
    )
    try:
        with cluster as client, _progress() as told:
            run_all(runs, out, client, told)
    except KeyboardInterrupt:
        _aside(f"interrupted: what is done is kept in {out}; the same command goes on from there")
        raise typer.Exit(EXIT_INTERRUPTED) from None
    report = write_report(out)
    count = sum(run.frames for run in runs)
    print(f"{plural(len(runs), 'run')}, {plural(count, 'frame')}, simulated: wrote {report}")


@contextmanager
def _progress() -> Iterator[Told]:
    """A bar on standard error, if that is a terminal."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    bar = Progress(
        TextColumn("frames"),
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


def _aside(line: str) -> None:
    print(f"chromadock: {line}", file=sys.stderr, flush=True)
