"""The figures of a replay as a table."""

from __future__ import annotations

from rich.table import Table

from chromadock.replay.summary import Spread, Summary


def table(summary: Summary) -> Table:
    """For a terminal."""
    old, new = summary.old, summary.new
    told = Table("", "recorded", "replayed", "difference")
    for column in told.columns[1:]:
        column.justify = "right"
    told.add_row("frames", str(summary.frames - summary.not_recorded), str(summary.frames), "")
    told.add_row("found", str(old.found), str(new.found), f"{new.found - old.found:+d}")
    told.add_row(
        "locked",
        str(old.locked),
        str(new.locked),
        f"-{summary.only_old_locked} +{summary.only_new_locked}",
    )
    told.add_row("first locked, s", _number(old.first_locked_s, 2), _number(new.first_locked_s, 2))
    told.add_row("another state", "", "", str(summary.state_differs))
    told.add_row("time a frame, ms", _number(old.processing_ms, 1), _number(new.processing_ms, 1))
    told.add_row("in 99 of 100", _number(old.processing_99_ms, 1), _number(new.processing_99_ms, 1))
    told.add_row("place, mm: median, most", "", "", _spread(summary.place_m, 1000, 1))
    told.add_row("attitude, deg: median, most", "", "", _spread(summary.attitude_deg, 1, 3))
    return told


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def _spread(spread: Spread, scale: float, digits: int) -> str:
    if spread.median is None or spread.largest is None:
        return "-"
    return f"{spread.median * scale:.{digits}f}, {spread.largest * scale:.{digits}f}"
