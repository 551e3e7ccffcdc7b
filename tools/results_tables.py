"""Tables of docs/results.md that the evaluation's page does not have."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import polars as pl

from chromadock.evaluate.frames import Sweep
from chromadock.evaluate.summary import TERNARY, Estimate, hue_disagreement, recall
from chromadock.evaluate.tables import MappingRow, mapping_table, recall_by_filter, scenarios

REALISM_M = (1.0, 3.0)
REALISM_POINTS = 15.0
"""From the one to the other distance, rendered water is to be as hard as photographs within
so many percentage points of recall."""

Recall = Mapping[str, Estimate | None]
"""By filter."""


@dataclass(frozen=True)
class RecallRow:
    """Of one scenario at one distance."""

    title: str
    recall: Recall


@dataclass(frozen=True)
class SweepRow:
    """At one setting of the swept keys."""

    setting: Sequence[str]
    hue: Estimate | None
    recall: Recall


@dataclass(frozen=True)
class Verdict:
    """``lost`` has the settings at which a filter finds the dock less than half as often as at
    its best; ``found`` tells whether it finds it at all."""

    lost: Sequence[str]
    found: bool


@dataclass(frozen=True)
class SweepTable:
    """``verdicts`` by filter, of those that were run."""

    rows: Sequence[SweepRow]
    verdicts: Mapping[str, Verdict]


@dataclass(frozen=True)
class Realism:
    """Recall of one filter by distance, (metres, rendered, photographs, points between them)."""

    rows: Sequence[tuple[float, Estimate, Estimate, float]]
    worst_points: float

    @property
    def within(self) -> bool:
        """Whether the two are as near as they are to be."""
        return self.worst_points <= REALISM_POINTS

    @property
    def telling(self) -> bool:
        """Whether the dock is found at all: two filters that find nothing agree too easily."""
        return any(
            max(a.value, b.value) > REALISM_POINTS / 100
            for distance, a, b, _ in self.rows
            if _is_near(distance)
        )


def recall_table(frames: pl.DataFrame) -> list[RecallRow]:
    """A row for each scenario and distance."""
    return [
        RecallRow(f"{title}, {distance:g} m", recall_by_filter(at_one))
        for title, rows in scenarios(frames)
        for (distance,), at_one in rows.group_by("distance_m", maintain_order=True)
    ]


def sweep_table(sweep: Sweep) -> SweepTable:
    """A row for each setting, in the order of the experiment."""
    hues = dict(hue_disagreement(sweep.frames, sweep.keys))
    rows = [
        SweepRow([_shown(v) for v in setting], hues.get(setting), recall_by_filter(part))
        for setting, part in sweep.frames.group_by(sweep.keys, maintain_order=True)
    ]
    return SweepTable(rows, {name: _verdict(rows, name) for name in rows[0].recall})


def _verdict(rows: Sequence[SweepRow], name: str) -> Verdict:
    found = [(row.setting, row.recall.get(name)) for row in rows]
    best = max((recall.value for _, recall in found if recall), default=0.0)
    lost = [
        " and ".join(setting)
        for setting, recall in found
        if recall is None or recall.value < best / 2
    ]
    return Verdict(lost, best > 0)


def _shown(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def realism(
    rendered: pl.DataFrame, photographs: pl.DataFrame, name: str = TERNARY
) -> Realism | None:
    """Rendered water beside photographs for one filter; None where one of them was not run."""
    first, second = (_by_distance(frames, name) for frames in (rendered, photographs))
    rows = [
        (distance, a, second[distance], 100 * (a.value - second[distance].value))
        for distance, a in first.items()
        if distance in second
    ]
    near = [abs(points) for distance, *_, points in rows if _is_near(distance)]
    return Realism(rows, max(near)) if near else None


def _is_near(distance_m: float) -> bool:
    return REALISM_M[0] <= distance_m <= REALISM_M[1]


def _by_distance(frames: pl.DataFrame, name: str) -> dict[float, Estimate]:
    of_one = frames.filter(pl.col("filter") == name)
    found = [(distance, recall(rows)) for (distance,), rows in of_one.group_by("distance_m")]
    return {distance: each for distance, each in sorted(found) if each is not None}


@dataclass(frozen=True)
class MappingStudy:
    """How the mappings did against each other with one filter.

    ``farther``, ``nearer``: settings and distances at which contrast finds the dock surely more,
    or less, often than ternary does: their intervals lie apart.
    """

    study: Sweep
    mappings: Sequence[str]
    rows: Sequence[MappingRow]
    farther: Sequence[str]
    nearer: Sequence[str]


def mapping_study(study: Sweep) -> MappingStudy:
    """The table of a study, and where its mappings differ."""
    rows = mapping_table(study)
    farther, nearer = [], []
    for row in rows:
        contrast, ternary = (row.recall.get(name) for name in ("contrast", "ternary"))
        if contrast is None or ternary is None:
            continue
        place = f"{row.setting} at {row.distance_m:g} m"
        if contrast.low > ternary.high:
            farther.append(place)
        elif contrast.high < ternary.low:
            nearer.append(place)
    return MappingStudy(study, list(rows[0].recall), rows, farther, nearer)


def tuning_table(out: Path) -> Mapping[str, Any]:
    """The static filters' numbers as the evaluation wrote them."""
    content: Mapping[str, Any] = json.loads((out / "tuned.json").read_text(encoding="utf-8"))
    return content
