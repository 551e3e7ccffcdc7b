"""The page of an evaluation: one file with everything in it, for any browser, offline."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

from chromadock.evaluate import drawings
from chromadock.evaluate.drawings import Drawing
from chromadock.evaluate.frames import Evaluation
from chromadock.evaluate.gallery import read_gallery
from chromadock.evaluate.provenance import read_provenance, source_line, sources, versions_line
from chromadock.evaluate.rendering import environment
from chromadock.evaluate.store import write_whole
from chromadock.evaluate.style import filters
from chromadock.evaluate.tables import places, ternary_against

FILE = "report.html"


def write_report(out: Path) -> Path:
    """Write ``report.html`` from the tables, the pictures and the provenance in ``out``.

    Raises
    ------
    ChromadockError
        Where something of the evaluation is missing or broken, or the page cannot be written.
    """
    evaluation = Evaluation.read(out)
    provenance = read_provenance(out)
    templates = environment()
    templates.filters["source"] = partial(source_line, provenance)
    page = templates.get_template("report.html").render(
        drawings=list(_drawings(out, evaluation)),
        ratios=[e for e in ternary_against(evaluation.still) if e.mapping == "ternary"],
        places=list(places(evaluation.still)),
        sources=sources(provenance, evaluation.frames),
        versions=versions_line(provenance),
    )
    path = out / FILE
    write_whole(path, page.encode())
    return path


def _drawings(out: Path, evaluation: Evaluation) -> Iterator[Drawing]:
    """In the order of the page."""
    if evaluation.still.height:
        yield drawings.passed(evaluation.still)
        runs = list(evaluation.still["run"].unique(maintain_order=True))
        exhibits = read_gallery(out, runs, filters(evaluation.still))
        yield drawings.gallery(evaluation.still, exhibits)
        yield from drawings.measured(evaluation.still)
    for sweep in evaluation.sweeps:
        yield drawings.swept(sweep)
    for study in evaluation.studies:
        yield drawings.compared(study)
