"""No more frames a second than the receiver has use for."""

from __future__ import annotations

from dataclasses import dataclass

_EARLY = 0.1
"""Share of a period that a frame may be early: cameras are not exact."""


@dataclass(slots=True)
class Pace:
    """At most ``rate_hz`` a second in the mean, however the frames fall."""

    rate_hz: float
    _due_s: float | None = None

    def take(self, time_s: float) -> bool:
        """Whether the frame of ``time_s`` (seconds, any origin) is told; it is counted if so."""
        period_s = 1 / self.rate_hz
        due_s = self._due_s
        # The first; or time went back, or stood still for long, which is not made up for.
        if due_s is None or abs(time_s - due_s) > 2 * period_s:
            due_s = time_s
        if time_s < due_s - _EARLY * period_s:
            return False
        self._due_s = due_s + period_s
        return True
