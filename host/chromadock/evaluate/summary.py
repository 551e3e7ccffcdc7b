"""What the frames of an evaluation come to: shares, recall, errors, each with its interval."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from chromadock.evaluate.filters import STATIC
from chromadock.evaluate.statistics import (
    CONFIDENCE,
    independent_size,
    median_interval,
    wilson,
)

Key = tuple[Any, ...]

FRAME = ("experiment", "run", "frame")
"""What names a frame; it has a row for each filter."""

TERNARY = "adaptive ternary"
MISMATCHED = {
    scene: name for name, tuned in STATIC.items() for scene in STATIC.values() if scene != tuned
}
"""Water to the static filter that is tuned to the other one."""

BLOCK_S = 5.0
"""Longer than waves, the rolling mean of the colour and the cameras' automatics correlate."""

_RESAMPLES = 2000


@dataclass(frozen=True)
class Estimate:
    """A value with the ends of its 95 % interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Cell:
    """One filter on some frames; None where there was nothing to measure.

    ``passed`` and ``outside`` are medians of shares of pixels; ``recall`` is the share of
    those frames that show all markers; ``false_docks`` of all frames; errors are medians of
    absolute values over correct frames: relative, degrees, degrees.
    """

    filter: str
    passed: Estimate | None
    outside: Estimate | None
    recall: Estimate | None
    false_docks: Estimate | None
    range_error: Estimate | None
    bearing_error_deg: Estimate | None
    attitude_error_deg: Estimate | None


def cells(frames: pl.DataFrame) -> list[Cell]:
    """One cell for each filter, in the order in which they first occur."""
    return [
        Cell(
            filter=str(name),
            passed=median(rows, "passed"),
            outside=median(rows, "passed_outside"),
            recall=recall(rows),
            false_docks=share(rows, "false_dock"),
            range_error=median_error(rows, "range_error"),
            bearing_error_deg=median_error(rows, "bearing_error_deg"),
            attitude_error_deg=median_error(rows, "attitude_error_deg"),
        )
        for (name,), rows in frames.group_by("filter", maintain_order=True)
    ]


def recall(rows: pl.DataFrame) -> Estimate | None:
    """Of one filter: the share of frames with all markers in view in which it was correct."""
    return share(rows.filter(pl.col("markers_in_view")), "correct")


def median_error(rows: pl.DataFrame, column: str) -> Estimate | None:
    """Of one filter: the median of the absolute values."""
    return median(rows.with_columns(pl.col(column).abs()), column)


def share(rows: pl.DataFrame, column: str) -> Estimate | None:
    """Share of rows in which ``column`` is true, with Wilson's interval."""
    if not rows.height:
        return None
    value = float(rows[column].to_numpy().mean())
    worth = _worth(rows, column)
    low, high = wilson(value * worth, worth)
    # Rounding may put the ends of 0 and 1 on their wrong sides.
    return Estimate(value, min(low, value), max(high, value))


def median(rows: pl.DataFrame, column: str) -> Estimate | None:
    """Median of ``column`` where it is known, with the interval of order statistics."""
    known = rows.drop_nulls(column)
    if not known.height:
        return None
    values = known[column].to_numpy()
    middle = float(np.median(values))
    # A median's spread is that of the share of values above it.
    worth = _worth(known.with_columns(above=pl.col(column) > middle), "above")
    return Estimate(middle, *median_interval(values, size=worth))


def _worth(rows: pl.DataFrame, column: str) -> float:
    """How many independent frames the rows of one filter are worth: neighbours are alike."""
    return sum(
        independent_size(run[column].to_numpy(), _block(run["time_s"].to_numpy()))
        for run in rows.partition_by(["experiment", "run"])
    )


def _block(times_s: NDArray[np.float64]) -> int:
    """Frames in ``BLOCK_S``."""
    step_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else BLOCK_S
    return max(1, math.ceil(BLOCK_S / step_s))


def hue_disagreement(frames: pl.DataFrame, by: Sequence[str]) -> Iterator[tuple[Key, Estimate]]:
    """Median angle between the dock's hue and the vehicle's, degrees, for each group."""
    once = frames.unique(FRAME, keep="first", maintain_order=True)
    for key, rows in once.group_by(by, maintain_order=True):
        estimate = median(rows, "hue_disagreement_deg")
        if estimate is not None:
            yield key, estimate


@dataclass(frozen=True)
class PixelRatio:
    """Shares of pixels that a static filter and ternary pass of the same frames, on average.

    ``ratio`` is ``static`` by ``ternary``: infinite where ternary passes nothing at all.
    """

    static: float
    ternary: float
    ratio: Estimate


def pixel_ratio(frames: pl.DataFrame, static: str) -> PixelRatio | None:
    """Compare ``static`` with ternary; None without frames that went through both.

    The interval is that of resampled blocks of ``BLOCK_S`` (Künsch, Ann. Stat. 17:1217, 1989),
    from 0 to infinity where there are fewer than two blocks.
    """
    pairs = (
        frames.filter(pl.col("filter").is_in([static, TERNARY]))
        .pivot("filter", index=[*FRAME, "time_s"], values="passed")
        .drop_nulls()
    )
    if not {static, TERNARY} <= set(pairs.columns) or not pairs.height:
        return None
    above, below = (float(pairs[name].to_numpy().mean()) for name in (static, TERNARY))
    sums = np.concatenate(
        [
            _block_sums(run.select(static, TERNARY).to_numpy(), _block(run["time_s"].to_numpy()))
            for run in pairs.partition_by(["experiment", "run"], maintain_order=True)
        ]
    )
    low, high = _resampled_ends(sums) if len(sums) > 1 else (0.0, math.inf)
    return PixelRatio(above, below, Estimate(_ratio(above, below), low, high))


def _block_sums(values: NDArray[np.float64], block: int) -> NDArray[np.float64]:
    """(blocks, columns) sums of ``block`` neighbouring rows each; the last may have fewer."""
    return np.add.reduceat(values, np.arange(0, len(values), block), axis=0)


def _resampled_ends(sums: NDArray[np.float64]) -> tuple[float, float]:
    """Ends of the middle ``CONFIDENCE`` of the ratios of totals of blocks drawn at random."""
    drawn = np.random.default_rng(0).integers(len(sums), size=(_RESAMPLES, len(sums)))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = np.sort(np.nan_to_num(np.divide(*sums[drawn].sum(axis=1).T), nan=1, posinf=np.inf))
    outside = int(_RESAMPLES * (1 - CONFIDENCE) / 2)
    return float(ratios[outside]), float(ratios[-1 - outside])


def _ratio(above: float, below: float) -> float:
    """1 where both are nothing."""
    if below > 0:
        return above / below
    return math.inf if above > 0 else 1.0
