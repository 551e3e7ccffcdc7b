"""Another clock, a computer's or a camera's, in ours.

As ArduPilot's JitterCorrection does it: a message cannot come before it was made, so the smallest
difference of arrival and stamp is nearest to the difference of the clocks, and too large by the
least time that a message takes.  That constant delay cannot be seen from here.
"""

from __future__ import annotations

from dataclasses import dataclass, field

WINDOW = 50
"""Stamps: the smallest difference of the last 50 to 100 counts, for clocks drift apart."""

BACK_S = 1.0
"""A stamp older than the newest by more is of a sender that was started anew."""


@dataclass(slots=True)
class Stamps:
    """The clock of one sender, learnt from its messages.

    Attributes
    ----------
    restarts
        How often it began anew: what was remembered by its stamps is void then.
    """

    restarts: int = 0
    _newest_s: float | None = None
    _window: list[float] = field(default_factory=list)
    _before_s: float | None = None

    def heard(self, stamp_s: float, arrival_s: float) -> None:
        """Take in a message with ``stamp_s`` on its sender's clock, here at ``arrival_s`` on ours,
        both in seconds."""
        if self._newest_s is not None and stamp_s < self._newest_s - BACK_S:
            self.restarts += 1
            self._window.clear()
            self._newest_s = self._before_s = None
        self._newest_s = stamp_s if self._newest_s is None else max(self._newest_s, stamp_s)
        if len(self._window) == WINDOW:
            self._before_s = min(self._window)
            self._window.clear()
        self._window.append(arrival_s - stamp_s)

    @property
    def offset_s(self) -> float | None:
        """Our time less the sender's, seconds; None before the first message."""
        known = self._window if self._before_s is None else [*self._window, self._before_s]
        return min(known, default=None)

    def ours(self, stamp_s: float) -> float | None:
        """When that was by our clock."""
        offset_s = self.offset_s
        return None if offset_s is None else stamp_s + offset_s

    def theirs(self, time_s: float) -> float | None:
        """When that is by the sender's clock."""
        offset_s = self.offset_s
        return None if offset_s is None else time_s - offset_s
