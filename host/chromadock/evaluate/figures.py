"""The figures of an evaluation, for its page and for the documents.

Each function draws one figure from frames with the columns of ``rows.COLUMNS``.  Points
carry 95 % intervals; ``style.svg`` makes the SVG.
"""

from __future__ import annotations

import math
from functools import partial

import matplotlib as mpl
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from chromadock.evaluate.box_plot import passed_box_plot
from chromadock.evaluate.lines import FOUND, filter_lines, recall_lines
from chromadock.evaluate.mapping_plot import mapping_plot
from chromadock.evaluate.style import STYLE, WIDTH_IN, legend, looks
from chromadock.evaluate.summary import median_error
from chromadock.evaluate.sweep_plot import sweep_plot
from chromadock.evaluate.tables import scenarios

__all__ = [
    "errors_by_distance",
    "mapping_plot",
    "passed_box_plot",
    "recall_by_distance",
    "sweep_plot",
]

_ERRORS = (
    ("range_error", "range [% of range]", 100.0),
    ("bearing_error_deg", "bearing [deg]", 1.0),
    ("attitude_error_deg", "attitude [deg]", 1.0),
)
_IN_A_ROW = 3


@mpl.rc_context(STYLE)
def recall_by_distance(frames: pl.DataFrame) -> Figure:
    """Share of frames in which a filter led to the right four markers; Wilson's intervals."""
    parts = list(scenarios(frames))
    lines = math.ceil(len(parts) / _IN_A_ROW)
    figure = Figure(figsize=(WIDTH_IN, 0.6 + 2.9 * lines), layout="constrained")
    columns = min(len(parts), _IN_A_ROW)
    grid = figure.subplots(lines, columns, sharey=True, squeeze=False)
    for axes in grid[:, 0]:
        axes.set_ylabel(FOUND)
    for axes, (title, rows) in zip(grid.flat, parts, strict=False):
        recall_lines(axes, rows, "distance_m")
        axes.set_title(title)
        _distance_axis(axes, rows)
    for axes in grid.flat[len(parts) :]:
        axes.remove()
    legend(figure, looks(frames), lines=True)
    return figure


@mpl.rc_context(STYLE)
def errors_by_distance(frames: pl.DataFrame) -> Figure:
    """Median errors of the pose, with the median's interval, over frames that have one."""
    parts = list(scenarios(frames))
    figure = Figure(figsize=(WIDTH_IN, 0.8 + 2.4 * len(parts)), layout="constrained")
    grid = figure.subplots(len(parts), len(_ERRORS), sharex=True, sharey="col", squeeze=False)
    for row, (scenario, rows) in zip(grid, parts, strict=True):
        for axes, (column, _, unit) in zip(row, _ERRORS, strict=True):
            axes.set_yscale("log")
            axes.yaxis.set_major_locator(LogLocator(subs=(1, 3)))
            axes.yaxis.set_major_formatter("{x:g}")
            axes.yaxis.set_minor_formatter(NullFormatter())
            axes.grid(axis="y")
            filter_lines(axes, rows, "distance_m", partial(median_error, column=column), unit)
        row[0].set_ylabel(scenario)
    for axes, (_, title, _) in zip(grid[0], _ERRORS, strict=True):
        axes.set_title(title)
    for axes in grid[-1]:
        _distance_axis(axes, frames)
    legend(figure, looks(frames), lines=True)
    return figure


def _distance_axis(axes: Axes, rows: pl.DataFrame) -> None:
    distances = rows["distance_m"].unique().sort()
    axes.set_xlabel("distance [m]")
    axes.set_xticks(distances, [f"{distance:g}" for distance in distances])
