"""How the figures of an evaluation look, and how they become SVG.

Colours are Okabe and Ito's (2008), which the colour-blind tell apart too; filters differ in
their marks as well.
"""

from __future__ import annotations

import io
from typing import Any

import matplotlib as mpl
import polars as pl
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

COLOURS = {
    "adaptive ternary": "#D55E00",
    "adaptive complement": "#E69F00",
    "static pool": "#0072B2",
    "static lake": "#56B4E9",
    "intensity": "#7F7F7F",
}
MARKS = dict(zip(COLOURS, "osD^v", strict=True))
LABELS = {
    "adaptive ternary": "adaptive, ternary",
    "adaptive complement": "adaptive, complement",
    "static pool": "static, tuned to the pool",
    "static lake": "static, tuned to the lake",
    "intensity": "intensity and LoG",
}
"""Filters by name, in the order in which they are drawn."""

WIDTH_IN = 8.0

STYLE: dict[Any, Any] = {
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "0.88",
    "legend.frameon": False,
    "lines.markersize": 5,
    # Text stays text: small files, which can be searched and read aloud.
    "svg.fonttype": "none",
}
"""To be in force where a figure is made and where it is written."""


def svg(figure: Figure, name: str) -> str:
    """The figure as an SVG element, the same for the same data.

    ``name`` keeps the ids of several figures on one page apart.
    """
    text = io.StringIO()
    nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    with mpl.rc_context({**STYLE, "svg.hashsalt": name}):
        figure.savefig(text, format="svg", metadata=nothing)
    element = text.getvalue()
    return element[element.index("<svg") :]


def filters(frames: pl.DataFrame) -> list[str]:
    """Those of the known filters that were used, in their order."""
    used = set(frames["filter"].unique())
    return [name for name in COLOURS if name in used]


def legend(figure: Figure, frames: pl.DataFrame, *, lines: bool) -> None:
    """Name the filters above the axes, by lines with their marks or by patches."""
    handles = [
        Line2D([], [], color=COLOURS[name], marker=MARKS[name], label=LABELS[name])
        if lines
        else Patch(color=COLOURS[name], label=LABELS[name])
        for name in filters(frames)
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
