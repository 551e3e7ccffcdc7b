"""Milliseconds by stage."""

from __future__ import annotations

import time


class Stopwatch:
    """Laps since the one before; those of one name are added up."""

    def __init__(self) -> None:
        self._start = self._last = time.perf_counter()
        self._laps: dict[str, float] = {}

    def lap(self, stage: str) -> None:
        """Book the time since the last lap under ``stage``."""
        now = time.perf_counter()
        self._laps[stage] = self._laps.get(stage, 0.0) + 1000 * (now - self._last)
        self._last = now

    def stop(self) -> dict[str, float]:
        """``total`` and every lap, milliseconds."""
        return {"total": 1000 * (time.perf_counter() - self._start), **self._laps}
