"""How the figures of an evaluation look, and how they become SVG.

Colours are Okabe and Ito's (2008), which the colour-blind tell apart too; filters differ in
their marks as well.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import polars as pl
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch


@dataclass(frozen=True, slots=True)
class Look:
    """How one of several things is drawn: ``place`` in order, the first in front."""

    colour: str
    mark: str
    label: str
    place: float


PLAIN = Look("black", "o", "", 0)

LOOKS = {
    "robust": Look("#009E73", "P", "robust method", -3),
    "adaptive ternary": Look("#D55E00", "o", "adaptive, ternary", -2),
    "adaptive complement": Look("#E69F00", "s", "adaptive, complement", -1),
    "static pool": Look("#0072B2", "D", "static, tuned to the pool", 0),
    "static lake": Look("#56B4E9", "^", "static, tuned to the lake", 1),
    "intensity": Look("#7F7F7F", "v", "intensity and LoG", 2),
}
"""Filters by name, in the order in which they are drawn."""

MAPPING_LOOKS = {
    "contrast": Look("#CC79A7", "D", "contrast", -1),
    "ternary": Look("#D55E00", "o", "ternary", 0),
    "complement": Look("#E69F00", "s", "complement", 1),
}
"""Mappings by name, likewise."""

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


def looks(frames: pl.DataFrame) -> list[Look]:
    """Of the filters that were used, in their order."""
    return [LOOKS[name] for name in filters(frames)]


def filters(frames: pl.DataFrame) -> list[str]:
    """Those of the known filters that were used, in their order."""
    used = set(frames["filter"].unique())
    return [name for name in LOOKS if name in used]


def legend(figure: Figure, looks: Iterable[Look], *, lines: bool) -> None:
    """Name what is drawn above the axes, by lines with their marks or by patches."""
    handles = [
        Line2D([], [], color=look.colour, marker=look.mark, label=look.label)
        if lines
        else Patch(color=look.colour, label=look.label)
        for look in looks
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
