"""The tables of an evaluation, for its page and for the documents."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import polars as pl

from chromadock.evaluate.filters import FILTERS
from chromadock.evaluate.frames import Sweep
from chromadock.evaluate.summary import (
    FRAME,
    MISMATCHED,
    Cell,
    Estimate,
    PixelRatio,
    cells,
    hue_disagreement,
    pixel_ratio,
    recall,
)


@dataclass(frozen=True)
class TernaryAgainst:
    """Ternary in one scenario against ``static``, which is tuned to the other water.

    ``mapping`` is what the dock shows; ``recall`` that of each filter over all distances.
    """

    title: str
    mapping: str
    static: str
    pixels: PixelRatio
    recall: Mapping[str, Estimate | None]


@dataclass(frozen=True)
class Place:
    """All filters at one distance of one scenario; ``hue`` is between dock and vehicle."""

    title: str
    frames: int
    hue: Estimate | None
    cells: list[Cell]


def scenarios(frames: pl.DataFrame) -> Iterator[tuple[str, pl.DataFrame]]:
    """What was done at several distances, near ones first: an experiment with one mapping."""
    groups = frames.group_by(["experiment", "mapping"], maintain_order=True)
    for (experiment, mapping), rows in groups:
        yield f"{experiment}, {mapping}", rows.sort("distance_m", maintain_order=True)


def ternary_against(frames: pl.DataFrame) -> list[TernaryAgainst]:
    """One row for each scenario whose water has a static filter that is tuned to another."""
    found = []
    for title, rows in scenarios(frames):
        static = MISMATCHED.get(rows["water"][0])
        pixels = None if static is None else pixel_ratio(rows, static)
        if static is not None and pixels is not None:
            recall = recall_by_filter(rows)
            found.append(TernaryAgainst(title, rows["mapping"][0], static, pixels, recall))
    return found


def recall_by_filter(frames: pl.DataFrame) -> dict[str, Estimate | None]:
    """Over all the frames."""
    return {
        str(name): recall(rows) for (name,), rows in frames.group_by("filter", maintain_order=True)
    }


@dataclass(frozen=True)
class MappingRow:
    """Recall with each mapping in one setting at one distance, where several were tried."""

    setting: str
    distance_m: float
    recall: Mapping[str, Estimate | None]


def mapping_table(study: Sweep) -> list[MappingRow]:
    """A row for each setting and distance, of the leading filter."""
    return [
        MappingRow(
            setting,
            distance,
            {
                str(name): recall(part)
                for (name,), part in at_one.group_by("mapping", maintain_order=True)
            },
        )
        for setting, rows in settings_of(study)
        for (distance,), at_one in rows.group_by("distance_m", maintain_order=True)
    ]


def leading_filter(frames: pl.DataFrame) -> str:
    """The one that a study of mappings tells of: the first in order of those that were used."""
    used = set(frames["filter"].unique())
    return next(name for name in FILTERS if name in used)


def settings_of(study: Sweep) -> Iterator[tuple[str, pl.DataFrame]]:
    """What was varied beside distance and mapping, near distances first, of the leading filter."""
    rows_of_one = study.frames.filter(pl.col("filter") == leading_filter(study.frames))
    for setting, rows in rows_of_one.group_by(study.keys, maintain_order=True):
        title = ", ".join(str(value) for value in setting)
        yield title, rows.sort("distance_m", maintain_order=True)


def places(frames: pl.DataFrame) -> Iterator[Place]:
    """One entry for each scenario and distance."""
    for title, rows in scenarios(frames):
        hues = dict(hue_disagreement(rows, ["distance_m"]))
        for (distance,), at_one in rows.group_by("distance_m", maintain_order=True):
            yield Place(
                title=f"{title}, {distance:g} m",
                frames=at_one.n_unique(FRAME),
                hue=hues.get((distance,)),
                cells=cells(at_one),
            )
