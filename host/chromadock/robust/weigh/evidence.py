"""What the strengths and colours of sets of peaks say: that they are a dock's, or clutter.

All markers shine alike: log strengths scatter little about a common value of which nothing is
known, and about a slope from one end of the dock to the other, since the end that is turned
away is seen through more water.  ``chroma`` says what is supposed of colours, ``clutter`` what
of peaks that are no dock's; ``host/native/evidence.c`` weighs them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock._native import ffi, lib
from chromadock.native import doubles
from chromadock.robust.frame.peaks import MAX_PEAKS, MIN_SNR, NEIGHBOURHOOD, Peaks
from chromadock.robust.weigh import chroma, clutter

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]

SPREAD = 0.25
"""Standard deviation of the log strength of one dock's markers: where in a cell each falls,
a little range and angle."""

SLOPE = 0.3
"""Standard deviation of what the log strength changes from the dock's middle to its end: the
usual yaw puts the end of the paper's dock 0.15 m nearer or farther, in water of 2 m visibility."""

STRONGEST = 400.0
"""Signal to noise of markers in a clear pool at a metre; the common value is even in its
logarithm up to there."""

CONSTANTS = ffi.new(
    "evidence_constants_t *",
    {
        "strength_spread": SPREAD,
        "strength_slope": SLOPE,
        "strength_log_range": float(np.log(STRONGEST / MIN_SNR)),
        "colour_spread": chroma.SPREAD,
        "colour_noise": chroma.NOISE,
        "colour_disturbed": chroma.DISTURBED,
        "colour_supposed": chroma.SUPPOSED,
        "colour_wide": chroma.WIDE,
        "clutter_exponent": clutter.EXPONENT,
        "clutter_supposed": clutter.SUPPOSED,
        "clutter_most_fall": clutter.MOST_FALL,
        "likeness_supposed": clutter.LOOKS_SUPPOSED,
        "clutter_neighbourhood": NEIGHBOURHOOD,
    },
)

_FRAME_SIZE = lib.evidence_frame_size()


class PlacedPeaks:
    """``peaks`` of one scale at ``z`` (N,) x + iy or (N, 2), in a frame of so many square pixels;
    ``native``: what the evidence takes from them, as C has it.

    Raises
    ------
    ValueError
        More peaks than C has room for.
    """

    def __init__(self, z: Complex | Real, peaks: Peaks, area: float) -> None:
        self.peaks = peaks
        count = len(peaks.snr)
        # Where there were more peaks than are kept, those from the weakest one on are known.
        least = float(peaks.snr[-1]) if count == MAX_PEAKS else MIN_SNR
        # C's pointers keep nothing alive.
        arrays = (z, peaks.snr, peaks.chroma, peaks.likeness, peaks.inside)
        kept = [doubles(array) for array in arrays]
        given = ffi.new("evidence_peaks_t *", (count, *kept, least, area))
        self._room = room(_FRAME_SIZE)
        self.native: Any = ffi.cast("evidence_frame_t *", self._room)
        if lib.evidence_prepare(self.native, CONSTANTS, given):
            raise ValueError(f"{count} peaks: too many")


# Zeros would be written for nothing: C fills in all that it reads.
_unset = ffi.new_allocator(should_clear_after_alloc=False)


def room(size: int) -> Any:
    """Memory for so many bytes, aligned as numbers are; it lives as long as what is returned."""
    return _unset("double[]", -(-size // ffi.sizeof("double")))


def evidence_of_sets(placed: PlacedPeaks, members: NDArray[np.intp], along: Real) -> Real:
    """(M,) natural log of the likelihood ratio of (M, k) sets in all but their places.

    Parameters
    ----------
    along : (k,) where the markers at the members are along the dock, -1..1.

    Raises
    ------
    ValueError
        Larger sets than the frame has peaks.
    """
    evidence = np.empty(len(members))
    sets = np.ascontiguousarray(members, np.int32)
    if lib.evidence_of_sets(
        placed.native,
        *sets.shape,
        ffi.from_buffer("int32_t[]", sets),
        doubles(along),
        doubles(evidence),
    ):
        raise ValueError(f"sets of {sets.shape[1]} of {len(placed.peaks.snr)} peaks")
    return evidence


def placed_along(points: Real) -> Real:
    """Where (n, 3) markers are along the dock's longest extent: (n,), its ends at most 1 off."""
    centred = points - points.mean(axis=0)
    along = centred @ np.linalg.svd(centred)[2][0]
    return np.asarray(along / np.abs(along).max())
