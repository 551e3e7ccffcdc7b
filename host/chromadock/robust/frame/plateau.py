"""Two places on one bright thing, which are not two markers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.native import lib, pointer


def on_one_thing(frame_bgr: NDArray[np.uint8], xy: NDArray[np.float64], sense: int = 1) -> bool:
    """Whether it is as bright between a marker and the nearest other one as at both.

    So it is between two corners of a pale box, or two places on a diver's light.  Two lamps have
    something darker between them: even where their light runs into each other and clips, their
    cores are the brightest in the channel that clips last; and before a white bar the lamps are
    brighter than it in their colour.  "Bright" is along the colour by which the markers stand out
    from what is beyond them, or in one of its channels.  ``host/native/plateau.h`` says how much
    darker.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    xy : (n, 2) pixels, two or more.
    sense : 1, or -1 for dark markers, which have something brighter between them.
    """
    frame, places = np.ascontiguousarray(frame_bgr), np.ascontiguousarray(xy, np.float64)
    size = frame.shape[:2]
    return bool(
        lib.plateau_on_one_thing(pointer(frame), *size, len(places), pointer(places), sense)
    )
