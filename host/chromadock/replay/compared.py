"""What a replay remembers of each frame: the numbers that are compared, and no more, so that
hours of them fit into memory and go from one computer to another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from chromadock.replay.pairs import (
    Pair,
    attitude_difference_deg,
    locked,
    place_difference_m,
    pose_of,
)
from chromadock.replay.results import Result
from chromadock.results.detection import Detection


@dataclass(frozen=True, slots=True)
class Seen:
    """Of one result: its ``state``, whether the track had ``locked``, how far away the dock was,
    metres (None without a pose), how long the frame took, and how old its picture was when the
    result was out, milliseconds (None where it is not told)."""

    state: str
    locked: bool
    range_m: float | None
    processing_ms: float | None
    latency_ms: float | None

    @property
    def found(self) -> bool:
        """See ``Detection.found``."""
        return self.state == "found"


@dataclass(frozen=True, slots=True)
class Compared:
    """The frame at ``time_s``, recorded (``old``, None where that is missing) and replayed, and
    how far both poses are apart (None unless there are both)."""

    time_s: float
    old: Seen | None
    new: Seen
    place_m: float | None
    attitude_deg: float | None


def compared(time_s: float, old: Result | None, new: Detection) -> Compared:
    """One frame's numbers.

    The picture of a replay has no age.  Its latency is that of the run with the new time of the
    frame in place of the old one: the same wait before it, and what the frame takes now.
    """
    if old is None:
        return Compared(time_s, None, _seen(new, None), None, None)
    age_ms = None if old.age_s is None else 1000 * old.age_s
    before = _seen(old.detection, age_ms)
    after = _seen(new, None)
    if age_ms is not None and before.processing_ms is not None and after.processing_ms is not None:
        after = _seen(new, max(age_ms - before.processing_ms, 0.0) + after.processing_ms)
    pair = Pair(old.detection, new)
    return Compared(time_s, before, after, place_difference_m(pair), attitude_difference_deg(pair))


def _seen(detection: Detection, latency_ms: float | None) -> Seen:
    pose = pose_of(detection)
    return Seen(
        state=detection.state,
        locked=locked(detection),
        range_m=None if pose is None else float(np.linalg.norm(pose.t)),
        processing_ms=detection.timing_ms.get("total"),
        latency_ms=latency_ms,
    )
