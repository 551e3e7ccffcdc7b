"""What a user can choose among, and what holds where nothing is chosen.

Apart from the modules that do the work, so that ``--help`` can tell it without loading them.
"""

from __future__ import annotations

from chromadock import method

METHODS = ("robust", "paper")
"""Ways to find the constellation of the markers."""
DEFAULT_METHOD = "robust"

MAPPINGS: tuple[str, ...] = method.MAPPING_NAMES
"""Ways to choose the markers' colour by that of the water."""
DEFAULT_MAPPING = method.DEFAULT_MAPPING_NAME

FALLBACK_HUE_DEG = method.FALLBACK_HUE * 360.0 / method.HUE_RANGE
"""Hue of the markers in grey water and at night."""

HUE_MOST_DEG = round((method.HUE_RANGE - 1) * 360.0 / method.HUE_RANGE, 2)
"""The largest hue that there is, as users are told it."""

LONGEST_DELAY_S = 10.0
"""Of a picture from capture to arrival: one that is older does not help to steer."""

DEFAULT_FPS = 30.0
"""Frames a second of pictures, and of cameras and videos that do not tell."""
