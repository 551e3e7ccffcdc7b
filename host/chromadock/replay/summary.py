"""Figures of a replay."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from chromadock.replay.pairs import (
    Pair,
    attitude_difference_deg,
    locked,
    place_difference_m,
)
from chromadock.results.detection import Detection


@dataclass(frozen=True)
class Side:
    """One of both runs: ``found`` and ``locked`` frames, when the track locked first, seconds
    (None for never), and how long a frame took, milliseconds (median, and what 99 of 100 stay
    below; None where it is not told)."""

    found: int
    locked: int
    first_locked_s: float | None
    processing_ms: float | None
    processing_99_ms: float | None


@dataclass(frozen=True)
class Spread:
    """Of differences: how many there are, median, and the largest; None without any."""

    frames: int
    median: float | None
    largest: float | None


@dataclass(frozen=True)
class Summary:
    """Both runs, and how far they differ: ``state_differs`` and the two ``only_``: frames that
    have another state, that only one of both has locked."""

    frames: int
    not_recorded: int
    old: Side
    new: Side
    state_differs: int
    only_old_locked: int
    only_new_locked: int
    place_m: Spread
    attitude_deg: Spread

    def to_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        return asdict(self)


def summarised(pairs: Sequence[Pair]) -> Summary:
    """The figures of all frames of a replay."""
    both = [pair for pair in pairs if pair.old is not None]
    return Summary(
        frames=len(pairs),
        not_recorded=len(pairs) - len(both),
        old=_side([(p.time_s, p.old) for p in both if p.old is not None]),
        new=_side([(p.time_s, p.new) for p in pairs]),
        state_differs=sum(p.old is not None and p.old.state != p.new.state for p in both),
        only_old_locked=sum(locked(p.old) and not locked(p.new) for p in both),
        only_new_locked=sum(locked(p.new) and not locked(p.old) for p in both),
        place_m=_spread([place_difference_m(p) for p in both]),
        attitude_deg=_spread([attitude_difference_deg(p) for p in both]),
    )


def _side(results: Sequence[tuple[float, Detection]]) -> Side:
    times_ms = [d.timing_ms["total"] for _, d in results if "total" in d.timing_ms]
    median, most = np.quantile(times_ms, (0.5, 0.99)).tolist() if times_ms else (None, None)
    return Side(
        found=sum(d.found for _, d in results),
        locked=sum(locked(d) for _, d in results),
        first_locked_s=next((time_s for time_s, d in results if locked(d)), None),
        processing_ms=median,
        processing_99_ms=most,
    )


def _spread(differences: Sequence[float | None]) -> Spread:
    there = [difference for difference in differences if difference is not None]
    if not there:
        return Spread(0, None, None)
    return Spread(len(there), float(np.median(there)), max(there))
