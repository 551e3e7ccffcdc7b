"""When the position may jump, and when to tell the crew that the dock is locked or lost."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from chromadock.results.track import Track, TrackedPose
from chromadock.rotation import matrix_from_quaternion
from chromadock.track.motion import turn_between
from chromadock.track.states import KEPT_S

FLIP_RAD = 0.1
"""Least turn between two frames that may be the step to the other planar pose."""

LEAP_M, LEAP_SHARE = 0.25, 0.1
"""The same of the place: metres, and a share of the range.  A dock that is followed moves by less
against its prediction; another dock that has taken the track's place stands elsewhere."""


@dataclass(frozen=True, slots=True)
class Lock:
    """What is remembered from frame to frame.

    ``reset_counter`` 0..255, which an autopilot's filter watches: it takes a jump where the number
    has changed, and throws one out where it has not.  ``last``: the newest track with a pose,
    unless the dock was lost since; ``tracked_s``: its time, even so; ``announced``: whether the
    crew was told that the dock is locked.
    """

    reset_counter: int = 0
    last: Track | None = None
    tracked_s: float = -math.inf
    announced: bool = False

    def after(self, track: Track) -> Lock:
        """With one more frame: counted on by one at each new lock and at each jump."""
        if track.state != "tracking" or track.pose is None:
            kept = track.state == "recently_lost" and not self._older(track)
            return self if kept else replace(self, last=None)
        new = self.last is None or self._older(track) or jumped(self.last, track)
        count = (self.reset_counter + new) % 256
        return replace(self, reset_counter=count, last=track, tracked_s=track.time_s)

    def announcing(self, track: Track) -> tuple[Lock, str | None]:
        """The memory after the crew was told, and what to tell it, or None.

        A dock that is hidden for a moment is no news: it is lost when the track has given it up.
        """
        if not self.announced and track.state == "tracking" and track.pose is not None:
            distance = float(np.linalg.norm(track.pose.t))
            return replace(self, announced=True), f"Chromadock: dock locked, {distance:.1f} m"
        if self.announced and track.time_s - self.tracked_s > KEPT_S:
            return replace(self, announced=False), "Chromadock: dock lost"
        return self, None

    def _older(self, track: Track) -> bool:
        """Whether time has gone back, as when a recording begins again."""
        return self.last is not None and track.time_s < self.last.time_s


def jumped(before: Track, now: Track) -> bool:
    """Whether the track has taken the other planar pose, or another dock, between two frames."""
    if before.pose is None or now.pose is None:
        return False
    turn = _angle(before.pose, now.pose)
    other = before.alternative
    if other is not None and turn > FLIP_RAD and _angle(other, now.pose) < turn:
        return True
    t = np.array(before.pose.t)
    if before.velocity is not None and before.turn_rate is not None:
        # The dock's velocity is that before a camera that does not turn; one that turns sees
        # the dock go the other way.
        speed = np.array(before.velocity) - np.cross(before.turn_rate, t)
        t = t + speed * (now.time_s - before.time_s)
    leap = float(np.linalg.norm(np.array(now.pose.t) - t))
    return leap > LEAP_M + LEAP_SHARE * float(np.linalg.norm(t))


def _angle(a: TrackedPose, b: TrackedPose) -> float:
    """Radians between two attitudes."""
    turn = turn_between(matrix_from_quaternion(a.q_wxyz), matrix_from_quaternion(b.q_wxyz))
    return float(np.linalg.norm(turn))
