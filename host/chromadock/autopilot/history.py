"""The vehicle's attitude and position at a frame's time, from what its autopilot has told."""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from dataclasses import dataclass
from typing import Generic, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.results.track import Vector
from chromadock.stamps import Stamps
from chromadock.track.attitude import Attitude, attitude_of

Floats = NDArray[np.float64]

KEPT = 100
"""Messages: five seconds at 20 Hz, more than a frame takes to be processed."""

GAP_S = 0.6
"""Between two messages more may have happened than a line between them says.  ArduPilot sends an
attitude four times a second where nobody asked for more."""

AHEAD_S = 0.3
"""Beyond the newest message it is run on by its own rates for so long."""


@dataclass(frozen=True, eq=False, slots=True)
class AttitudeSample:
    """An ATTITUDE: ``R`` (3, 3) ned from body, ``rates`` (3,) rad/s about the body's axes."""

    R: Floats
    rates: Floats

    def later(self, elapsed_s: float) -> AttitudeSample:
        """Run on."""
        return AttitudeSample(self.R @ _turn(self.rates * elapsed_s), self.rates)

    def towards(self, other: AttitudeSample, share: float) -> AttitudeSample:
        """So much of the way (0..1) to another one, by the shortest turn."""
        turn = np.asarray(cv2.Rodrigues(self.R.T @ other.R)[0], np.float64).ravel()
        return AttitudeSample(self.R @ _turn(turn * share), self.rates)


@dataclass(frozen=True, eq=False, slots=True)
class PositionSample:
    """A LOCAL_POSITION_NED: ``p`` (3,) metres, ``v`` (3,) m/s, north, east, down."""

    p: Floats
    v: Floats

    def later(self, elapsed_s: float) -> PositionSample:
        """Run on."""
        return PositionSample(self.p + self.v * elapsed_s, self.v)

    def towards(self, other: PositionSample, share: float) -> PositionSample:
        """So much of the way (0..1) to another one."""
        return PositionSample(self.p + share * (other.p - self.p), self.v)


Sample = TypeVar("Sample", AttitudeSample, PositionSample)


class History(Generic[Sample]):
    """The newest samples of one kind, by the stamps of their sender."""

    def __init__(self) -> None:
        self._stamps_s: deque[float] = deque(maxlen=KEPT)
        self._samples: deque[Sample] = deque(maxlen=KEPT)

    def add(self, stamp_s: float, sample: Sample) -> None:
        """One more; what is not newer than the newest came twice or late, and is left out."""
        if not self._stamps_s or stamp_s > self._stamps_s[-1]:
            self._stamps_s.append(stamp_s)
            self._samples.append(sample)

    def clear(self) -> None:
        """Forget all, as when the sender was started anew."""
        self._stamps_s.clear()
        self._samples.clear()

    def at(self, stamp_s: float) -> Sample | None:
        """Between two samples, or a little beyond the newest; None where too far from any."""
        stamps = self._stamps_s
        k = bisect_right(stamps, stamp_s)
        if k == 0:
            return None
        before, elapsed_s = self._samples[k - 1], stamp_s - stamps[k - 1]
        if k == len(stamps):
            return before.later(elapsed_s) if elapsed_s <= AHEAD_S else None
        gap_s = stamps[k] - stamps[k - 1]
        if gap_s > GAP_S:
            return None
        return before.towards(self._samples[k], elapsed_s / gap_s)


class Telemetry:
    """What one vehicle tells of itself, by our own clock.  Not for two threads at a time."""

    def __init__(self) -> None:
        self._clock = Stamps()
        self._attitudes: History[AttitudeSample] = History()
        self._positions: History[PositionSample] = History()

    def heard_attitude(
        self, time_boot_ms: int, arrival_s: float, angles: Attitude, rates: Vector
    ) -> None:
        """Take in an ATTITUDE; ``rates`` rad/s about the body's axes."""
        stamp_s = self._stamped(time_boot_ms, arrival_s)
        self._attitudes.add(stamp_s, AttitudeSample(angles.R_world_body, np.array(rates)))

    def heard_position(
        self, time_boot_ms: int, arrival_s: float, position: Vector, velocity: Vector
    ) -> None:
        """Take in a LOCAL_POSITION_NED, metres and m/s."""
        stamp_s = self._stamped(time_boot_ms, arrival_s)
        self._positions.add(stamp_s, PositionSample(np.array(position), np.array(velocity)))

    def attitude(self, time_s: float) -> Attitude | None:
        """At a time of our clock, with yaw; None where nothing near it was heard."""
        stamp_s = self._clock.theirs(time_s)
        sample = None if stamp_s is None else self._attitudes.at(stamp_s)
        return None if sample is None else attitude_of(sample.R)

    def position(self, time_s: float) -> Vector | None:
        """North, east, down of the vehicle's local origin, metres, at a time of our clock."""
        stamp_s = self._clock.theirs(time_s)
        sample = None if stamp_s is None else self._positions.at(stamp_s)
        if sample is None:
            return None
        x, y, z = sample.p.tolist()
        return x, y, z

    def _stamped(self, time_boot_ms: int, arrival_s: float) -> float:
        before = self._clock.restarts
        self._clock.heard(time_boot_ms / 1000, arrival_s)
        if self._clock.restarts != before:
            self._attitudes.clear()
            self._positions.clear()
        return time_boot_ms / 1000


def _turn(vector: Floats) -> Floats:
    """The rotation (3, 3) of a rotation vector (3,)."""
    return np.asarray(cv2.Rodrigues(vector)[0], np.float64)
