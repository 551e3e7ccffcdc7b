"""The demo on one page: snapshots, colours, hues and ranges over time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from chromadock.demo.record import Record
from chromadock.output.base import partial_name


def write_overview(
    path: Path, records: Sequence[Record], snapshots: Sequence[tuple[float, NDArray[np.uint8]]]
) -> None:
    """Write the page as a PNG.

    ``records`` is one per frame; ``snapshots`` are (time, HxWx3 BGR overlay) pairs.
    """
    figure = Figure(figsize=(12, 8), dpi=110, layout="constrained")
    grid = figure.add_gridspec(4, len(snapshots), height_ratios=(1.55, 0.75, 1.6, 1.6))
    for column, (time_s, picture) in enumerate(snapshots):
        axes = figure.add_subplot(grid[0, column])
        axes.imshow(picture[..., ::-1])
        axes.set_title(f"{time_s:.1f} s", fontsize=10)
        axes.set_axis_off()
    _colours(figure.add_subplot(grid[1, :]), records)
    _hues(figure.add_subplot(grid[2, :]), records)
    _ranges(figure.add_subplot(grid[3, :]), records)
    figure.suptitle("Simulated: dock and vehicle choose the same colour, with no message between")
    partial = partial_name(path)
    figure.savefig(partial)
    partial.replace(path)


def _colours(axes: Axes, records: Sequence[Record]) -> None:
    rows = [
        [r.detection.background.rgb for r in records],
        [r.dock_rgb for r in records],
        [r.detection.marker.rgb for r in records],
    ]
    axes.imshow(np.array(rows, np.uint8), aspect="auto", extent=(0, records[-1].time_s, 3, 0))
    axes.set_yticks([0.5, 1.5, 2.5], ["water", "dock's LEDs", "vehicle expects"])
    axes.set_xticks([])


def _hues(axes: Axes, records: Sequence[Record]) -> None:
    for number, dive in enumerate(_dives(records)):
        times = [r.time_s for r in dive]
        for values, colour, style, label in (
            ([r.detection.background.hue_deg for r in dive], "teal", "-", "water"),
            ([r.dock_hue_deg for r in dive], "crimson", "-", "dock's LEDs"),
            ([r.detection.marker.hue_deg for r in dive], "black", "--", "vehicle expects"),
        ):
            known = [np.nan if hue is None else hue for hue in values]
            axes.plot(times, known, style, color=colour, label=label if number == 0 else None)
    axes.set(ylabel="hue [deg]", xlim=(0, records[-1].time_s))
    axes.legend(loc="center left", fontsize=9)
    axes.grid(alpha=0.3)


def _ranges(axes: Axes, records: Sequence[Record]) -> None:
    for number, dive in enumerate(_dives(records)):
        times = [r.time_s for r in dive]
        label = "truth" if number == 0 else None
        axes.plot(times, [r.true_range_m for r in dive], color="0.6", linewidth=4, label=label)
    found = [(r.time_s, r.range_m) for r in records if r.range_m is not None]
    if found:
        axes.plot(*zip(*found, strict=True), ".", color="green", label="measured")
    axes.set(xlabel="time [s]", ylabel="range [m]", xlim=(0, records[-1].time_s))
    axes.legend(loc="upper right", fontsize=9)
    axes.grid(alpha=0.3)


def _dives(records: Sequence[Record]) -> list[list[Record]]:
    """Nothing is to be joined by a line from one dive to the next."""
    return [list(dive) for _, dive in groupby(records, key=lambda r: r.place)]
