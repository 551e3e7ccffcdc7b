"""When a live picture was taken, on this computer's monotonic clock."""

from __future__ import annotations

from collections import deque

WINDOW_S = 10.0
"""The quickest of so many seconds' arrivals tells how far the clocks are apart: long enough that
one picture came without waiting, short enough that the clocks do not drift by a millisecond."""

LOST_STEP_S = 1.0
"""Stamps that step by so much more or less than the arrivals are of a clock that was set anew."""

SAME_CLOCK_S = 1.0
"""A driver's stamp is no older than this when its picture arrives, and never of the future."""

_NEXT_S = 1e-4
"""Between two pictures at the least: times must grow."""


class CaptureTime:
    """Turns stamps and arrivals into times of capture.

    Parameters
    ----------
    monotonic
        Whether the stamps are of this computer's monotonic clock.
    delay_s
        Seconds >= 0 that a picture takes from capture to arrival at best, as its user has
        measured or read it: no stamp tells what happens before it is put on.
    """

    def __init__(self, monotonic: bool, delay_s: float = 0.0) -> None:
        self._monotonic = monotonic
        self._delay_s = delay_s
        self._recent: deque[tuple[float, float]] = deque()
        self._last_s: float | None = None

    def of(self, stamp_s: float | None, arrival_s: float) -> float:
        """Seconds of this computer's monotonic clock at which a picture was taken.

        A stamp of a foreign clock is moved by the least difference between arrival and stamp
        of the last seconds: what a picture waited longer than the quickest one on its way, it
        is older by.  (The same is done by ArduPilot's JitterCorrection.)  Without a stamp the
        arrival counts.  Times grow from picture to picture.

        Parameters
        ----------
        stamp_s : the picture's own; None where it has none.
        arrival_s : when it came, on the monotonic clock.
        """
        taken_s = self._taken(stamp_s, arrival_s)
        if self._last_s is not None:
            taken_s = max(taken_s, self._last_s + _NEXT_S)
        self._last_s = taken_s
        return taken_s

    def _taken(self, stamp_s: float | None, arrival_s: float) -> float:
        if stamp_s is None:
            return arrival_s - self._delay_s
        if self._monotonic and 0 <= arrival_s - stamp_s <= SAME_CLOCK_S:
            return stamp_s
        late_s = arrival_s - stamp_s
        if self._recent and abs(late_s - self._recent[-1][1]) > LOST_STEP_S:
            self._recent.clear()
        self._recent.append((arrival_s, late_s))
        while self._recent[0][0] < arrival_s - WINDOW_S:
            self._recent.popleft()
        return stamp_s + min(late for _, late in self._recent) - self._delay_s
