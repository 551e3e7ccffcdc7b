"""From the water's colour to the markers', and to what a camera sees of them."""

from __future__ import annotations

from collections import deque

import numpy as np

from chromadock import method, method_tables
from chromadock.choices import MAPPINGS
from chromadock.colour.background import BackgroundColour
from chromadock.colour.hsv import hue_cos, hue_of_vector, hue_sin


def marker_hue(
    background: BackgroundColour, mapping: str, fallback_hue: int = method.FALLBACK_HUE
) -> int:
    """Hue 0..1535 of the pure colour that the markers should show.

    What ``mapping`` (one of ``MAPPINGS``) has for the background's hue, linear between
    nodes, or ``fallback_hue`` where the background's hue means nothing.
    """
    if not background.meaningful:
        return fallback_hue
    step = method.MARKER_NODE_STEP
    node, beyond = divmod(background.hue, step)
    first = MAPPINGS.index(mapping) * (method.MARKER_NODES + 1) + node
    here, there = method_tables.MARKER_HUE[first : first + 2].tolist()
    hue: int = (here * (step - beyond) + there * beyond + step // 2) // step
    return hue % method.HUE_RANGE


class RollingHue:
    """Circular mean of the hues decided within the last ``window_ms``."""

    def __init__(self, window_ms: int = method.WINDOW_MS) -> None:
        self._window_ms = window_ms
        self._decisions: deque[tuple[int, int]] = deque(maxlen=method.WINDOW_CAPACITY)

    def add(self, hue: int, now_ms: int) -> int:
        """Take a hue decided at ``now_ms`` (32-bit clock, may wrap); return the mean.

        Decisions in the clock's future (it was set back) are dropped; hues that
        cancel out leave the newest.
        """
        self._decisions.append((now_ms & 0xFFFFFFFF, hue))
        kept = [(t, h) for t, h in self._decisions if (now_ms - t) & 0xFFFFFFFF < self._window_ms]
        self._decisions = deque(kept, maxlen=method.WINDOW_CAPACITY)
        hues = np.array([h for _, h in kept], dtype=np.int32)
        mean = hue_of_vector(int(hue_cos(hues).sum()), int(hue_sin(hues).sum()))
        return hue if mean is None else mean


class SteadyHue:
    """The hue to show or to look for: the rolling mean of decisions of one kind.

    Water has a hue or it has none.  Decisions of the other kind are left out of the mean until
    none of the kind shown has come for ``method.HOLD_MS``; then the window is emptied.
    """

    def __init__(self, window_ms: int = method.WINDOW_MS) -> None:
        self._window_ms = window_ms
        self._rolling = RollingHue(window_ms)
        self._meaningful: bool | None = None
        self._agreed_ms = self._shown = 0

    def add(self, meaningful: bool, hue: int, now_ms: int) -> int:
        """Take a decision at ``now_ms`` (32-bit clock, may wrap); return the hue shown.

        ``meaningful`` is the background's, ``hue`` what ``marker_hue`` has for it.
        """
        if meaningful != self._meaningful:
            held_ms = (now_ms - self._agreed_ms) & 0xFFFFFFFF
            if self._meaningful is not None and held_ms < method.HOLD_MS:
                return self._shown
            self._rolling = RollingHue(self._window_ms)
        self._meaningful, self._agreed_ms = meaningful, now_ms
        self._shown = self._rolling.add(hue, now_ms)
        return self._shown


def observed_colour(
    background: tuple[int, int, int], marker: tuple[int, int, int]
) -> tuple[int, int, int]:
    """RGB that the vehicle's camera is expected to see of a marker, 0..255.

    Half water, half marker, and never darker than the water (Knutson 2024, the
    equation of C_AUVmkr), halves up.
    """
    r, g, b = (max(w, (w + m + 1) // 2) for w, m in zip(background, marker, strict=True))
    return r, g, b
