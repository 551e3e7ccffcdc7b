"""The frames of an evaluation as it left them, and which of them belong to a sweep."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import polars as pl

from chromadock.errors import ChromadockError
from chromadock.evaluate.rows import COLUMNS
from chromadock.text import one_line

FILE = "frames.parquet"

_PLACE = ("distance_m", "heading", "mapping")


@dataclass(frozen=True)
class Sweep:
    """The frames of an experiment that varied ``keys`` of its scene."""

    experiment: str
    keys: tuple[str, ...]
    frames: pl.DataFrame


@dataclass(frozen=True)
class Evaluation:
    """All frames, and those of each kind of experiment.

    ``still`` varied no more than the place; ``sweeps`` more; ``studies`` of mappings more, with
    several mappings in each setting.
    """

    frames: pl.DataFrame
    still: pl.DataFrame
    sweeps: list[Sweep]
    studies: list[Sweep]

    @classmethod
    def read(cls, out: Path) -> Evaluation:
        """The evaluation in ``out``; errors as of ``read_frames``."""
        frames = read_frames(out)
        return cls(frames, *_split(frames))


def read_frames(out: Path) -> pl.DataFrame:
    """The table of the evaluation in ``out``: a row for each frame and filter.

    Raises
    ------
    ChromadockError
        Where there is none, it cannot be read, or it is not one of ours.
    """
    path = out / FILE
    if not path.is_file():
        raise ChromadockError(f"{path}: not there: run `chromadock evaluate` first")
    try:
        frames = pl.read_parquet(path)
    except (OSError, pl.exceptions.PolarsError) as error:
        raise ChromadockError(
            f"{path}: not a whole Parquet file ({one_line(error, 80)}): evaluate again"
        ) from None
    lacking = [name for name in COLUMNS if name not in frames.columns]
    if lacking:
        raise ChromadockError(f"{path}: no column {lacking[0]}: evaluate again")
    if not frames.height:
        raise ChromadockError(f"{path}: no frames in it: evaluate again")
    return frames


def _split(frames: pl.DataFrame) -> tuple[pl.DataFrame, list[Sweep], list[Sweep]]:
    sweeps: list[Sweep] = []
    studies: list[Sweep] = []
    still = []
    for (experiment,), rows in frames.group_by("experiment", maintain_order=True):
        keys = varied_keys(rows)
        if keys:
            kind = studies if rows["mapping"].n_unique() > 1 else sweeps
            kind.append(Sweep(str(experiment), keys, rows))
        else:
            still.append(rows)
    return (pl.concat(still) if still else frames.clear()), sweeps, studies


def varied_keys(rows: pl.DataFrame) -> tuple[str, ...]:
    """Columns of one experiment that vary by more than the place tells."""
    places = rows.select(_PLACE).n_unique()
    return tuple(
        name
        for name in rows.columns
        if name not in COLUMNS and rows.select(*_PLACE, name).n_unique() > places
    )
