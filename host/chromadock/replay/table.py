"""The figures of replays as tables."""

from __future__ import annotations

from collections.abc import Sequence

from rich.box import SIMPLE_HEAD
from rich.table import Table

from chromadock.replay.summary import Spread, Summary


def table(summary: Summary) -> Table:
    """Of one recording, for a terminal: a figure a row."""
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
    told.add_row("latency, ms", _number(old.latency_ms, 1), _number(new.latency_ms, 1))
    told.add_row("in 99 of 100", _number(old.latency_99_ms, 1), _number(new.latency_99_ms, 1))
    told.add_row("place, mm: median, most", "", "", _spread(summary.place_m, 1000, 1))
    told.add_row("attitude, deg: median, most", "", "", _spread(summary.attitude_deg, 1, 3))
    return told


def table_of_many(rows: Sequence[tuple[str, Summary | None]], total: Summary) -> Table:
    """Of several recordings: one a row by its name, without figures where it could not be
    replayed, and all together.  What a narrow terminal has no room for goes on in the next line."""
    told = Table(
        title="recorded / replayed; differences: median, most; times: median",
        title_justify="left",
        box=SIMPLE_HEAD,
    )
    told.add_column("recording", overflow="fold")
    for name in (
        *("frames", "found", "locked", "place, mm", "attitude, deg"),
        *("time a frame, ms", "latency, ms"),
    ):
        told.add_column(name, justify="right", overflow="fold")
    for name, summary in rows:
        told.add_row(name, *_figures(summary))
    told.add_section()
    told.add_row("all", *_figures(total))
    return told


def _figures(summary: Summary | None) -> list[str]:
    if summary is None:
        return ["none"]
    old, new = summary.old, summary.new
    return [
        str(summary.frames),
        f"{old.found} / {new.found}",
        f"{old.locked} / {new.locked}",
        _spread(summary.place_m, 1000, 1),
        _spread(summary.attitude_deg, 1, 3),
        f"{_number(old.processing_ms, 1)} / {_number(new.processing_ms, 1)}",
        f"{_number(old.latency_ms, 1)} / {_number(new.latency_ms, 1)}",
    ]


def _spread(spread: Spread, scale: float, digits: int) -> str:
    if spread.median is None or spread.largest is None:
        return "-"
    return f"{spread.median * scale:.{digits}f}, {spread.largest * scale:.{digits}f}"


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"
