"""The figure of a sweep: what a value of the scene does to the colours and to recall."""

from __future__ import annotations

import math
from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from numpy.typing import NDArray

from chromadock import method
from chromadock.evaluate.frames import Sweep
from chromadock.evaluate.lines import FOUND, points, recall_lines
from chromadock.evaluate.style import PLAIN, STYLE, WIDTH_IN, legend, looks
from chromadock.evaluate.summary import hue_disagreement

X = "x"
"""Column of the places along the axis."""

_LOG_FROM = 20
"""Values that grow by more than this factor have a logarithmic axis."""
_LABEL_APART = 2.5
"""Factor between two values that both have their label."""
_COLUMN_IN = 2.6
_HEIGHT_IN = 5.4
_SIDE_BY_SIDE = 5
"""Settings whose names have room beside each other; those of more stand upright."""
_CHARACTER_IN = 0.08
"""Of a name that stands upright: room for its text of 10 points."""


@mpl.rc_context(STYLE)
def sweep_plot(sweep: Sweep) -> Figure:
    """Hue disagreement of dock and vehicle above, recall below, against what was varied.

    Along the axis lies the key with the most numbers; each setting of the others has a
    column.  Where no key has numbers, the settings lie along the axis side by side.
    """
    key = number_key(sweep)
    columns = _columns(sweep, key)
    names, upright = _names(sweep) if key is None else ([], False)
    width = max(WIDTH_IN, _COLUMN_IN * len(columns))
    height = _HEIGHT_IN + (_CHARACTER_IN * max(map(len, names)) if upright else 0)
    figure = Figure(figsize=(width, height), layout="constrained")
    grid = figure.subplots(2, len(columns), sharex="col", sharey="row", squeeze=False)
    line = "none" if key is None else "-"
    highest = 1.0
    for (title, rows), (upper, lower) in zip(columns, grid.T, strict=True):
        hues = list(hue_disagreement(rows, [X]))
        points(upper, [x for (x,), _ in hues], [hue for _, hue in hues], PLAIN, 1.0, line=line)
        highest = max([highest, *(hue.high for _, hue in hues)])
        recall_lines(lower, rows, X, line)
        upper.set_title(title, fontsize=9, fontweight="normal")
        upper.grid(axis="y")
        if key is None:
            lower.set_xticks(range(len(names)), names, rotation=90 if upright else 0)
            lower.set_xlim(-0.6, len(names) - 0.4)
            lower.set_xlabel("\n".join(sweep.keys))
        else:
            _number_axis(lower, rows[X])
            lower.set_xlabel(key)
    grid[0, 0].set_ylabel("hue, dock to vehicle [deg]")
    grid[0, 0].set_ylim(-0.04 * highest, 1.08 * highest)
    for upper in grid[0]:
        # Beyond it no marker of the dock's colour passes; often it lies above the axes.
        upper.axhline(method.HUE_WINDOW_DEG, color="0.5", linestyle="--", linewidth=1)
    grid[1, 0].set_ylabel(FOUND)
    legend(figure, looks(sweep.frames), lines=True)
    return figure


def number_key(sweep: Sweep) -> str | None:
    """The varied key with the most numbers, if any has numbers."""
    numeric = [key for key in sweep.keys if sweep.frames[key].dtype.is_numeric()]
    return max(numeric, key=lambda key: sweep.frames[key].n_unique(), default=None)


def _columns(sweep: Sweep, key: str | None) -> list[tuple[str, pl.DataFrame]]:
    """(title, rows with their places ``X``) for each column of axes."""
    if key is None:
        places = settings(sweep.frames, sweep.keys)
        order = {setting: i for i, setting in enumerate(dict.fromkeys(places))}
        return [("", sweep.frames.with_columns(pl.Series(X, [order[p] for p in places])))]
    rows = sweep.frames.sort(key, maintain_order=True).with_columns(pl.col(key).alias(X))
    others = [other for other in sweep.keys if other != key]
    if not others:
        return [("", rows)]
    parts: dict[tuple[str, ...], list[int]] = {}
    for i, setting in enumerate(settings(rows, others)):
        parts.setdefault(setting, []).append(i)
    return [
        ("\n".join(f"{k}: {v}" for k, v in zip(others, setting, strict=True)), rows[places])
        for setting, places in sorted(parts.items())
    ]


def settings(rows: pl.DataFrame, keys: Sequence[str]) -> list[tuple[str, ...]]:
    """What the keys were set to in each row, as text."""
    return [tuple(str(value) for value in row) for row in rows.select(keys).iter_rows()]


def _names(sweep: Sweep) -> tuple[list[str], bool]:
    """Of all settings, and whether they are so many that their names stand upright."""
    every = list(dict.fromkeys(settings(sweep.frames, sweep.keys)))
    upright = len(every) > _SIDE_BY_SIDE
    return [(", " if upright else "\n").join(setting) for setting in every], upright


def _spaced(numbers: NDArray[np.float64]) -> list[str]:
    """Labels for a logarithmic axis, the largest first; those that would touch one are empty."""
    labels: list[str] = []
    room_up_to = math.inf
    for number in reversed(numbers.tolist()):
        free = number <= room_up_to
        labels.append(f"{number:g}" if free else "")
        room_up_to = number / _LABEL_APART if free else room_up_to
    return labels[::-1]


def _number_axis(axes: Axes, values: pl.Series) -> None:
    """Logarithmic for numbers that grow by much, with a place for zero where it is one."""
    numbers = np.unique(values.to_numpy())
    positive = numbers[numbers > 0]
    if not positive.size or numbers[0] < 0 or numbers[-1] <= _LOG_FROM * positive[0]:
        return
    if numbers[0] == 0:
        axes.set_xscale("symlog", linthresh=positive[0], linscale=0.5)
        axes.set_xlim(-0.3 * positive[0], 2 * numbers[-1])
    else:
        axes.set_xscale("log")
    axes.set_xticks(numbers, _spaced(numbers))
    axes.xaxis.set_minor_locator(NullLocator())
