"""The figure of a comparison of mappings: how far the dock is found with each, by water."""

from __future__ import annotations

import math

import matplotlib as mpl
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from chromadock.evaluate.frames import Sweep
from chromadock.evaluate.lines import FOUND, points
from chromadock.evaluate.style import MAPPING_LOOKS, STYLE, WIDTH_IN, legend
from chromadock.evaluate.summary import recall
from chromadock.evaluate.tables import settings_of

_IN_A_ROW = 4


@mpl.rc_context(STYLE)
def mapping_plot(study: Sweep) -> Figure:
    """Recall against distance, a line for each mapping, axes for each setting."""
    parts = list(settings_of(study))
    lines = math.ceil(len(parts) / _IN_A_ROW)
    figure = Figure(figsize=(WIDTH_IN, 0.8 + 2.3 * lines), layout="constrained")
    columns = min(len(parts), _IN_A_ROW)
    grid = figure.subplots(lines, columns, sharey=True, squeeze=False)
    for axes in grid[:, 0]:
        axes.set_ylabel(FOUND)
    for axes, (title, rows) in zip(grid.flat, parts, strict=False):
        _mapping_lines(axes, rows)
        axes.set_title(title, fontsize=10)
        axes.set_xlabel("distance [m]")
    for axes in grid.flat[len(parts) :]:
        axes.remove()
    used = set(study.frames["mapping"].unique())
    legend(figure, [look for name, look in MAPPING_LOOKS.items() if name in used], lines=True)
    return figure


def _mapping_lines(axes: Axes, rows: pl.DataFrame) -> None:
    for name, look in MAPPING_LOOKS.items():
        of_one = rows.filter(pl.col("mapping") == name).group_by("distance_m", maintain_order=True)
        parts = [(distance, recall(part)) for (distance,), part in of_one]
        points(axes, [x for x, _ in parts], [y for _, y in parts], look, 100.0)
    axes.set_ylim(-3, 103)
    axes.grid(axis="y")
    axes.set_xticks(rows["distance_m"].unique().sort())
    axes.set_xticklabels([f"{x:g}" for x in rows["distance_m"].unique().sort()])
