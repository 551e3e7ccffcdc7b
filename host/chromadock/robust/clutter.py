"""How dense peaks of a given strength lie in the water by themselves.

Clutter is modelled as a Poisson process over place and log strength.  Both its local density and
the tail of its strengths are measured on the frame itself, on the peaks that are not in question.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.peaks import MAX_PEAKS, MIN_SNR

Real = NDArray[np.float64]

# What is supposed of the tail of strengths before any peak is seen: the number of peaks above a
# strength falls as its square, worth as much as so many peaks.
_SUPPOSED_EXPONENT, _SUPPOSED_PEAKS = 2.0, 4.0
# What outshines all clutter is the rarer the more it does, but never more than so much: there may
# always be something bright that is unlike the rest, a diver's lamp or the sun.
_MOST_FALL = 0.01
# Radius of the neighbourhood in which a peak's clutter is counted, of the frame's mean side:
# large enough for a few peaks, small enough to tell a surface's band from the water below.
_NEIGHBOURHOOD = 0.18


@dataclass(frozen=True, slots=True)
class Clutter:
    """Peaks of one frame, the strongest first, as far as they are clutter.

    ``near`` (N, N): who is in whose neighbourhood; ``nearby`` (N,): how many stronger ones;
    ``height`` (N,): log of the signal to noise over that from which on peaks are known.
    """

    frame_area: float
    disc_area: float
    near: NDArray[np.bool_]
    nearby: NDArray[np.intp]
    height: Real

    @classmethod
    def of(cls, distances: Real, snr: Real, frame_area: float) -> Clutter:
        """From the (N, N) distances of peaks in order of strength (N,), and the frame's area."""
        radius = _NEIGHBOURHOOD * float(np.sqrt(frame_area))
        near = distances < radius
        nearby = (near & _stronger(len(near))).sum(axis=1)
        # Where there were more peaks than are kept, those from the weakest one on are known.
        least = float(snr[-1]) if len(snr) == MAX_PEAKS else MIN_SNR
        height = np.log(np.maximum(snr / least, 1.0))
        return cls(frame_area, np.pi * radius**2, near, nearby, height)

    def rarity_of(self, members: NDArray[np.intp]) -> Real:
        """(M,) sum of minus log densities of sets (M, n), whose members are no clutter."""
        stronger = members[:, None, :] < members[:, :, None]
        ranks = members - stronger.sum(axis=2)
        pairs = members[:, :, None] * len(self.near) + members[:, None, :]
        beside = stronger & self.near.take(pairs)
        nearby = self.nearby[members] - beside.sum(axis=2)
        count = len(self.near) - members.shape[1]
        total = self.height.sum() - self.height[members].sum(axis=1)[:, None]
        # The strongest of the others comes after those that none of them is stronger than.
        first = (ranks == 0).sum(axis=1)[:, None]
        strongest = np.append(self.height, 0.0)[first]
        rarity = self._rarity(self.height[members], ranks, nearby, count, total, strongest)
        return np.asarray(rarity.sum(axis=1))

    def most(self, aside: int) -> Real:
        """(N,) the rarity of each peak at most: with any ``aside`` others no clutter either."""
        count = len(self.near) - 1 - aside
        ranks = np.arange(len(self.near))
        left = np.maximum(ranks - aside, 0)
        nearby = np.maximum(self.nearby - aside, 0)
        strongest = float(self.height[min(aside + 1, len(ranks) - 1)]) if count > 0 else 0.0
        most = float(self.height.sum())
        totals = (most - self.height, most - float(self.height[: aside + 1].sum()))
        return np.maximum(
            *(
                self._rarity(
                    self.height, left, nearby, count, np.maximum(total, 0.0), np.asarray(strongest)
                )
                for total in totals
            )
        )

    def _rarity(
        self,
        height: Real,
        stronger: NDArray[np.intp],
        nearby: NDArray[np.intp],
        count: int,
        total: Real | float,
        strongest: Real,
    ) -> Real:
        """Minus log of the density of clutter, a square pixel and unit of log strength.

        Heights above the least known strength are taken to be exponential, with an exponent
        whose gamma distribution was updated by ``count`` heights that add up to ``total``: then
        the share beyond a height y is (b / (b + y))^a (Lomax, J. Am. Stat. Assoc. 49 (1954)
        847), and the density of logs there is a / (b + y) times the number beyond it.  That
        number is the local count, together with one more peak in as much area as holds one
        stronger peak in all the frame: the mean of a gamma distribution after that count.
        """
        a = _SUPPOSED_PEAKS + max(count, 0)
        b = _SUPPOSED_PEAKS / _SUPPOSED_EXPONENT + total
        fall = np.clip(((b + strongest) / (b + height)) ** a, _MOST_FALL, 1.0)
        expected = (stronger + 1) * np.where(stronger == 0, fall, 1.0) / self.frame_area
        density = (nearby + 1) / (self.disc_area + 1 / expected)
        return np.asarray(-np.log(a / (b + height) * density))


@cache
def _stronger(count: int) -> NDArray[np.bool_]:
    """(count, count): whether the second is stronger than the first."""
    return np.tri(count, k=-1, dtype=np.bool_)
