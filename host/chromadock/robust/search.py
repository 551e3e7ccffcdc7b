"""Constellations among peaks, ranked by the evidence that they are the dock.

The evidence for a set of peaks is the log of its likelihood ratio: the density of such places
and strengths if they are a dock's markers, over that if they are clutter.  Summed over all
sets of peaks of a Poisson clutter, these ratios are expected to come to one (Mecke's formula);
so, by Markov's inequality, a frame without a dock has a set with a ratio of 1/e or more
with a probability of at most e, however many sets there are to choose from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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

    ``rarity`` (M,): the part of the evidence that clutter's density has.
    """

    members: NDArray[np.intp]
    evidence: Real
    rarity: Real


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

    def find(self, z: Complex, snr: Real, least: float) -> Candidates:
        """Sets of peaks, given the strongest first, with an evidence of ``least`` or more."""
        model, count = self._model, len(self._model.order)
        apart = z - z[:, None]
        distances = np.abs(apart)
        clutter = Clutter.of(distances, self._area)

        # The side is short, so few pairs of peaks can be one.  A base with it is worth following if
        # it passes with the best of places, and with others as rare as the rarest of these three:
        # rarer ones would be too unlike.
        p, third = np.nonzero(model.side.holds(apart, distances, self._slack))
        rarity = clutter.rarity(aside=count - 1)
        rarest = np.maximum(np.maximum(rarity[p], rarity[third])[:, None], rarity)
        lengths = distances[p]
        hope = self._gain[np.minimum(lengths, len(self._gain) - 1).astype(np.intp)]
        hope += (rarity[p] + rarity[third])[:, None] + rarity + (count - 3) * rarest
        held = (hope >= least) & model.base.holds(apart[p], lengths, self._slack)
        pair, q = np.nonzero(held)
        sets = _Sets.of(np.column_stack([p[pair], q]), apart, model)
        sets = sets.extended(self._steps[0], apart, np.arange(len(pair)), third[pair], rarity)
        for step in self._steps[1:]:
            if not len(sets.members):
                break
            expected = sets.ends * step.expected(sets.shape, sets.span)
            reach = np.abs(sets.ends) * step.reach[sets.span]
            off = apart[sets.members[:, 0]] - expected[:, None]
            parent, peak = np.nonzero(np.abs(off) < reach[:, None])
            sets = sets.extended(step, apart, parent, peak, rarity)
        if not len(sets.members):
            return Candidates(np.empty((0, count), np.intp), np.empty(0), np.empty(0))

        rare = clutter.rarity_of(sets.members)
        evidence = (
            sets.place - np.log(self._area) + log_alike(snr[sets.members], model.along) + rare
        )
        best = _best(evidence, int((evidence >= least).sum()))
        by_marker = np.argsort(model.order)
        return Candidates(sets.members[best][:, by_marker], evidence[best], rare[best])

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
    ``shape`` (M, k - 2); ``place`` (M,): log density of the places, the first's left out.
    """

    members: NDArray[np.intp]
    ends: Complex
    span: NDArray[np.intp]
    shape: Complex
    place: Real

    @classmethod
    def of(cls, bases: NDArray[np.intp], apart: Complex, model: ShapeModel) -> _Sets:
        """Bases (M, 2)."""
        ends = apart[bases[:, 0], bases[:, 1]]
        span = np.searchsorted(model.edges, np.abs(ends))
        return cls(bases, ends, span, np.empty((len(bases), 0), complex), model.log_base(ends))

    def extended(
        self,
        step: _Step,
        apart: Complex,
        parent: NDArray[np.intp],
        peak: NDArray[np.intp],
        rarity: Real,
    ) -> _Sets:
        """Sets ``parent`` (L,) with one more ``peak`` (L,) each, where it fits; MAX_SETS."""
        b = apart[self.members[parent, 0], peak] / self.ends[parent]
        density, near = step.judge(b, self.shape[parent], self.span[parent])
        near &= (self.members[parent] != peak[:, None]).all(axis=1)
        parent, peak, b, density = parent[near], peak[near], b[near], density[near]
        place = self.place[parent] + density - 2 * np.log(np.abs(self.ends[parent]))
        members = np.column_stack([self.members[parent], peak])
        if len(members) > MAX_SETS:
            best = _best(place + rarity[members].sum(axis=1), MAX_SETS)
            parent, members, b, place = parent[best], members[best], b[best], place[best]
        shape = np.column_stack([self.shape[parent], b])
        return _Sets(members, self.ends[parent], self.span[parent], shape, place)


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
