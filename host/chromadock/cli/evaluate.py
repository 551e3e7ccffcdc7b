"""``chromadock evaluate``: the experiments, on many simulated frames."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from chromadock.cli.cluster_options import (
    Scheduler,
    Workers,
    aside,
    check_cluster,
    open_cluster,
    progress_bar,
)
from chromadock.cli.exit_status import EXIT_INTERRUPTED
from chromadock.errors import ChromadockError
from chromadock.text import plural


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
    scheduler: Scheduler = None,
    workers: Workers = None,
    frames: Annotated[
        int | None,
        typer.Option(min=1, help="At most so many frames a run, for a quick look."),
    ] = None,
) -> None:
    """Run experiments on simulated frames and compare the filters in a report."""
    try:
        from chromadock.evaluate.report import write_report
        from chromadock.evaluate.run import evaluate as run_all
        from chromadock.evaluate.runs import runs_of_files
    except ModuleNotFoundError as error:
        raise ChromadockError(
            f"an evaluation needs the package {error.name}: "
            "run `make setup` in the project's folder"
        ) from None
    check_cluster(scheduler, workers)
    runs = runs_of_files(experiments, frames, aside)
    if not runs:
        raise ChromadockError("no experiment is left: nothing to evaluate")
    try:
        with open_cluster(scheduler, workers) as client, progress_bar("frames") as told:
            run_all(runs, out, client, told)
    except KeyboardInterrupt:
        aside(f"interrupted: what is done is kept in {out}; the same command goes on from there")
        raise typer.Exit(EXIT_INTERRUPTED) from None
    report = write_report(out)
    count = sum(run.frames for run in runs)
    print(f"{plural(len(runs), 'run')}, {plural(count, 'frame')}, simulated: wrote {report}")
