"""How dense peaks of a given strength lie in the water by themselves.

Clutter is modelled as a Poisson process over place and strength, its density measured on
the frame itself about each peak.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

# The number of peaks above a strength falls as its square: what bright specks, foam and edges
# do roughly.  Noise falls off faster, but what is left of it at a lamp's strength does not count.
_TAIL_EXPONENT = 2.0
# Radius of the neighbourhood in which a peak's clutter is counted, of the frame's mean side:
# large enough for a few peaks, small enough to tell a surface's band from the water below.
_NEIGHBOURHOOD = 0.18


@dataclass(frozen=True, slots=True)
class Clutter:
    """Counts of peaks, the strongest first.

    ``near`` (N, N): who is in whose neighbourhood; ``nearby`` (N,): how many stronger ones.
    """

    frame_area: float
    disc_area: float
    near: NDArray[np.bool_]
    nearby: NDArray[np.intp]

    @classmethod
    def of(cls, distances: NDArray[np.float64], frame_area: float) -> Clutter:
        """From the (N, N) distances of peaks in order of strength, and the frame's area."""
        radius = _NEIGHBOURHOOD * float(np.sqrt(frame_area))
        near = distances < radius
        nearby = np.count_nonzero(near & _stronger(len(near)), axis=1)
        return cls(frame_area, np.pi * radius**2, near, nearby)

    def rarity(self, aside: int) -> NDArray[np.float64]:
        """(N,) rarity of each peak, ``aside`` of the stronger ones not counted as clutter."""
        ranks = np.arange(len(self.nearby))
        return self._rarity(np.maximum(ranks - aside, 0), np.maximum(self.nearby - aside, 0))

    def rarity_of(self, members: NDArray[np.intp]) -> NDArray[np.float64]:
        """(M,) rarity of sets (M, n), whose members are not each other's clutter."""
        stronger = members[:, None, :] < members[:, :, None]
        ranks = members - stronger.sum(axis=2)
        beside = stronger & self.near[members[:, :, None], members[:, None, :]]
        nearby = self.nearby[members] - beside.sum(axis=2)
        return np.asarray(self._rarity(ranks, nearby).sum(axis=1))

    def _rarity(self, stronger: NDArray[np.intp], nearby: NDArray[np.intp]) -> NDArray[np.float64]:
        """Minus log of the peaks a square pixel and unit of log strength.

        The local count, together with one more peak in as much area as holds one stronger peak
        in all the frame: the mean of a gamma distribution of densities after that count.
        """
        expected = (stronger + 1) / self.frame_area
        density = (nearby + 1) / (self.disc_area + 1 / expected)
        return np.asarray(-np.log(_TAIL_EXPONENT * density))


@cache
def _stronger(count: int) -> NDArray[np.bool_]:
    """(count, count): whether the second is stronger than the first."""
    return np.tri(count, k=-1, dtype=np.bool_)
