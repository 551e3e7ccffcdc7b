"""A replay drawn over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from chromadock.output.base import partial_name
from chromadock.replay.pairs import (
    Pair,
    attitude_difference_deg,
    place_difference_m,
    pose_of,
)
from chromadock.results.detection import Detection

_OLD, _NEW = "#0072B2", "#D55E00"  # of Okabe and Ito, as in the evaluation's figures
_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "axes.spines.top": False,
    "axes.spines.right": False,
}


def write_picture(path: Path, pairs: Sequence[Pair]) -> None:
    """An SVG: range of both runs, and how far they are apart in place and attitude."""
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(9, 7), layout="constrained")
        ranges, places, attitudes = figure.subplots(3, 1, sharex=True)
        times = [pair.time_s for pair in pairs]
        ranges.plot(times, [_range_m(p.old) for p in pairs], ".", color=_OLD, label="recorded")
        ranges.plot(times, [_range_m(p.new) for p in pairs], "x", color=_NEW, label="replayed")
        ranges.set_ylabel("range, m")
        ranges.legend()
        places.plot(times, 1000 * _values(pairs, place_difference_m), ".", color="black")
        places.set_ylabel("difference of place, mm")
        attitudes.plot(times, _values(pairs, attitude_difference_deg), ".", color="black")
        attitudes.set_ylabel("of attitude, degrees")
        attitudes.set_xlabel("time, s")
        partial = partial_name(path)
        figure.savefig(partial, format="svg", metadata={"Date": None})
    partial.replace(path)


def _range_m(detection: Detection | None) -> float:
    pose = pose_of(detection)
    return np.nan if pose is None else float(np.linalg.norm(pose.t))


def _values(
    pairs: Sequence[Pair], difference: Callable[[Pair], float | None]
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.array([difference(pair) for pair in pairs], np.float64)
