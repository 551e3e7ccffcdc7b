"""How many results come a second."""

from __future__ import annotations

from collections import deque

_NEWEST = 30
"""The rate is told by so many of the newest results."""


class Rate:
    """Counts results as they come.  Times are seconds of a clock that does not go back.

    Parameters
    ----------
    silence_s : after so long without a result, none are coming.
    """

    def __init__(self, silence_s: float) -> None:
        self._silence_s = silence_s
        self._came_s: deque[float] = deque(maxlen=_NEWEST)

    def came(self, now_s: float) -> None:
        """A result came."""
        self._came_s.append(now_s)

    def hz(self, now_s: float) -> float | None:
        """Results a second, by the newest ones; None with fewer than two, and where none come."""
        times = self._came_s
        if len(times) < 2 or now_s - times[-1] > self._silence_s:
            return None
        return (len(times) - 1) / max(times[-1] - times[0], 1e-9)
