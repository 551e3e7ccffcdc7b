"""From what a picture's pixels are to 8 bits a channel."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.sources.base import OnFault, ignore
from chromadock.sources.mosaic import Samples

_TWELVE_BITS = 1 << 12


class Depth:
    """Makes the pictures of one source 8 bits deep, all of them in the same way.

    Industrial cameras put 12 bits into 16: without a value from 4096 on, 16 bits are taken for
    that, the upper 8 of the 12 are used, and a note says so once.  The first picture with a
    larger value shows that there are 16, and this and all later ones are taken as such.

    Parameters
    ----------
    on_note
        Called with one line where 12 bits are assumed.
    """

    def __init__(self, on_note: OnFault = ignore) -> None:
        self._on_note = on_note
        self._noted = False
        self._sixteen = False

    def bgr(self, samples: Samples, place: str) -> NDArray[np.uint8]:
        """HxWx3 uint8 BGR; ``place`` stands in the note."""
        if samples.dtype == np.uint16:
            samples = np.right_shift(samples, self._shift(samples, place)).astype(np.uint8)
        eight = samples.astype(np.uint8, copy=False)
        if eight.ndim == 2:
            return np.asarray(cv2.cvtColor(eight, cv2.COLOR_GRAY2BGR), np.uint8)
        return np.ascontiguousarray(eight)

    def _shift(self, samples: Samples, place: str) -> int:
        """How many of the lower bits are left out."""
        largest = int(samples.max(initial=0))
        self._sixteen = self._sixteen or largest >= _TWELVE_BITS
        if self._sixteen:
            return 8
        if not self._noted:
            self._noted = True
            self._on_note(
                f"{place}: 16 bits a channel, but none above {largest}: taken for 12 bits in 16, "
                "until a picture has more; if they are 16 after all, save 8 of them"
            )
        return 4
