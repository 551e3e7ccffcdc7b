"""Figures of a replay."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from chromadock.replay.compared import Compared, Seen


@dataclass(frozen=True)
class Side:
    """One of both runs: ``found`` and ``locked`` frames, when the track locked first, seconds
    (None for never), how long a frame took, and how old its picture was when the result was out,
    milliseconds (median, and what 99 of 100 stay below; None where it is not told)."""

    found: int
    locked: int
    first_locked_s: float | None
    processing_ms: float | None
    processing_99_ms: float | None
    latency_ms: float | None
    latency_99_ms: float | None


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


def summarised(frames: Sequence[Compared], one_run: bool = True) -> Summary:
    """The figures of all frames of a replay, or (``one_run`` False) of several ones together,
    which have no first lock."""
    both = [(frame.old, frame.new) for frame in frames if frame.old is not None]
    return Summary(
        frames=len(frames),
        not_recorded=len(frames) - len(both),
        old=_side([(f.time_s, f.old) for f in frames if f.old is not None], one_run),
        new=_side([(f.time_s, f.new) for f in frames], one_run),
        state_differs=sum(old.state != new.state for old, new in both),
        only_old_locked=sum(old.locked and not new.locked for old, new in both),
        only_new_locked=sum(new.locked and not old.locked for old, new in both),
        place_m=_spread([frame.place_m for frame in frames]),
        attitude_deg=_spread([frame.attitude_deg for frame in frames]),
    )


def _side(results: Sequence[tuple[float, Seen]], one_run: bool) -> Side:
    processing_ms, processing_99_ms = _typical([seen.processing_ms for _, seen in results])
    latency_ms, latency_99_ms = _typical([seen.latency_ms for _, seen in results])
    locked_s = [time_s for time_s, seen in results if seen.locked]
    return Side(
        found=sum(seen.found for _, seen in results),
        locked=len(locked_s),
        first_locked_s=locked_s[0] if locked_s and one_run else None,
        processing_ms=processing_ms,
        processing_99_ms=processing_99_ms,
        latency_ms=latency_ms,
        latency_99_ms=latency_99_ms,
    )


def _typical(times_ms: Sequence[float | None]) -> tuple[float | None, float | None]:
    """The median, and what 99 of 100 stay below."""
    told = [time_ms for time_ms in times_ms if time_ms is not None]
    if not told:
        return None, None
    median, most = np.quantile(told, (0.5, 0.99)).tolist()
    return median, most


def _spread(differences: Sequence[float | None]) -> Spread:
    there = [difference for difference in differences if difference is not None]
    if not there:
        return Spread(0, None, None)
    return Spread(len(there), float(np.median(there)), max(there))
