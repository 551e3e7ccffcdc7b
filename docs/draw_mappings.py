"""Draws docs/images/mappings.svg from their table: `.venv/bin/python docs/draw_mappings.py`.

Above, water of every hue and the marker that each mapping gives it; below, the same as lines.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from chromadock import method
from chromadock.choices import MAPPINGS
from chromadock.colour.background import BackgroundColour
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.colour.marker import marker_hue
from chromadock.evaluate.store import write_whole
from chromadock.evaluate.style import MAPPING_LOOKS, STYLE, WIDTH_IN, svg

OUT = Path(__file__).resolve().parent / "images" / "mappings.svg"

HUES: NDArray[np.int64] = np.arange(method.HUE_RANGE)
DEGREES = 360 / method.HUE_RANGE
NATURAL_DEG = (5.0, 230.0)
"""Hues of the simulated waters that contrast was chosen for."""


def markers(mapping: str) -> NDArray[np.int64]:
    """(1536,) hue of the marker for water of every hue."""
    return np.array([marker_hue(_water(hue), mapping) for hue in HUES.tolist()])


def _water(hue: int) -> BackgroundColour:
    one = {name: 0 for name in BackgroundColour.__dataclass_fields__}
    return BackgroundColour(**{**one, "bin_counts": (0,) * 5, "hue": hue, "meaningful": True})


def draw() -> Figure:
    """The whole picture."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH_IN, 5.2), layout="constrained")
        strips, lines = figure.subplots(
            2, 1, sharex=True, gridspec_kw={"height_ratios": (len(MAPPINGS) + 1, 6)}
        )
        _draw_strips(strips)
        _draw_lines(lines)
    return figure


def _draw_strips(axes: Axes) -> None:
    rows = [HUES, *(markers(mapping) for mapping in MAPPINGS)]
    colours = [[rgb_from_hsv(int(hue), 255, 255) for hue in row[::8]] for row in rows]
    image = np.array(colours, np.uint8)
    image[0] = image[0] // 2 + 40  # water is duller than a lamp
    axes.imshow(image, extent=(0, 360, len(rows), 0), aspect="auto", interpolation="nearest")
    axes.set_yticks(np.arange(len(rows)) + 0.5, ["water", *MAPPINGS])
    axes.set_yticks(np.arange(1, len(rows)), minor=True)
    axes.grid(axis="y", which="minor", color="white", linewidth=3)
    axes.tick_params(length=0, which="both")
    axes.spines[:].set_visible(False)


def _draw_lines(axes: Axes) -> None:
    for mapping, look in MAPPING_LOOKS.items():
        hue = markers(mapping) * DEGREES
        breaks = np.flatnonzero(np.abs(np.diff(hue)) > 180) + 1
        place = np.insert(HUES * DEGREES, breaks, np.nan)
        axes.plot(place, np.insert(hue, breaks, np.nan), color=look.colour, label=look.label)
    axes.axvspan(*NATURAL_DEG, color="0.93", zorder=0)
    axes.text(sum(NATURAL_DEG) / 2, 6, "hues of simulated waters", ha="center", color="0.35")
    axes.set_xlabel("hue of the water [deg]")
    axes.set_ylabel("hue of the marker [deg]")
    axes.set_xlim(0, 360)
    axes.set_ylim(0, 360)
    axes.set_xticks(range(0, 361, 60))
    axes.set_yticks(range(0, 361, 60))
    axes.grid()
    axes.legend(loc="center right", frameon=True)


if __name__ == "__main__":
    write_whole(OUT, svg(draw(), "mappings").encode())
    print(f"wrote {OUT.name}")
