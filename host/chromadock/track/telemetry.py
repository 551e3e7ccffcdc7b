"""What a stream of attitudes tells of the camera's rate of turn.

Telemetry comes at its own pace, rounded, and often slower than the frames: the same attitude then
comes with several frames.  One that is equal to the last says nothing new, least of all that the
vehicle stood still meanwhile.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from chromadock.track.attitude import Attitude

Floats = NDArray[np.float64]

NOISE_RAD = float(np.radians(0.1))
"""Of a single reading, besides its rounding: a good IMU's attitude over parts of a second."""

RATE_FLOOR = 0.02
"""Error of a turn rate however long it is measured, rad/s: by readings that are a few hundredths of
a second older than the frame, of a vehicle that turns by waves."""

WORTH_RAD_S = 0.1
"""A turn is told once its rate is known so well.  Readings rounded to a degree say nothing within
a frame: there the step of a degree would be a turn by 30 degrees a second."""

LONGEST_S = 0.5
"""A mean rate over a longer time is no rate; and the same attitude for so long is a vehicle at
rest, or a telemetry that has stopped."""

COARSE_RAD = float(np.radians(1.0))
"""Step of readings of which none has differed yet: the coarsest in use."""

FINE_RAD = float(np.radians(0.01))
"""Readings in finer steps never stay the same for LONGEST_S while there is an IMU behind them."""

_SAME_RAD = 1e-6  # the same angle, by another way of arithmetic


@dataclass(frozen=True, eq=False, slots=True)
class Turn:
    """The camera's mean rate of turn (3,), rad/s, own axes, over the ``over_s`` up to now, and the
    variance of each of its numbers."""

    rate: Floats
    variance: float
    over_s: float


@dataclass(frozen=True, eq=False, slots=True)
class Telemetry:
    """The attitudes up to ``time_s``, the last frame's.

    ``news``: the last that differed from the one before, and when it came; ``start``: the one
    from which the next turn is measured; ``changed_rad`` (3,): how roll, pitch and yaw
    moved at the last news.  ``step_rad`` (3,): the step they are rounded to, as far as has shown;
    infinite where there was no change.
    ``every_frame``: whether each frame since ``start`` had one of its own, so that it is
    of the frame's time.  Of this frame: ``fresh``, its attitude if it is news; ``turn``, what it
    tells of the turning.
    """

    time_s: float = -np.inf
    news: tuple[float, Attitude] | None = None
    start: tuple[float, Attitude] | None = None
    changed_rad: tuple[float, ...] = (0.0, 0.0, 0.0)
    step_rad: tuple[float, ...] = (np.inf, np.inf, np.inf)
    every_frame: bool = True
    fresh: Attitude | None = None
    turn: Turn | None = None

    @property
    def error_rad(self) -> float:
        """Standard deviation of a reading: its noise, and half a step of its rounding."""
        steps = [step for step in self.step_rad if np.isfinite(step)]
        return float(np.hypot(NOISE_RAD, max(steps, default=COARSE_RAD) / 2))

    def silent(self, time_s: float) -> bool:
        """Whether nothing is known of the attitude at ``time_s``."""
        return self.news is None or time_s - self.news[0] > LONGEST_S

    def heard(self, time_s: float, attitude: Attitude | None, R_body_camera: Floats) -> Telemetry:
        """After a frame of ``time_s``, later than the last, with or without an attitude."""
        now = replace(self, time_s=time_s, fresh=None, turn=None)
        if attitude is None:
            return replace(now, every_frame=False)
        if self.news is None:
            return now._begun(time_s, attitude)
        since_s, last = self.news
        changes = _changes(last, attitude)
        if max(map(abs, changes)) < _SAME_RAD:
            return now._same(time_s, attitude, since_s)
        now = replace(now, changed_rad=changes, step_rad=self._steps(changes))
        return now._changed(time_s, attitude, R_body_camera, time_s - self.time_s)

    def _steps(self, changes: tuple[float, ...]) -> tuple[float, ...]:
        """The smallest change so far, and change of the change: of rounded readings both are whole
        numbers of steps, of fine ones the second soon is small even while the vehicle turns."""
        found = []
        for step, change, before in zip(self.step_rad, changes, self.changed_rad, strict=True):
            moved = [abs(change), abs(change - before)]
            found.append(min([step, *(m for m in moved if m >= _SAME_RAD)]))
        return tuple(found)

    def _begun(self, time_s: float, attitude: Attitude) -> Telemetry:
        """The first attitude, or the first after a gap."""
        first = (time_s, attitude)
        return replace(self, news=first, start=first, every_frame=True, fresh=attitude)

    def _same(self, time_s: float, attitude: Attitude, since_s: float) -> Telemetry:
        """The last attitude again."""
        held = replace(self, every_frame=False)
        steps = [step for step in self.step_rad if np.isfinite(step)]
        stopped = bool(steps) and max(steps) < FINE_RAD
        if time_s - since_s < LONGEST_S or stopped:
            return held
        rest = Turn(np.zeros(3), RATE_FLOOR**2 + 2 * (self.error_rad / LONGEST_S) ** 2, 0.0)
        return replace(held, start=(time_s, attitude), fresh=attitude, turn=rest)

    def _changed(
        self, time_s: float, attitude: Attitude, R_body_camera: Floats, frame_s: float
    ) -> Telemetry:
        """Another attitude, ``frame_s`` after the frame before."""
        assert self.start is not None
        start_s, start = self.start
        span_s = time_s - start_s
        turned = attitude.turn_since(start, R_body_camera)
        if turned is None or span_s > LONGEST_S:
            return self._begun(time_s, attitude)
        known = 2 * (self.error_rad / span_s) ** 2
        if known > WORTH_RAD_S**2:
            return replace(self, news=(time_s, attitude), fresh=attitude)
        rate = turned / span_s
        # Either reading came with its frame or at any time since the one before.
        late = 0.0 if self.every_frame else float(rate @ rate) * frame_s**2 / (6 * span_s**2)
        turn = Turn(rate, RATE_FLOOR**2 + known + late, span_s)
        return replace(self._begun(time_s, attitude), turn=turn)


UNHEARD = Telemetry()
"""Before the first frame."""


def _changes(before: Attitude, after: Attitude) -> tuple[float, float, float]:
    """How roll, pitch and yaw moved, radians; 0 for a yaw that is not told."""
    yaw = (after.yaw_rad or 0.0) - (before.yaw_rad or 0.0)
    yaw = (yaw + np.pi) % (2 * np.pi) - np.pi
    return after.roll_rad - before.roll_rad, after.pitch_rad - before.pitch_rad, yaw
