"""Constellations among peaks, ranked by the evidence that they are the dock.

The evidence for a set of peaks is the log of its likelihood ratio: the density of such places,
strengths and colours if they are a dock's markers, over that if they are clutter.  Summed over all
sets of peaks of a Poisson clutter, these ratios are expected to come to one (Mecke's formula);
so, by Markov's inequality, a frame without a dock has a set with a ratio of 1/e or more
with a probability of at most e, however many sets there are to choose from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.chroma import Colours
from chromadock.robust.clutter import Clutter
from chromadock.robust.evidence import STRONGEST, log_alike, log_unlike
from chromadock.robust.shape import Complex, Real, ShapeModel, stacked

MAX_SETS = 128
"""Sets that are followed at once: bounds the time; few frames have as many."""

# Chi-square with two degrees of freedom that true markers exceed in 0.3%.
_NEAR = 11.8


@dataclass(frozen=True, slots=True)
class Candidates:
    """``members`` (M, n): a peak for each marker; ``evidence`` (M,), best first.

    ``looks`` (M,): the part of the evidence that has nothing to do with where exactly they are.
    """

    members: NDArray[np.intp]
    evidence: Real
    looks: Real


class Search:
    """Finds one dock in peaks located to ``sigma_px``, in a frame of so many square pixels,
    whose closest markers are ``apart_px`` or more from each other.
    """

    def __init__(
        self, model: ShapeModel, sigma_px: float, frame_area: float, apart_px: float = 0.0
    ) -> None:
        self._model = model
        self._side = model.side.beyond(apart_px)
        self._slack = 2 * sigma_px
        self._area = frame_area
        bounds = np.concatenate([[model.base.shortest], model.edges, [model.base.longest]])
        middles = np.sqrt(bounds[:-1] * bounds[1:])
        # The errors of the base's ends add half of the marker's own.
        noise = 1.5 * (sigma_px / middles) ** 2
        self._steps = [_Step.of(model, k, noise) for k in range(len(model.order) - 2)]
        # The most that strengths, and places given the base, may add: by the base's span.
        self._alike = float(log_alike(np.full((1, len(model.order)), STRONGEST), model.along)[0])
        self._most = self._alike - np.log(frame_area) + sum(s.log_peak for s in self._steps)

    def find(self, z: Complex, snr: Real, chroma: Real, least: float) -> Candidates:
        """Sets of peaks with an evidence of ``least`` or more.

        Parameters
        ----------
        z : (N,) ideal pixels, the strongest first.
        snr : (N,) signal to noise.
        chroma : (N, 2) radians, see ``Response.chroma``.
        """
        model, count = self._model, len(self._model.order)
        apart = z - z[:, None]
        distances = np.abs(apart)
        none = Candidates(np.empty((0, count), np.intp), np.empty(0), np.empty(0))
        first, second = np.nonzero(model.base.holds(apart, distances, self._slack))
        has_base = np.zeros(len(z), np.bool_)
        has_base[first] = True
        # The side is short, so few pairs of peaks can be one.
        sides = self._side.holds(apart, distances, self._slack) & has_base[:, None]
        p, third = np.nonzero(sides)
        if not len(p):
            return none

        # A base with it is worth following if it passes with the best of places, and with others
        # as rare as the rarest of these three (rarer ones would be too unlike) and of the colour
        # nearest to the first's.
        clutter = Clutter.of(distances, snr, self._area)
        colours = Colours.of(chroma, snr, clutter.near)
        same = colours.most(aside=count - 1)
        rarity = clutter.rarity(aside=count - 1)
        size = distances[first, second]
        span = np.searchsorted(model.edges, size)
        place = model.log_base(apart[first, second])
        base = np.full(apart.shape, -np.inf)
        base[first, second] = place + self._most[span] - 2 * (count - 2) * np.log(size)
        base += rarity + same
        nearest = same.max(axis=1, initial=0.0)
        side = rarity[p] + rarity[third] + same[p, third] + (count - 3) * nearest[p]
        side += self._unlike(snr, p, third)
        rarest = np.maximum(np.maximum(rarity[p], rarity[third])[:, None], rarity)
        hope = side[:, None] + base[p] + (count - 3) * rarest
        pair, q = np.nonzero(hope >= least)
        if not len(pair):
            return none

        of_pair = np.zeros(apart.shape, np.intp)
        of_pair[first, second] = np.arange(len(first))
        at = of_pair[p[pair], q]
        sets = _Sets(
            members=np.column_stack([p[pair], q]),
            ends=apart[p[pair], q],
            span=span[at],
            shape=np.empty((len(at), 0), complex),
            place=place[at],
            hope=hope[pair, q],
            supposed=nearest[p[pair]] + rarest[pair, q],
        ).extended(self._steps[0], apart, np.arange(len(pair)), third[pair], 0.0, least)
        for step in self._steps[1:]:
            if not len(sets.members):
                return none
            expected = sets.ends * step.expected(sets.shape, sets.span)
            reach = np.abs(sets.ends) * step.reach[sets.span]
            off = apart[sets.members[:, 0]] - expected[:, None]
            parent, peak = np.nonzero(np.abs(off) < reach[:, None])
            known = rarity[peak] + same[sets.members[parent, 0], peak] - sets.supposed[parent]
            sets = sets.extended(step, apart, parent, peak, known, least)

        alike = log_alike(snr[sets.members], model.along)
        more = alike - self._alike - self._unlike(snr, sets.members[:, 0], sets.members[:, 2])
        kept = np.flatnonzero(sets.hope + more >= least)
        if not len(kept):
            return none
        members = sets.members[kept]
        looks = alike[kept] + clutter.rarity_of(members) + colours.log_common(members)
        evidence = sets.place[kept] - np.log(self._area) + looks
        best = _best(evidence, int((evidence >= least).sum()))
        by_marker = np.argsort(model.order)
        return Candidates(members[best][:, by_marker], evidence[best], looks[best])

    def _unlike(self, snr: Real, p: NDArray[np.intp], third: NDArray[np.intp]) -> Real:
        """What the strengths of (M,) sides take off at least of the most that is hoped for."""
        along = self._model.along
        return log_unlike(snr[p], snr[third], float(along[2] - along[0]))


@dataclass(frozen=True, slots=True)
class _Sets:
    """Peaks taken for the first k markers of the model's order.

    ``members`` (M, k); ``ends`` (M,) and ``span`` (M,): the base and its span of sizes;
    ``shape`` (M, k - 2); ``place`` (M,): log density of the places, the first's left out;
    ``hope`` (M,): the most that the evidence may become; ``supposed`` (M,): what of it each of
    the markers to come is supposed to add by its strength and colour.
    """

    members: NDArray[np.intp]
    ends: Complex
    span: NDArray[np.intp]
    shape: Complex
    place: Real
    hope: Real
    supposed: Real

    def extended(
        self,
        step: _Step,
        apart: Complex,
        parent: NDArray[np.intp],
        peak: NDArray[np.intp],
        known: Real | float,
        least: float,
    ) -> _Sets:
        """Sets ``parent`` (L,) with one more ``peak`` (L,) each, where that may still come to
        ``least``; MAX_SETS.  ``known`` (L,): how much more than supposed each peak adds."""
        b = apart[self.members[parent, 0], peak] / self.ends[parent]
        span = self.span[parent]
        density, near = step.judge(b, self.shape[parent], span)
        hope = self.hope[parent] + density - step.log_peak[span] + known
        near &= (self.members[parent] != peak[:, None]).all(axis=1) & (hope >= least)
        kept = np.flatnonzero(near)
        if len(kept) > MAX_SETS:
            kept = kept[_best(hope[kept], MAX_SETS)]
        parent = parent[kept]
        ends = self.ends[parent]
        return _Sets(
            np.column_stack([self.members[parent], peak[kept]]),
            ends,
            span[kept],
            np.column_stack([self.shape[parent], b[kept]]),
            self.place[parent] + density[kept] - 2 * np.log(np.abs(ends)),
            hope[kept],
            self.supposed[parent],
        )


@dataclass(frozen=True, slots=True)
class _Step:
    """Where one more marker's b is, given those before it, for each span: a normal density.

    ``mean`` (S, 2), ``gain`` (S, 2, 2k) on the deviation of the k before from ``before``
    (S, 2k), ``inverse`` (S, 3): xx, xy, yy of the inverse covariance, ``log_peak`` (S,),
    ``reach`` (S,): the distance that none goes beyond.
    """

    mean: Real
    before: Real
    gain: Real
    inverse: Real
    log_peak: Real
    reach: Real

    @classmethod
    def of(cls, model: ShapeModel, k: int, noise: Real) -> _Step:
        """For marker k + 2 in the model's order, all located with (S,) variance ``noise``."""
        size = 2 * (k + 1)
        covariance = model.covariance[:, :size, :size] + noise[:, None, None] * np.eye(size)
        # Condition by the inverse: its last block is that of the conditional distribution.
        precision = np.linalg.inv(covariance)
        own = precision[:, 2 * k :, 2 * k :]
        gain = -np.linalg.solve(own, precision[:, 2 * k :, : 2 * k])
        return cls(
            mean=np.ascontiguousarray(model.mean[:, 2 * k : size]),
            before=model.mean[:, : 2 * k],
            gain=gain,
            inverse=np.asarray(own[:, [0, 0, 1], [0, 1, 1]], np.float64),
            log_peak=0.5 * np.linalg.slogdet(own)[1] - np.log(2 * np.pi),
            reach=np.sqrt(_NEAR / np.linalg.eigvalsh(own)[:, 0]),
        )

    def expected(self, before: Complex, span: NDArray[np.intp]) -> Complex:
        """(M,) b after (M, k) others."""
        mean = self.mean[span]
        if self.before.shape[1]:
            known = stacked(before) - self.before[span]
            mean = mean + np.einsum("mij,mj->mi", self.gain[span], known)
        return mean.view(np.complex128)[:, 0]

    def judge(
        self, b: Complex, before: Complex, span: NDArray[np.intp]
    ) -> tuple[Real, NDArray[np.bool_]]:
        """Log density of (M,) b after (M, k) others, and whether it is not too far off."""
        off = b - self.expected(before, span)
        x, y = off.real, off.imag
        xx, xy, yy = self.inverse[span].T
        square = xx * x * x + 2 * xy * x * y + yy * y * y
        return self.log_peak[span] - 0.5 * square, square < _NEAR


def _best(score: Real, most: int) -> NDArray[np.intp]:
    """Indices of the highest scores, the best first."""
    return np.argsort(-score, kind="stable")[:most]
