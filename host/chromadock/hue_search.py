"""Which hue to look for, when the dock may not show the one that this camera's water says.

Two cameras with different white balance see different water.  The detector finds markers well
off the hue it looks for; so a few hues about the circle reach every dock.
Each frame is searched for one of them only: the time a frame takes stays the same, and until
the dock is found every second frame is given away.
"""

from __future__ import annotations

import math

from chromadock import method

OFFSET_STEP = method.HUE_RANGE // 6
"""60 degrees: no dock is farther than half of it from a hue that is looked for, and so far off it
is found about as often as at its own (tests/host/robust/test_photographs.py prints it)."""

# Nearest first: small disagreements are the usual ones.
_OTHERS = (1, -1, 2, -2, 3)

GUESS_DECADES = math.log10(1 + len(_OTHERS))
"""Less evidence that a look at a guessed hue counts for: with so many hues to choose from clutter
has as many chances."""

HOLD_LOOKS = 12
"""Looks in a row that find nothing before an offset that found something is left: as long as a
candidate of the track waits for its next frame, at 24 frames a second."""


class HueSearch:
    """Where to look next on the circle of hues, from what the looks before found."""

    def __init__(self) -> None:
        self._home = 0
        self._offset = 0
        self._held = 0
        self._turn = 0

    @property
    def offset(self) -> int:
        """Steps, -768..768, from the expected hue to the one to look for in the next frame."""
        return self._offset

    def looked(self, found: bool, locked: bool) -> None:
        """Take whether the look at ``offset`` found markers, and whether a track is locked."""
        if found or locked:
            self._held = HOLD_LOOKS
        elif self._held:
            self._held -= 1
        if locked:
            self._home = self._offset
        if self._held:
            return
        if self._offset != self._home:
            self._offset = self._home
            return
        others = [o for o in (0, *(OFFSET_STEP * k for k in _OTHERS)) if o != self._home]
        self._offset = others[self._turn % len(others)]
        self._turn += 1
