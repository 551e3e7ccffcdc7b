"""The paper's box plot: which share of the pixels each filter passes in each run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib as mpl
import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from chromadock.evaluate.formats import times
from chromadock.evaluate.style import LOOKS, STYLE, WIDTH_IN, filters, legend, looks
from chromadock.evaluate.summary import MISMATCHED, pixel_ratio

WHISKERS = (5, 95)
"""Percentiles."""

_HEADINGS = ("N", "E", "S", "W")
_RATIO_TITLE = "×: static filter tuned to the other water, per pixel of ternary"
_FEW = 6
"""Fewer runs than this have no wider boxes."""
_FLAT = 1.6
"""A box with less between its ends would be covered by a white median."""
_TOP = 6.0
"""Share at the axis' upper end: room above 100 % for the ratios."""


@mpl.rc_context(STYLE)
def passed_box_plot(frames: pl.DataFrame, column: str = "passed") -> Figure:
    """One group of boxes a run, one row of axes an experiment; logarithmic.

    Boxes are quartiles with the median, whiskers the percentiles ``WHISKERS``; ``column`` is
    "passed" or "passed_outside".  With "passed", above a run stands how many times the
    pixels of ternary the static filter tuned to the other water passes.
    """
    experiments = frames.partition_by("experiment", maintain_order=True)
    figure = Figure(figsize=(WIDTH_IN, 0.8 + 3.2 * len(experiments)), layout="constrained")
    all_axes = figure.subplots(len(experiments), 1, squeeze=False)[:, 0]
    positive = frames.filter(pl.col(column) > 0)[column].to_numpy()
    nothing = float(positive.min()) / 3 if positive.size else 1e-6
    for axes, rows in zip(all_axes, experiments, strict=True):
        _share_axis(axes, nothing)
        _groups(axes, rows, column, nothing)
        if column == "passed" and rows["water"][0] in MISMATCHED:
            axes.set_title(_RATIO_TITLE, loc="right", fontsize=9, fontweight="normal")
    legend(figure, looks(frames), lines=False)
    return figure


def _share_axis(axes: Axes, nothing: float) -> None:
    """Percent, with a place at the lower end for no pixel at all."""
    axes.set_ylabel("share of pixels")
    axes.set_yscale("log")
    axes.set_ylim(nothing / 1.6, _TOP)
    decades = [10.0**n for n in range(-6, 1) if 10.0**n > 2 * nothing]
    axes.set_yticks([nothing, *decades], ["none", *(f"{100 * share:g} %" for share in decades)])
    axes.minorticks_off()
    axes.grid(axis="y")


def _groups(axes: Axes, rows: pl.DataFrame, column: str, nothing: float) -> None:
    runs = sorted(rows.partition_by("run", maintain_order=True), key=_place)
    names = filters(rows)
    width = 0.86 / len(names) * min(1.0, len(runs) / _FEW)
    for i, name in enumerate(names):
        boxes = {}
        for place, run in enumerate(runs):
            shares = run.filter(pl.col("filter") == name)[column].to_numpy()
            if shares.size:
                x = place + (i - (len(names) - 1) / 2) * width
                boxes[x] = np.maximum(shares, nothing)
        _boxes(axes, boxes, width, LOOKS[name].colour)
    if column == "passed":
        for place, run in enumerate(runs):
            _tell_ratio(axes, place, run)
    axes.set_xlim(-0.6, len(runs) - 0.4)
    axes.tick_params(axis="x", length=0)
    _name_runs(axes, rows["experiment"][0], runs)


def _name_runs(axes: Axes, experiment: str, runs: Sequence[pl.DataFrame]) -> None:
    """Title, a name below each run, and below those what neighbours have in common."""
    mappings = [str(run["mapping"][0]) for run in runs]
    distances = [f"{run['distance_m'][0]:g} m" for run in runs]
    headings = [run["heading"][0] for run in runs]
    one_mapping = len(set(mappings)) == 1
    axes.set_title(f"{experiment}, {mappings[0]}" if one_mapping else experiment)
    if any(headings):
        axes.set_xticks(range(len(runs)), [heading or "" for heading in headings])
        pairs = zip(mappings, distances, strict=True)
        shared = distances if one_mapping else [", ".join(pair) for pair in pairs]
    else:
        axes.set_xticks(range(len(runs)), distances)
        shared = mappings if not one_mapping else [""] * len(runs)
    _name_neighbours(axes, shared)


def _place(run: pl.DataFrame) -> tuple[bool, float, int]:
    """Ternary before complement, near before far, then around the compass."""
    heading = run["heading"][0]
    turn = _HEADINGS.index(heading) if heading in _HEADINGS else len(_HEADINGS)
    return run["mapping"][0] != "ternary", run["distance_m"][0], turn


def _boxes(
    axes: Axes, shares: Mapping[float, NDArray[np.float64]], width: float, colour: str
) -> None:
    """A box at each x, in one call: matplotlib takes longer to begin one than to draw a box."""
    points = [WHISKERS[0], 25, 50, 75, WHISKERS[1]]
    names = ("whislo", "q1", "med", "q3", "whishi")
    boxes = [dict(zip(names, np.percentile(each, points), strict=True)) for each in shares.values()]
    drawn = axes.bxp(
        boxes,
        positions=list(shares),
        widths=[0.82 * width] * len(boxes),
        showfliers=False,
        showcaps=False,
        patch_artist=True,
        manage_ticks=False,
        boxprops={"facecolor": colour, "edgecolor": colour},
        whiskerprops={"color": colour, "linewidth": 1.2},
        medianprops={"linewidth": 1.4},
    )
    for box, median in zip(boxes, drawn["medians"], strict=True):
        # A box without height shows no more than its median.
        median.set_color("white" if box["q3"] > _FLAT * box["q1"] else colour)


def _tell_ratio(axes: Axes, place: int, run: pl.DataFrame) -> None:
    static = MISMATCHED.get(run["water"][0])
    ratio = None if static is None else pixel_ratio(run, static)
    if ratio is not None:
        axes.annotate(
            times(ratio.ratio.value),
            (place, 1),
            xycoords=("data", "axes fraction"),
            ha="center",
            va="top",
            fontsize=9,
            fontweight="bold",
        )


def _name_neighbours(axes: Axes, names: Sequence[str]) -> None:
    """Write each name once below the neighbours that share it, with a line between."""
    starts = [i for i, name in enumerate(names) if i == 0 or name != names[i - 1]]
    for start, end in zip(starts, [*starts[1:], len(names)], strict=True):
        axes.annotate(
            names[start],
            ((start + end - 1) / 2, 0),
            xycoords=("data", "axes fraction"),
            xytext=(0, -20),
            textcoords="offset points",
            ha="center",
            va="top",
        )
        if start:
            axes.axvline(start - 0.5, color="0.75", linewidth=0.8)
