"""What is supposed of the colours of a dock's markers, and of clutter's.

All markers of a dock shine in one colour, whatever water and camera make of it; clutter has
many.  The colour of a peak is told by its chroma: the two angles, where the frame's noise is
the same in all colours, between the light that it adds and the light that is looked for.  How
far the water turns the markers' colour need not be known: only that it turns all alike.  What a
set's colours say is computed by ``set_colour`` in ``host/native/evidence.c``.
"""

from __future__ import annotations

SPREAD = 0.1
"""Standard deviation of the chroma of one dock's markers: LEDs of a reel differ, and so does the
light of the water behind each."""

NOISE = 1.5
"""The same of a marker with a signal to noise of 1: somewhat more than 1, which it would be if
noise fluctuated alike in all colours, as it was measured; glints and struts do not."""

DISTURBED = 0.01
"""How often a marker's colour is not the dock's at all: it stands before something brighter."""

SUPPOSED, WIDE = 4.0, 0.7
"""What is supposed of clutter before any is seen: so many peaks, their chroma so widely spread."""
