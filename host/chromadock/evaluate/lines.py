"""Lines of estimates with their intervals, one a filter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import polars as pl
from matplotlib.axes import Axes
from matplotlib.transforms import ScaledTranslation

from chromadock.evaluate.style import LOOKS, Look, filters
from chromadock.evaluate.summary import Estimate, recall

FOUND = "dock found [% of frames]"
"""Label of an axis of recall."""

Measure = Callable[[pl.DataFrame], Estimate | None]
"""What the rows of one filter come to."""

_APART_IN = 0.035
_MARGIN = 0.1
"""Of the axes, on both sides: what stands aside of the first and the last point."""


def recall_lines(axes: Axes, rows: pl.DataFrame, key: str, line: str = "-") -> None:
    """Recall of each filter against the numbers of ``key``."""
    filter_lines(axes, rows, key, recall, 100.0, line)
    axes.set_ylim(-3, 103)
    axes.grid(axis="y")


def filter_lines(
    axes: Axes, rows: pl.DataFrame, key: str, measure: Measure, unit: float, line: str = "-"
) -> None:
    """``measure`` of each filter, times ``unit``, against the numbers of ``key`` in their order."""
    used = filters(rows)
    middle = sum(LOOKS[name].place for name in used) / max(len(used), 1)
    for name in used:
        parts = list(rows.filter(pl.col("filter") == name).group_by(key, maintain_order=True))
        look = replace(LOOKS[name], place=LOOKS[name].place - middle)
        points(axes, [x for (x,), _ in parts], [measure(p) for _, p in parts], look, unit, line)


def points(
    axes: Axes,
    xs: Sequence[float],
    estimates: Sequence[Estimate | None],
    look: Look,
    unit: float,
    line: str = "-",
) -> None:
    """Estimates times ``unit`` in a colour with a mark, a little aside."""
    known = [
        (x, e.value * unit, (e.value - e.low) * unit, (e.high - e.value) * unit)
        for x, e in zip(xs, estimates, strict=True)
        if e is not None
    ]
    if not known:
        return
    x, y, below, above = zip(*known, strict=True)
    drawn = axes.errorbar(
        x,
        y,
        yerr=(below, above),
        color=look.colour,
        marker=look.mark,
        linestyle=line,
        linewidth=1.3,
        elinewidth=1.3,
        # The first in front.
        zorder=3 - look.place / 10,
    )
    axes.margins(x=_MARGIN)
    # Beside each other, that none is hidden; afterwards, for the axes' limits are of the data.
    aside = ScaledTranslation(look.place * _APART_IN, 0, axes.figure.dpi_scale_trans)
    for artist in drawn.get_children():
        artist.set_transform(axes.transData + aside)
