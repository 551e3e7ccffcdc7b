"""The figures with their titles and captions, as the page and the documents show them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import polars as pl

from chromadock import method
from chromadock.evaluate import figures
from chromadock.evaluate.box_plot import WHISKERS
from chromadock.evaluate.frames import Sweep
from chromadock.evaluate.gallery import Exhibit
from chromadock.evaluate.style import LOOKS, svg
from chromadock.evaluate.tables import leading_filter

_PASSED = (
    "logarithmic; fewer is better. Boxes are quartiles with the median, whiskers the "
    f"{WHISKERS[0]}th and {WHISKERS[1]}th percentile."
)
_BARS = "Bars are 95 % intervals, in which frames count for fewer the more alike neighbours are."


@dataclass(frozen=True)
class Drawing:
    """A figure made from ``frames``, either an SVG element or exhibits; ``name`` fits a file."""

    name: str
    title: str
    caption: str
    frames: pl.DataFrame
    svg: str = ""
    exhibits: Sequence[Exhibit] = ()


def passed(still: pl.DataFrame) -> Drawing:
    """The paper's box plot."""
    return Drawing(
        "passed",
        "Pixels passed by each filter, by run",
        f"Share of all pixels that pass, {_PASSED} Above a run: how many times the pixels of the "
        "adaptive ternary filter the static one passes that is tuned to the other water; ∞ where "
        "ternary passes nothing, not even the markers. N, E, S, W: where the vehicle's camera "
        "looks.",
        still,
        svg(figures.passed_box_plot(still), "passed"),
    )


def gallery(still: pl.DataFrame, exhibits: Sequence[Exhibit], svg: str = "") -> Drawing:
    """Samples of its runs, as they are or as one drawing."""
    return Drawing(
        "gallery",
        "Single frames, and what passes",
        "Swatches: the water's colour as vehicle and dock see it, the same hue pure, and the "
        "marker colour that each works out of it alone. Rings are blobs, green where three of "
        "them stand like three of the dock's markers; after the robust method, its markers and the "
        "strongest other peaks.",
        still,
        svg,
        exhibits,
    )


def measured(still: pl.DataFrame) -> Iterator[Drawing]:
    """Recall, errors, and what is passed beside the markers."""
    yield Drawing(
        "recall",
        "Finding the dock, by distance",
        "Share of the frames showing all four markers in which all four were found, each within "
        "three pixels of the truth. Blobs, constellation and pose are the same after every "
        f"filter; the robust method has its own. {_BARS}",
        still,
        svg(figures.recall_by_distance(still), "recall"),
    )
    yield Drawing(
        "errors",
        "Errors of the pose, by distance",
        f"Median absolute errors over the frames in which the dock was found, logarithmic. {_BARS}",
        still,
        svg(figures.errors_by_distance(still), "errors"),
    )
    yield Drawing(
        "outside",
        "Pixels passed outside the markers",
        f"Share of all pixels that pass though no marker is there, {_PASSED} This the paper could "
        "not measure, having no truth.",
        still,
        svg(figures.passed_box_plot(still, "passed_outside"), "outside"),
    )


def swept(sweep: Sweep) -> Drawing:
    """What a varied value does."""
    name = "sweep-" + "-".join(sweep.experiment.split())
    keys = " and ".join(sweep.keys)
    return Drawing(
        name,
        f"Sweep “{sweep.experiment}”: {keys}",
        "Above, the median angle between the hues that dock and vehicle work out; the dashed "
        f"line is the mask's hue window, {method.HUE_WINDOW_DEG:g}°. Below, the share of frames "
        f"in which the dock was found. {_BARS}",
        sweep.frames,
        svg(figures.sweep_plot(sweep), name),
    )


def compared(study: Sweep) -> Drawing:
    """What the mappings do in each setting."""
    name, used = "-".join(study.experiment.split()), leading_filter(study.frames)
    return Drawing(
        name,
        f"{study.experiment[0].upper()}{study.experiment[1:]}",
        f"Share of the frames in which the dock was found, {LOOKS[used].label}, by what dock and "
        f"vehicle take for the marker's colour. {_BARS}",
        study.frames,
        svg(figures.mapping_plot(study), name),
    )
