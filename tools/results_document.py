"""docs/results.md and its figures, from the frames of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import polars as pl
from jinja2 import FileSystemLoader
from results_approach import approach_drawing, approach_section, read_frames
from results_claims import claims
from results_conditions import CONDITIONS, condition_tables
from results_tables import (
    REALISM_M,
    REALISM_POINTS,
    mapping_study,
    realism,
    recall_table,
    sweep_table,
    tuning_table,
)

from chromadock import method
from chromadock.errors import ChromadockError
from chromadock.evaluate import drawings
from chromadock.evaluate.drawings import Drawing
from chromadock.evaluate.filters import ROBUST
from chromadock.evaluate.frames import Evaluation, Sweep
from chromadock.evaluate.gallery import read_gallery
from chromadock.evaluate.provenance import read_provenance, sources, versions_line
from chromadock.evaluate.rendering import environment, gallery_svg
from chromadock.evaluate.style import filters
from chromadock.evaluate.summary import TERNARY
from chromadock.evaluate.tables import places, ternary_against
from chromadock.robust.weigh.acceptance import PLACE_TOLERANCE

LAKE, POOL = "lake", "pool"
RENDERED, PHOTOGRAPHS = "rendered water", "photographs"
"""Experiments by name."""

SUBJECTS = {ROBUST: "the robust method", TERNARY: "ternary"}
"""Filters that are told of, and what they are called in a sentence."""
COMPARED = (TERNARY, ROBUST)
"""Filters whose recall before photographs is shown beside that in rendered water."""

SHOWN_M = (1.0, 3.0)
SHOWN_WIDTH = 240
"""Of the gallery in the document: places, and pixels of a picture."""


@dataclass(frozen=True)
class Run:
    """What ``chromadock evaluate`` left in the folder ``out``."""

    out: Path
    evaluation: Evaluation

    @classmethod
    def read(cls, out: Path) -> Run:
        """The run in ``out``.

        Raises:
            ChromadockError: it is not one, or not of the paper's experiments.
        """
        run = cls(out, Evaluation.read(out))
        if not run.of(LAKE).height or not run.of(POOL).height:
            raise ChromadockError(f"{out}: not the experiments {LAKE} and {POOL}: run make results")
        return run

    @property
    def sweeps(self) -> list[Sweep]:
        """All but the conditions, which have tables of their own."""
        return [sweep for sweep in self.evaluation.sweeps if sweep.experiment != CONDITIONS]

    def of(self, *experiments: str) -> pl.DataFrame:
        """The frames of experiments that swept nothing."""
        return self.evaluation.still.filter(pl.col("experiment").is_in(experiments))


def figures(run: Run) -> dict[str, Drawing]:
    """All figures, each with an SVG, by name."""
    return {drawing.name: drawing for drawing in _figures(run)}


def _figures(run: Run) -> Iterator[Drawing]:
    paper = run.of(LAKE, POOL)
    yield drawings.passed(paper)
    yield _gallery(run.out, paper)
    yield from drawings.measured(paper)
    both = run.of(RENDERED, PHOTOGRAPHS)
    if both.height:
        recall = next(drawings.measured(both))
        yield replace(recall, name="photographs", title="Finding the dock before photographs")
    for study in run.evaluation.studies:
        yield drawings.compared(study)
    for sweep in run.sweeps:
        yield drawings.swept(sweep)
    approaches = read_frames(run.out)
    if approaches is not None:
        yield approach_drawing(approaches)


def _gallery(out: Path, paper: pl.DataFrame) -> Drawing:
    """The first run at some places, in one drawing."""
    near = paper.filter(pl.col("distance_m").is_in(SHOWN_M))
    groups = near.unique(["experiment", "mapping", "distance_m"], keep="first", maintain_order=True)
    exhibits = read_gallery(out, list(groups["run"]), filters(paper), SHOWN_WIDTH)
    return drawings.gallery(paper, exhibits, gallery_svg(exhibits))


def document(run: Run, shown: Mapping[str, Drawing]) -> str:
    """The text; ``shown`` are its figures."""
    paper = run.of(LAKE, POOL)
    provenance = read_provenance(run.out)
    approaches = read_frames(run.out)
    template = environment(FileSystemLoader(Path(__file__).parent), markup=False)
    return template.get_template("results.md.jinja").render(
        figures=shown,
        ratios=ternary_against(paper),
        recall=recall_table(paper),
        filters=filters(paper),
        places=list(places(paper)),
        studies=[mapping_study(study) for study in run.evaluation.studies],
        approach=None if approaches is None else approach_section(approaches),
        sweeps=[(sweep, sweep_table(sweep), filters(sweep.frames)) for sweep in run.sweeps],
        conditions=[
            table
            for study in run.evaluation.sweeps
            if study.experiment == CONDITIONS
            for table in condition_tables(study)
        ],
        realism={name: realism(run.of(RENDERED), run.of(PHOTOGRAPHS), name) for name in COMPARED},
        place_tolerance=PLACE_TOLERANCE,
        subjects=SUBJECTS,
        near_m=REALISM_M,
        points=REALISM_POINTS,
        claims=claims(run.of(LAKE), run.of(POOL)),
        tuning=tuning_table(run.out),
        sources=sources(provenance, run.evaluation.frames),
        versions=versions_line(provenance),
        method=method,
        zip=zip,
    )
