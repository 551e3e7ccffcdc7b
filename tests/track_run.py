"""A tracker that is fed frame by frame, for the tests of several files."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from track_truth import CAMERA, DOCK, NOTHING, approach, found

from chromadock import Attitude, Track, Tracker
from chromadock.look import Found
from chromadock.track.plan import Plan

HZ = 10

Seen = Callable[[float, Plan], Found]


class Run:
    """A tracker fed from ground truth."""

    def __init__(self) -> None:
        self.tracker = Tracker(DOCK)
        self.rng = np.random.default_rng(0)
        self.time_s = 0.0

    def dock(self, time_s: float, plan: Plan) -> Found:
        return found(approach(time_s), self.rng)

    def frame(self, seen: Seen, attitude: Attitude | None = None) -> Track:
        plan = self.tracker.plan(self.time_s)
        what = seen(self.time_s, plan)
        track = self.tracker.update(self.time_s, plan, what, CAMERA, attitude)
        self.time_s = round(self.time_s + 1 / HZ, 6)
        return track

    def frames(self, seconds: float, seen: Seen) -> list[Track]:
        return [self.frame(seen) for _ in range(round(seconds * HZ))]


def nothing(time_s: float, plan: Plan) -> Found:
    return NOTHING
