"""Tables of what came of drawn scenes: by distance, and by every factor."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

Row = dict[str, Any]

NAMES = (
    "dock", "mapping", "colour", "build", "lamp_profile", "camera", "principal_point", "mounting",
    "backdrop", "daylight", "exposure", "white_balance", "subsampling",
)  # fmt: skip
"""Factors that are choices."""
NUMBERS = (
    "lamp_radius_m", "radiance", "crosstalk", "unlikeness", "width_m", "mean_attenuation",
    "halo_rad", "yaw_deg", "pitch_deg", "roll_deg", "shake_px", "defocus_px", "vignette",
    "shot_noise", "code_noise", "gamma", "jpeg_quality",
)  # fmt: skip
"""Factors that are numbers, by thirds; angles by their size."""
THINGS = ("buoys", "posts", "boxes", "single_lamp", "diver", "own_colour", "other_dock")
COLUMNS = f"{'':38s}frames  recall  limit  wrong"


def by_distance(rows: list[Row]) -> Iterator[str]:
    """One line a distance."""
    yield f"{'distance':>10s}  frames  recall  limit  wrong  evidence of the found  median ms"
    for distance in sorted({r["distance"] for r in rows}, key=float):
        here = [r for r in rows if r["distance"] == distance]
        evidence = [r["evidence"] for r in here if r["found"] and r["evidence"] is not None]
        median = f"{np.median(evidence):21.1f}" if evidence else f"{'-':>21s}"
        total = np.median([r["total_ms"] for r in here])
        yield f"{distance:>8s} m  {_figures(here)}  {median}  {total:9.1f}"
    yield f"{'all':>10s}  {_figures(rows)}"


def by_factors(rows: list[Row]) -> Iterator[str]:
    """A table for each factor that differs."""
    for name in NAMES:
        yield from _table(name, rows, lambda r, n=name: str(r[n]))
    for name in NUMBERS:
        yield from _table(name, rows, _third(name, rows))
    for name in THINGS:
        yield from _table(name, rows, lambda r, n=name: "yes" if n in r["clutter"] else "no")


def _table(name: str, rows: list[Row], group: Callable[[Row], str]) -> Iterator[str]:
    groups: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        groups[group(row)].append(row)
    if len(groups) > 1:
        yield ""
        yield f"{name:38s}" + COLUMNS[38:]
        for value in sorted(groups):
            yield f"  {value:36s}{_figures(groups[value])}"


def _third(name: str, rows: list[Row]) -> Callable[[Row], str]:
    """Names the third of all rows that a number is in."""
    values = np.abs([r[name] for r in rows])
    ends = np.quantile(values, (0, 1 / 3, 2 / 3, 1))

    def third(row: Row) -> str:
        which = int(np.searchsorted(ends[1:3], abs(row[name]), side="right"))
        return f"{which + 1}: {ends[which]:.3g} to {ends[which + 1]:.3g}"

    return third if ends[0] < ends[3] else lambda row: ""


def _figures(rows: list[Row]) -> str:
    def mean(name: str) -> float:
        return float(np.mean([r[name] for r in rows]))

    wrong = sum(bool(r["wrong"]) for r in rows)
    return f"{len(rows):6d}  {mean('recalled'):6.3f}  {mean('standing_out'):5.3f}  {wrong:5d}"
