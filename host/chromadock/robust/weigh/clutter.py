"""What is supposed of peaks that lie in the water by themselves.

Clutter is modelled as a Poisson process over place and log strength.  Both its local density and
the tail of its strengths are measured on the frame itself, on the peaks that are not in question:
see ``evidence_rarity`` in ``host/native/evidence.c``.
"""

from __future__ import annotations

EXPONENT, SUPPOSED = 2.0, 4.0
"""What is supposed of the tail of strengths before any peak is seen: the number of peaks above a
strength falls as its square, worth as much as so many peaks."""

MOST_FALL = 0.01
"""What outshines all clutter is the rarer the more it does, but never more than so much: there may
always be something bright that is unlike the rest, a diver's lamp or the sun."""

LOOKS_SUPPOSED = 8.0
"""Peaks that the usual looks of clutter are worth beside those of this frame's own: where these are
like lamps, looks say little."""
