"""How dense peaks of a given strength lie in the water by themselves.

Clutter is modelled as a Poisson process over place and strength, its density measured on
the frame itself about each peak.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.peaks import MIN_SNR

# The number of peaks above a strength falls as its square: what bright specks, foam and edges
# do roughly.  Noise falls off faster, but what is left of it at a lamp's strength does not count.
_TAIL_EXPONENT = 2.0
# What is stronger than all clutter is the rarer the more it is, but never more than so much: there
# may always be something bright that is unlike the rest.
_MOST_FALL = 0.1
# Radius of the neighbourhood in which a peak's clutter is counted, of the frame's mean side:
# large enough for a few peaks, small enough to tell a surface's band from the water below.
_NEIGHBOURHOOD = 0.18


@dataclass(frozen=True, slots=True)
class Clutter:
    """Counts of peaks, the strongest first.

    ``near`` (N, N): who is in whose neighbourhood; ``nearby`` (N,): how many stronger ones;
    ``snr`` (N + 1,): signals to noise, the last that from which on peaks count.
    """

    frame_area: float
    disc_area: float
    near: NDArray[np.bool_]
    nearby: NDArray[np.intp]
    snr: NDArray[np.float64]

    @classmethod
    def of(
        cls, distances: NDArray[np.float64], snr: NDArray[np.float64], frame_area: float
    ) -> Clutter:
        """From the (N, N) distances of peaks in order of strength (N,), and the frame's area."""
        radius = _NEIGHBOURHOOD * float(np.sqrt(frame_area))
        near = distances < radius
        nearby = (near & _stronger(len(near))).sum(axis=1)
        return cls(frame_area, np.pi * radius**2, near, nearby, np.concatenate([snr, [MIN_SNR]]))

    def rarity(self, aside: int) -> NDArray[np.float64]:
        """(N,) rarity of each peak, ``aside`` of the stronger ones not counted as clutter."""
        ranks = np.arange(len(self.nearby))
        fall = self._fall(ranks, self.snr[min(aside + 1, len(ranks))])
        stronger, nearby = np.maximum(ranks - aside, 0), np.maximum(self.nearby - aside, 0)
        return self._rarity(stronger, nearby, np.where(ranks <= aside, fall, 1.0))

    def rarity_of(self, members: NDArray[np.intp]) -> NDArray[np.float64]:
        """(M,) rarity of sets (M, n), whose members are not each other's clutter."""
        stronger = members[:, None, :] < members[:, :, None]
        ranks = members - stronger.sum(axis=2)
        pairs = members[:, :, None] * len(self.near) + members[:, None, :]
        beside = stronger & self.near.take(pairs)
        nearby = self.nearby[members] - beside.sum(axis=2)
        # The strongest of the others comes after those that none of them is stronger than.
        first = (ranks == 0).sum(axis=1)
        fall = self._fall(members, self.snr[first][:, None])
        return np.asarray(self._rarity(ranks, nearby, np.where(ranks, 1.0, fall)).sum(axis=1))

    def _fall(
        self, peaks: NDArray[np.intp], strongest: NDArray[np.float64] | float
    ) -> NDArray[np.float64]:
        """How many times rarer than the ``strongest`` of clutter peaks are that are stronger."""
        return np.clip((strongest / self.snr[peaks]) ** _TAIL_EXPONENT, _MOST_FALL, 1.0)

    def _rarity(
        self, stronger: NDArray[np.intp], nearby: NDArray[np.intp], fall: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Minus log of the peaks a square pixel and unit of log strength.

        The local count, together with one more peak in as much area as holds one stronger peak
        in all the frame: the mean of a gamma distribution of densities after that count.
        """
        expected = (stronger + 1) * fall / self.frame_area
        density = (nearby + 1) / (self.disc_area + 1 / expected)
        return np.asarray(-np.log(_TAIL_EXPONENT * density))


@cache
def _stronger(count: int) -> NDArray[np.bool_]:
    """(count, count): whether the second is stronger than the first."""
    return np.tri(count, k=-1, dtype=np.bool_)
