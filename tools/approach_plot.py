"""The figure of the approaches: the track's state over time and range."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import polars as pl
from approach_tables import false_frames, runs
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from chromadock.evaluate.style import STYLE, WIDTH_IN

COLOURS = {
    "never_seen": "#DDDDDD",
    "acquiring": "#F0E442",
    "tracking": "#009E73",
    "recently_lost": "#E69F00",
    "lost": "#999999",
}
"""Of Okabe and Ito (2008), which the colour-blind tell apart too."""

FALSE = "#000000"


@mpl.rc_context(STYLE)
def approach_plot(frames: pl.DataFrame) -> Figure:
    """A bar a run, coloured by state; below time, above range; black where the lock was false."""
    scenes = list(frames["scene"].unique(maintain_order=True))
    count = frames["scenario"].n_unique()
    height = 1.2 + len(scenes) * (0.9 + 0.28 * count)
    figure = Figure(figsize=(WIDTH_IN, height), layout="constrained")
    grid = figure.subplots(len(scenes), 1, squeeze=False)[:, 0]
    for axes, scene in zip(grid, scenes, strict=True):
        _bars(axes, frames.filter(pl.col("scene") == scene))
        axes.set_title(scene)
    grid[-1].set_xlabel("time [s]")
    handles = [Patch(color=c, label=state.replace("_", " ")) for state, c in COLOURS.items()]
    handles.append(Patch(color=FALSE, label="false lock"))
    figure.legend(handles=handles, loc="outside upper center", ncols=6)
    return figure


def _bars(axes: Axes, frames: pl.DataFrame) -> None:
    names = []
    for line, ((_, scenario), rows) in enumerate(runs(frames)):
        names.append(scenario)
        times = rows["time_s"].to_numpy()
        step = float(np.diff(times).min())
        for state, colour in COLOURS.items():
            _strip(axes, times[(rows["state"] == state).to_numpy()], step, line, colour, 0.8)
        _strip(axes, false_frames(rows)["time_s"].to_numpy(), step, line, FALSE, 0.3)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.set_xlim(times[0], times[-1] + step)
    _range_axis(axes, rows)


def _strip(
    axes: Axes, times: np.ndarray, step: float, line: int, colour: str, height: float
) -> None:
    """One bar for each unbroken stretch of frames."""
    if not len(times):
        return
    starts = np.flatnonzero(np.diff(times, prepend=-np.inf) > 1.5 * step)
    ends = np.append(starts[1:], len(times)) - 1
    spans = [(times[a], times[b] - times[a] + step) for a, b in zip(starts, ends, strict=True)]
    axes.broken_barh(spans, (line - height / 2, height), color=colour, linewidth=0)


def _range_axis(axes: Axes, rows: pl.DataFrame) -> None:
    """Ranges above, at the times when they are first reached."""
    marks = [m for m in range(1, 20) if rows["range_m"].min() <= m <= rows["range_m"].max()]
    reached = [rows.filter(pl.col("range_m") <= m)["time_s"][0] for m in marks]
    upper = axes.twiny()
    upper.set_xlim(axes.get_xlim())
    upper.set_xticks(reached, [f"{m} m" for m in marks])
    upper.spines["left"].set_visible(False)
    upper.tick_params(axis="x", length=2, labelsize=8)
