"""What approaches come to: a row a run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import polars as pl
from approach import NEEDED

VISIBLE = 0.1
"""Contrast of markers from which the dock is called visible."""

OFF_SHARE, OFF_M = 0.05, 0.05
"""A track that is measured and farther off than both, of the range and in metres, is falsely
locked: on something else than the dock, or on a wrong pose of it."""


@dataclass(frozen=True)
class Summary:
    """One run.  Times in seconds, ranges in metres; None where it never came to it.

    ``markers``: seen in the middle of its frames, ordered by that number.
    ``locked``: share of the frames that are tracked, of those after the first lock that show three
    markers or more.  ``false``: frames falsely locked, ``false_px`` the worst
    marker's error in them.  ``place``:
    median error, share of the range.  ``within_95``: share of tracked frames with the truth in
    the 95% region of the pose or of its alternative.
    """

    scene: str
    scenario: str
    markers: int
    visible_s: float | None
    visible_m: float | None
    lock_s: float | None
    lock_m: float | None
    locked: float | None
    locked_of_all: float
    false: int
    false_px: float | None
    place: float | None
    attitude_deg: float | None
    within_95: float | None


def summaries(frames: pl.DataFrame) -> list[Summary]:
    """In the order of the runs."""
    return [_summary(rows) for _, rows in runs(frames)]


def runs(frames: pl.DataFrame) -> Iterator[tuple[tuple[str, str], pl.DataFrame]]:
    """((scene, scenario), its frames) of each run."""
    for key, rows in frames.group_by("scene", "scenario", maintain_order=True):
        yield (str(key[0]), str(key[1])), rows


def false_frames(rows: pl.DataFrame) -> pl.DataFrame:
    """Those in which the track was measured and is off."""
    off = pl.max_horizontal(pl.col("range_m") * OFF_SHARE, pl.lit(OFF_M))
    return rows.filter(pl.col("measured") & (pl.col("place_m") > off))


def _summary(rows: pl.DataFrame) -> Summary:
    tracked = rows.filter(pl.col("state") == "tracking")
    visible_s, visible_m = _first(rows.filter(pl.col("contrast") >= VISIBLE))
    lock_s, lock_m = _first(tracked)
    locked = None
    if lock_s is not None:
        after = rows.filter((pl.col("time_s") >= lock_s) & (pl.col("markers_seen") >= NEEDED))
        locked = after.select((pl.col("state") == "tracking").mean()).item()
    return Summary(
        scene=rows["scene"][0],
        scenario=rows["scenario"][0],
        markers=int(rows["markers_seen"].quantile(0.5, "nearest") or 0),
        visible_s=visible_s,
        visible_m=visible_m,
        lock_s=lock_s,
        lock_m=lock_m,
        locked=locked,
        locked_of_all=tracked.height / rows.height,
        false=false_frames(rows).height,
        false_px=false_frames(rows).select(pl.col("marker_px").max()).item(),
        place=tracked.select((pl.col("place_m") / pl.col("range_m")).median()).item(),
        attitude_deg=tracked.select(pl.col("attitude_deg").median()).item(),
        within_95=tracked.select(pl.col("within_95").mean()).item(),
    )


def _first(rows: pl.DataFrame) -> tuple[float | None, float | None]:
    """Time and range of the first row."""
    return (rows["time_s"][0], rows["range_m"][0]) if rows.height else (None, None)
