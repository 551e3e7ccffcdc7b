"""Tables of drawn approaches: run by run, in sum, and by what differs between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

Row = dict[str, Any]

FACTORS = ("dock", "camera", "build", "mapping", "daylight", "exposure", "clear")
MISSES = ("faint", "unseen", "elsewhere", "unlocked", "lost")
"""What a near frame that is not tracked is for: see ``approaches_runs.run_row``."""

RUN = (
    f"{'run':>8s} att  {'dock':9s} {'camera':10s} {'build':10s} {'mapping':10s} {'light':5s}"
    "   c/m  lock s  lock m  tracked  wrong  worst  covered  found  wrong  not tracked because"
)
SUM = (
    f"{'':22s}runs  locked  lock m  tracked  wrong  worst  covered  found  wrong"
    "  faint  unseen  elsewhere  unlocked  lost"
)


def by_run(rows: list[Row]) -> Iterator[str]:
    """A line a run and way; ``c/m`` is the attenuation for a dock as wide as the original."""
    for r in rows:
        lock_s, lock_m = (_number(r[name], ".1f", 6) for name in ("lock_s", "lock_m"))
        why = " ".join(f"{r[name]} {name}" for name in MISSES if r[name])
        yield (
            f"{r['seed']:>3d}/{r['index']:<4d} {'yes' if r['attitude'] else 'no ':3s}  "
            f"{r['dock']:9s} {r['camera']:10s} {r['build']:10s} {r['mapping']:10s} "
            f"{r['daylight']:5s} {r['relative_attenuation']:5.2f}  {lock_s}  {lock_m}  "
            f"{_figures([r])}  {why}"
        )


def in_sum(rows: list[Row]) -> Iterator[str]:
    """All runs by attitude, and a table for each factor that differs.

    ``lock m`` is the median of the runs in clear water, those that never locked at zero.
    """
    yield SUM
    yield from _groups("attitude", rows, lambda r: "attitude" if r["attitude"] else "no attitude")
    for name in FACTORS:
        values = {str(r[name]) for r in rows}
        if len(values) > 1:
            yield ""
            yield name
            yield from _groups(name, rows, lambda r, n=name: str(r[n]))


def of_no_dock(rows: list[Row]) -> Iterator[str]:
    """How many approaches to no dock locked, and which."""
    locked = [r for r in rows if r["posed"]]
    found = sum(r["found"] for r in rows)
    frames = sum(len(r["frames"]) for r in rows)
    yield (
        f"no dock: {len(locked)} locked in {len(rows)} approaches; "
        f"{found} of {frames} single frames found one, with {_most(rows):.1f} decades at most"
    )
    for r in locked:
        way = "with attitude" if r["attitude"] else "without attitude"
        yield f"  {r['seed']}/{r['index']} {way}: {r['posed']} frames; {r['clutter']}"


def of_photographs(rows: list[Row]) -> Iterator[str]:
    """How many held photographs locked, and which."""
    locked = [r for r in rows if r["locked"]]
    found = sum(bool(r["found"]) for r in rows)
    most = max((r["evidence"] for r in rows), default=0.0)
    yield (
        f"photographs: {len(locked)} locked of {len(rows)} held for 3 s; in {found} a single "
        f"frame found a dock; {most:.1f} decades at most"
    )
    for r in locked:
        yield f"  {r['photograph']} ({r['mapping']}): {r['locked']} frames"


def _groups(name: str, rows: list[Row], group: Callable[[Row], str]) -> Iterator[str]:
    for value in sorted({group(r) for r in rows}):
        here = [r for r in rows if group(r) == value]
        locks = [r["lock_m"] or 0.0 for r in here if r["clear"]]
        locked = sum(r["lock_m"] is not None for r in here)
        misses = [_share(_sum(here, m), _sum(here, "near")) for m in MISSES]
        yield (
            f"  {value:20s}{len(here):4d}  {locked:6d}  "
            f"{_number(np.median(locks) if locks else None, '.1f', 6)}  {_figures(here)}"
            + "".join(f"  {m:>{max(len(n), 5)}s}" for n, m in zip(MISSES, misses, strict=True))
        )


def _figures(rows: list[Row]) -> str:
    tracked = _share(_sum(rows, "near_tracked"), _sum(rows, "near"))
    covered = _share(_sum(rows, "covered"), _sum(rows, "tracked"))
    found = _share(_sum(rows, "near_found"), _sum(rows, "near"))
    worst = f"{max(r['worst'] for r in rows):.2f}"
    return (
        f"{tracked:>7s}  {_sum(rows, 'wrong'):5d}  {worst:>5s}  {covered:>7s}  "
        f"{found:>5s}  {_sum(rows, 'found_wrong'):5d}"
    )


def _sum(rows: list[Row], name: str) -> int:
    return sum(int(r[name]) for r in rows)


def _share(part: int, whole: int) -> str:
    return f"{part / whole:.3f}" if whole else "-"


def _number(value: float | None, form: str, width: int) -> str:
    return f"{'-' if value is None else format(value, form):>{width}s}"


def _most(rows: list[Row]) -> float:
    return max((f["evidence"] or 0.0 for r in rows for f in r["frames"]), default=0.0)
