"""How alike the colours of a dock's markers are, and what that says.

All markers of a dock shine in one colour, whatever water and camera make of it; clutter has
many.  The colour of a peak is told by its chroma: the two angles, where the frame's noise is
the same in all colours, between the light that it adds and the light that is looked for.  How
far the water turns the markers' colour need not be known: only that it turns all alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

SPREAD = 0.1
"""Standard deviation of the chroma of one dock's markers: LEDs of a reel differ, and so does the
light of the water behind each."""

NOISE = 1.5
"""The same of a marker with a signal to noise of 1: somewhat more than 1, which it would be if
noise fluctuated alike in all colours, as it was measured; glints and struts do not."""

DISTURBED = 0.01
"""How often a marker's colour is not the dock's at all: it stands before something brighter."""

# What is supposed of clutter before any is seen: so many peaks, their chroma so widely spread.
_SUPPOSED, _WIDE = 4.0, 0.7


@dataclass(frozen=True, slots=True)
class Colours:
    """What the chroma of N peaks says of sets of them.

    ``density`` (N, N): of one's (column's) chroma if its colour is the other's; ``near`` (N, N):
    who is in whose neighbourhood; ``everywhere`` and ``nearby`` (N,): sums of the densities over
    all and over those near, ``count`` (N,) of these; ``wide`` (N,): density of one's chroma if
    nothing is known of it.
    """

    density: Real
    near: NDArray[np.bool_]
    everywhere: Real
    nearby: Real
    count: NDArray[np.intp]
    wide: Real

    @classmethod
    def of(cls, chroma: Real, snr: Real, near: NDArray[np.bool_]) -> Colours:
        """From (N, 2) radians, the (N,) signals to noise and ``clutter.Clutter``'s ``near``."""
        x, y = chroma.T
        variance = SPREAD**2 + (NOISE / snr) ** 2
        square = (x[:, None] - x) ** 2 + (y[:, None] - y) ** 2
        density = _student(square, variance[:, None] + variance)
        return cls(
            density,
            near,
            density.sum(axis=0),
            (density * near).sum(axis=0),
            near.sum(axis=0),
            _student(x**2 + y**2, _WIDE**2 + variance),
        )

    def most(self, aside: int) -> Real:
        """(N, N): log likelihood ratio that a peak (column) has another's (row) colour, at most:
        if ``aside`` others of its very colour are no clutter; of itself it says nothing.
        """
        members = (aside + 1) * np.diagonal(self.density)
        everywhere, nearby = self.everywhere - members, self.nearby - members
        clutter = self._clutter(everywhere, aside + 1, nearby, self.count - 1, self.wide)
        ratio = np.log((1 - DISTURBED) * self.density / clutter + DISTURBED)
        np.fill_diagonal(ratio, 0)
        return np.asarray(ratio)

    def log_common(self, members: NDArray[np.intp]) -> Real:
        """(M,) log likelihood ratio that sets (M, n) of peaks have one colour in common.

        The mean of the ratios with each member for the one that has the dock's.
        """
        at = members[:, :, None] * len(self.near) + members[:, None, :]
        pairs, beside = self.density.take(at), self.near.take(at)
        everywhere = self.everywhere[members] - pairs.sum(axis=1)
        nearby = self.nearby[members] - (pairs * beside).sum(axis=1)
        count = self.count[members] - beside.sum(axis=1)
        clutter = self._clutter(everywhere, members.shape[1], nearby, count, self.wide[members])
        ratio = np.log((1 - DISTURBED) * pairs / clutter[:, None] + DISTURBED)
        own = np.arange(members.shape[1])
        ratio[:, own, own] = 0
        return np.asarray(np.logaddexp.reduce(ratio.sum(axis=2), axis=1) - np.log(len(own)))

    def _clutter(
        self, everywhere: Real, aside: int, nearby: Real, count: NDArray[np.intp], wide: Real
    ) -> Real:
        """Density of clutter's chroma, measured on the frame: the mean of the densities about
        peaks nearby (Parzen, Ann. Math. Statist. 33 (1962) 1065), as of rocks or of a wall; as
        far as there are few, about those everywhere, and where these are few, what is supposed.
        """
        total = len(self.wide) - aside
        overall = (np.maximum(everywhere, 0) + _SUPPOSED * wide) / (total + _SUPPOSED)
        return np.asarray((np.maximum(nearby, 0) + _SUPPOSED * overall) / (count + _SUPPOSED))


def _student(square: Real, variance: Real) -> Real:
    """Density of Student's distribution in the plane, with two degrees of freedom: noise's middle
    and glints' tails."""
    return np.asarray(variance / (2 * np.pi * (variance + 0.5 * square) ** 2))
