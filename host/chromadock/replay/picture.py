"""A replay drawn over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from chromadock.output.base import partial_name
from chromadock.replay.compared import Compared, Seen

_OLD: dict[str, Any] = {"marker": ".", "color": "#0072B2", "label": "recorded", "linestyle": ""}
_NEW: dict[str, Any] = {"marker": "x", "color": "#D55E00", "label": "replayed", "linestyle": ""}
# Colours of Okabe and Ito, as in the evaluation's figures.
_APART: dict[str, Any] = {"marker": ".", "color": "black", "linestyle": ""}
_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "axes.spines.top": False,
    "axes.spines.right": False,
}
_LEVELS = ("not found", "found", "locked")


def write_picture(path: Path, frames: Sequence[Compared]) -> None:
    """An SVG: what both runs saw and how late, and how far they are apart in place and attitude."""
    live = any(frame.old is not None and frame.old.latency_ms is not None for frame in frames)
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(9, 10), layout="constrained")
        ranges, levels, places, attitudes, times = figure.subplots(
            5, 1, sharex=True, height_ratios=(3, 1.2, 2, 2, 2)
        )
        _both(ranges, frames, lambda seen: seen.range_m, "range, m")
        ranges.legend()
        _both(levels, frames, _level, "")
        levels.set_yticks(range(len(_LEVELS)), _LEVELS)
        levels.set_ylim(-0.4, len(_LEVELS) - 0.6)
        seconds = [frame.time_s for frame in frames]
        millimetres = 1000 * np.array([frame.place_m for frame in frames], np.float64)
        places.plot(seconds, millimetres, **_APART)
        places.set_ylabel("difference of place, mm")
        degrees = np.array([frame.attitude_deg for frame in frames], np.float64)
        attitudes.plot(seconds, degrees, **_APART)
        attitudes.set_ylabel("of attitude, degrees")
        if live:
            _both(times, frames, lambda seen: seen.latency_ms, "latency, ms")
        else:
            _both(times, frames, lambda seen: seen.processing_ms, "time a frame, ms")
        times.set_xlabel("time, s")
        partial = partial_name(path)
        figure.savefig(partial, format="svg", metadata={"Date": None})
    partial.replace(path)


def _both(
    axes: Axes, frames: Sequence[Compared], value: Callable[[Seen], float | None], label: str
) -> None:
    """A point of either run a frame, where it has the value."""
    seconds = [frame.time_s for frame in frames]
    old = [None if frame.old is None else value(frame.old) for frame in frames]
    axes.plot(seconds, np.array(old, np.float64), **_OLD)
    axes.plot(seconds, np.array([value(frame.new) for frame in frames], np.float64), **_NEW)
    axes.set_ylabel(label)


def _level(seen: Seen) -> float:
    """Its place among ``_LEVELS``."""
    return 2 if seen.locked else int(seen.found)
