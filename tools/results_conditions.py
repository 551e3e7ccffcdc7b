"""The tables of docs/results.md on light, cameras and lamps: a condition a row."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import polars as pl

from chromadock.evaluate.filters import ROBUST
from chromadock.evaluate.frames import Sweep
from chromadock.evaluate.summary import Estimate, median, recall, share

CONDITIONS = "conditions"
"""The experiment's name; its first condition is what the others are compared with."""
CONDITION, WATER = "condition", "body of water"
"""What it varies beside the distance."""


@dataclass(frozen=True)
class Cell:
    """The robust method in one condition at one distance.

    ``wrong``: share of all frames in which a pose was told that is wrong.  ``hue``: median angle
    between dock and vehicle; None where lamps do not follow the water.
    """

    recall: Estimate | None
    wrong: Estimate | None
    hue: Estimate | None


@dataclass(frozen=True)
class ConditionTable:
    """One water: ``rows`` of (condition, a cell for each of ``distances_m``).

    ``lost``: where the dock is found less than half as often as in the first condition at the same
    distance.  ``mistaken``: where a wrong pose was told.
    """

    water: str
    distances_m: Sequence[float]
    rows: Sequence[tuple[str, Sequence[Cell]]]

    @property
    def lost(self) -> list[str]:
        """Conditions with their distances."""
        _, best = self.rows[0]
        return self._where(lambda i, cell: _value(cell.recall) < _value(best[i].recall) / 2)

    @property
    def mistaken(self) -> list[str]:
        """Conditions with their distances."""
        return self._where(lambda _, cell: _value(cell.wrong) > 0)

    def _where(self, true_of: Callable[[int, Cell], bool]) -> list[str]:
        """Conditions with the distances at which something is true of the cell."""
        found = []
        for condition, cells in self.rows:
            there = [i for i, cell in enumerate(cells) if true_of(i, cell)]
            if there:
                metres = " and ".join(f"{self.distances_m[i]:g}" for i in there)
                found.append(f"{condition}, at {metres} m")
        return found


def condition_tables(study: Sweep) -> list[ConditionTable]:
    """A table for each water, in the order of the experiment."""
    frames = study.frames.filter(pl.col("filter") == ROBUST)
    distances = frames["distance_m"].unique().sort().to_list()
    return [
        ConditionTable(
            str(water),
            distances,
            [
                (str(condition), [_cell(rows, distance) for distance in distances])
                for (condition,), rows in in_one.group_by(CONDITION, maintain_order=True)
            ],
        )
        for (water,), in_one in frames.group_by(WATER, maintain_order=True)
    ]


def _cell(rows: pl.DataFrame, distance_m: float) -> Cell:
    here = rows.filter(pl.col("distance_m") == distance_m)
    return Cell(recall(here), share(here, "wrong_pose"), median(here, "hue_disagreement_deg"))


def _value(estimate: Estimate | None) -> float:
    return 0.0 if estimate is None else estimate.value
