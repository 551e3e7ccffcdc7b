"""Places in a response that look like lamps: round, alone, adding light and no colour less."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.likeness import LOOKS, network
from chromadock.robust.frame.native import ffi, lib, pointer
from chromadock.robust.frame.response import Response

MIN_SNR: float = lib.FRONT_MIN_SNR
"""At the two finest scales; as much more at a coarser one as its cells are wider."""

MAX_PEAKS: int = lib.FRONT_MAX_PEAKS
"""The strongest of each scale are kept, so that any frame takes bounded time."""

MAX_PROMISING: int = lib.FRONT_MAX_PROMISING
"""Of these so many are searched for markers."""

NEIGHBOURHOOD: float = lib.FRONT_NEIGHBOURHOOD
"""Radius of the neighbourhood in which a peak's clutter is counted, of the frame's mean side."""


@dataclass(frozen=True, slots=True)
class Peaks:
    """Strongest first.

    ``xy`` (N, 2) float64: pixels of the frame.  ``snr`` (N,) float64: signal to noise of the
    brightest 2 x 2 cells about each: wherever in a cell a lamp falls, they catch its light.
    ``noise`` (N,) float64: standard deviation of the filtered light of cells thereabouts.
    ``chroma`` (N, 2) float64: radians, see ``Response.chroma``.  ``likeness`` (N,) float64: see
    ``likeness``.  ``promising``: indices, ascending, of those to be searched for markers: likelier
    lamps than clutter as strong is common.  ``inside`` (N,) float64: share of the neighbourhood of
    each in which clutter is counted that lies inside the frame.  ``looks`` (N, LOOKS) float64: see
    ``likeness``.
    """

    xy: NDArray[np.float64]
    snr: NDArray[np.float64]
    noise: NDArray[np.float64]
    chroma: NDArray[np.float64]
    likeness: NDArray[np.float64]
    promising: NDArray[np.intp]
    inside: NDArray[np.float64]
    looks: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, LOOKS)))


_NOTHING = np.empty(0)
NO_PEAKS = Peaks(
    xy=np.empty((0, 2)),
    snr=_NOTHING,
    noise=_NOTHING,
    chroma=np.empty((0, 2)),
    likeness=_NOTHING,
    promising=np.empty(0, np.intp),
    inside=_NOTHING,
)
"""Of a scale without any: in plain water that is most of them."""


def find_peaks(response: Response) -> dict[int, Peaks]:
    """Local maxima that a lamp may have made, MAX_PEAKS at most of each scale; by its cells."""
    places = MAX_PEAKS * len(response.layout.cells)
    xy, chroma, looks = (np.empty((places, n)) for n in (2, 2, LOOKS))
    snr, noise, likeness, inside = np.empty((4, places))
    promising = np.empty(places, np.uint8)
    arrays = xy, snr, noise, chroma, looks, likeness, inside, promising
    native = ffi.new("front_peaks_t *", ([], *map(pointer, arrays)))
    lib.front_find(response.native, network(), native)
    found = dict.fromkeys(response.layout.cells, NO_PEAKS)
    for scale, cell in enumerate(response.layout.cells):
        if not native.count[scale]:
            continue
        first = MAX_PEAKS * scale
        these = slice(first, first + native.count[scale])
        found[cell] = Peaks(
            xy[these],
            snr[these],
            noise[these],
            chroma[these],
            likeness[these],
            promising[these].nonzero()[0],
            inside[these],
            looks[these],
        )
    return found
