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
from chromadock.robust.evidence import STRONGEST, log_alike
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
    """Finds one dock in peaks located to ``sigma_px``, in a frame of so many square pixels."""

    def __init__(self, model: ShapeModel, sigma_px: float, frame_area: float) -> None:
        self._model = model
        self._slack = 2 * sigma_px
        self._area = frame_area
        bounds = np.concatenate([[model.base.shortest], model.edges, [model.base.longest]])
        middles = np.sqrt(bounds[:-1] * bounds[1:])
        # The errors of the base's ends add half of the marker's own.
        noise = 1.5 * (sigma_px / middles) ** 2
        self._steps = [_Step.of(model, k, noise) for k in range(len(model.order) - 2)]
        self._gain = self._best_gain()

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
        # The side is short, so few pairs of peaks can be one.
        p, third = np.nonzero(model.side.holds(apart, distances, self._slack))
        if not len(p):
            return none

        # A base with it is worth following if it passes with the best of places, and with others
        # as rare as the rarest of these three (rarer ones would be too unlike) and of the colour
        # nearest to the first's.
        clutter = Clutter.of(distances, snr, self._area)
        colours = Colours.of(chroma, snr, clutter.near)
        same = colours.most(aside=count - 1)
        rarity = clutter.rarity(aside=count - 1)
        rarest = np.maximum(np.maximum(rarity[p], rarity[third])[:, None], rarity)
        lengths = distances[p]
        hope = self._gain[np.minimum(lengths, len(self._gain) - 1).astype(np.intp)]
        hope += (rarity[p] + rarity[third])[:, None] + rarity + (count - 3) * rarest
        nearest = same.max(axis=1, initial=0.0)
        hope += same[p] + (same[p, third] + (count - 3) * nearest[p])[:, None]
        held = (hope >= least) & model.base.holds(apart[p], lengths, self._slack)
        pair, q = np.nonzero(held)
        if not len(pair):
            return none
        sets = _Sets.of(np.column_stack([p[pair], q]), apart, model, hope[pair, q])
        sets = sets.extended(self._steps[0], apart, np.arange(len(pair)), third[pair], least)
        for step in self._steps[1:]:
            if not len(sets.members):
                break
            expected = sets.ends * step.expected(sets.shape, sets.span)
            reach = np.abs(sets.ends) * step.reach[sets.span]
            off = apart[sets.members[:, 0]] - expected[:, None]
            parent, peak = np.nonzero(np.abs(off) < reach[:, None])
            sets = sets.extended(step, apart, parent, peak, least)
        if not len(sets.members):
            return none

        looks = log_alike(snr[sets.members], model.along) + clutter.rarity_of(sets.members)
        looks += colours.log_common(sets.members)
        evidence = sets.place - np.log(self._area) + looks
        best = _best(evidence, int((evidence >= least).sum()))
        by_marker = np.argsort(model.order)
        return Candidates(sets.members[best][:, by_marker], evidence[best], looks[best])

    def _best_gain(self) -> Real:
        """The most that evidence can exceed rarity, by the base's length in whole pixels."""
        lengths = np.arange(1, np.ceil(self._model.base.longest + self._slack) + 2)
        span = np.searchsorted(self._model.edges, lengths)
        straight = self._model.log_base(lengths * self._model.base.direction)
        shape = sum(step.log_peak[span] - 2 * np.log(lengths) for step in self._steps)
        equal = log_alike(np.full((1, len(self._model.order)), STRONGEST), self._model.along)
        return np.asarray(straight + shape + equal - np.log(self._area))


@dataclass(frozen=True, slots=True)
class _Sets:
    """Peaks taken for the first k markers of the model's order.

    ``members`` (M, k); ``ends`` (M,) and ``span`` (M,): the base and its span of sizes;
    ``shape`` (M, k - 2); ``place`` (M,): log density of the places, the first's left out;
    ``hope`` (M,): the most that the evidence may become.
    """

    members: NDArray[np.intp]
    ends: Complex
    span: NDArray[np.intp]
    shape: Complex
    place: Real
    hope: Real

    @classmethod
    def of(cls, bases: NDArray[np.intp], apart: Complex, model: ShapeModel, hope: Real) -> _Sets:
        """Bases (M, 2), and what may be hoped for if they pointed where they mostly do."""
        ends = apart[bases[:, 0], bases[:, 1]]
        size = np.abs(ends)
        place = model.log_base(ends)
        hope = hope + place - model.log_base(size * model.base.direction)
        none = np.empty((len(bases), 0), complex)
        return cls(bases, ends, np.searchsorted(model.edges, size), none, place, hope)

    def extended(
        self,
        step: _Step,
        apart: Complex,
        parent: NDArray[np.intp],
        peak: NDArray[np.intp],
        least: float,
    ) -> _Sets:
        """Sets ``parent`` (L,) with one more ``peak`` (L,) each, where that may still come to
        ``least``; MAX_SETS."""
        b = apart[self.members[parent, 0], peak] / self.ends[parent]
        span = self.span[parent]
        density, near = step.judge(b, self.shape[parent], span)
        hope = self.hope[parent] + density - step.log_peak[span]
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
