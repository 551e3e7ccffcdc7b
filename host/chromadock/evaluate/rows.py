"""The table of an evaluation: a row for each frame and filter."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import polars as pl

COLUMNS: Mapping[str, Any] = {
    **dict.fromkeys(("experiment", "run", "water", "mapping"), pl.String),
    "distance_m": pl.Float64,
    "heading": pl.String,
    "frame": pl.Int64,
    "time_s": pl.Float64,
    "filter": pl.String,
    **dict.fromkeys(("passed", "passed_outside"), pl.Float64),
    **dict.fromkeys(("found", "correct", "false_dock", "wrong_pose"), pl.Boolean),
    **dict.fromkeys(("range_true_m", "range_error"), pl.Float64),
    **dict.fromkeys(("bearing_error_deg", "attitude_error_deg"), pl.Float64),
    **dict.fromkeys(("dock_hue_deg", "vehicle_hue_deg", "hue_disagreement_deg"), pl.Float64),
    **dict.fromkeys(("background_r", "background_g", "background_b"), pl.Int64),
    **dict.fromkeys(("dock_background_r", "dock_background_g", "dock_background_b"), pl.Int64),
    "markers_in_view": pl.Boolean,
}
"""Of every table.  Beside them stands a column for each key or label that an experiment varied,
of numbers where all its values are numbers, null for the experiments that do not vary it."""

FILES = "files"
"""Column of a part alone: {name: content} of the gallery's files, in one row of the sample."""


def part(rows: Sequence[Mapping[str, Any]], files: Mapping[str, bytes]) -> pl.DataFrame:
    """The rows of one chunk, with the files of its sample frame, if it has one."""
    content = [{"name": name, "content": data} for name, data in files.items()]
    return pl.DataFrame(rows, schema=COLUMNS).with_columns(
        pl.Series(
            FILES,
            [content, *([[]] * (len(rows) - 1))],
            dtype=pl.List(pl.Struct({"name": pl.String, "content": pl.Binary})),
        )
    )


def files_of(table: pl.DataFrame) -> dict[str, bytes]:
    """The gallery's files of a part."""
    return {file["name"]: file["content"] for file in table[FILES][0]}


def merged(parts: Iterable[tuple[pl.DataFrame, Mapping[str, Any]]]) -> pl.DataFrame:
    """One table of all parts, each with what its run varied."""
    tables = [
        table.drop(FILES).with_columns(
            pl.lit(float(value) if _is_number(value) else str(value)).alias(key)
            for key, value in varied.items()
        )
        for table, varied in parts
    ]
    mixed = _mixed_columns(tables)
    tables = [
        t.with_columns(pl.col(c).cast(pl.String) for c in t.columns if c in mixed) for t in tables
    ]
    return pl.concat(tables, how="diagonal")


def _mixed_columns(tables: Iterable[pl.DataFrame]) -> set[str]:
    """Columns with numbers in one table and texts in another."""
    types: dict[str, set[Any]] = {}
    for table in tables:
        for column, dtype in table.schema.items():
            types.setdefault(column, set()).add(dtype)
    return {column for column, found in types.items() if len(found) > 1}


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)
