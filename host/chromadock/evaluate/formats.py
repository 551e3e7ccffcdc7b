"""Estimates as text, the same on the page and in the documents."""

from __future__ import annotations

import math

from chromadock.evaluate.summary import Estimate

NOTHING = "–"
"""For what could not be measured."""

LEAST = 0.01
"""Ratios below it are told as that: a filter that passes next to nothing is blind."""


def percent(estimate: Estimate | None) -> str:
    """A share: ``0.042 % (0.039–0.045)``."""
    return _with_interval(estimate, 100.0, " %")


def plain_percent(share: float) -> str:
    """A share without interval: ``0.042 %``."""
    return f"{number(100 * share)} %"


def degrees(estimate: Estimate | None) -> str:
    """An angle: ``3.1° (2.8–3.4)``."""
    return _with_interval(estimate, 1.0, "°")


def ratio(estimate: Estimate | None) -> str:
    """A ratio: ``×120 (110–140)``."""
    if estimate is None:
        return NOTHING
    if estimate.value < LEAST:
        return times(estimate.value)
    return f"{times(estimate.value)} ({number(estimate.low)}–{number(estimate.high)})"


def times(value: float) -> str:
    """A ratio without interval: ×0.42, ×3.1, ×120, or ×<0.01."""
    if value < LEAST:
        return f"×<{LEAST:g}"
    return f"×{number(value)}"


def number(value: float) -> str:
    """Two digits, more where they stand before the point: 0.042, 3.0, 16, 1234."""
    if not math.isfinite(value):
        return "∞"
    if value == 0:
        return "0"
    rounded = float(f"{value:.2g}")  # 0.996 is 1.0, not 1.00
    decimals = 1 - math.floor(math.log10(abs(rounded)))
    return f"{value:.{max(0, decimals)}f}"


def _with_interval(estimate: Estimate | None, unit: float, sign: str) -> str:
    if estimate is None:
        return NOTHING
    value, low, high = (unit * x for x in (estimate.value, estimate.low, estimate.high))
    return f"{number(value)}{sign} ({number(low)}–{number(high)})"


FILTERS = {
    "percent": percent,
    "plain_percent": plain_percent,
    "degrees": degrees,
    "ratio": ratio,
    "times": times,
}
"""For templates."""
