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
from chromadock.robust.peaks import Peaks
from chromadock.robust.shape import FACETS, Complex, Real, ShapeModel

MAX_SETS = 128
"""Sets that are followed at once: bounds the time; few frames have as many."""

# Chi-square with two degrees of freedom that true markers exceed in 0.3%.
_NEAR = 18.0


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
        middles = np.sqrt(bounds[:-1] * bounds[1:]).repeat(FACETS)
        # The errors of the base's ends add half of the marker's own.
        noise = 1.5 * (sigma_px / middles) ** 2
        self._steps = [_Step.of(model, k, noise) for k in range(len(model.order) - 2)]
        count = len(model.order)
        self._by_marker = np.argsort(model.order)
        self._none = Candidates(np.empty((0, count), np.intp), np.empty(0), np.empty(0))
        # The most that strengths, and places given the base, may add: by the base's span.
        alike = log_alike(np.full((1, count), STRONGEST), model.along)
        self._most = alike - np.log(frame_area) + sum(s.log_peak for s in self._steps)
        self._most = self._most + model.log_share

    def find(self, z: Complex, peaks: Peaks, least: float) -> Candidates:
        """Sets of peaks with an evidence of ``least`` or more.

        Parameters
        ----------
        z : (N,) ideal pixels of the peaks.
        peaks : of which the markers are looked for among the ``promising``; all are clutter.
        """
        promising = peaks.promising
        if len(promising) < len(self._model.order):
            return self._none
        apart = z[promising] - z[:, None]
        triples = self._triples(apart[promising], promising, peaks.snr)
        if not len(triples.hope):
            return self._none
        looks = _Looks.of(
            self._model, peaks, Clutter.of(np.abs(z - z[:, None]), peaks.snr, self._area)
        )
        sets = triples.hopeful(looks, least)
        for step in self._steps[1:]:
            if not len(sets.hope):
                break
            b = step.expected(sets.shape, sets.span)
            reach = np.abs(sets.ends) * step.reach[sets.span]
            off = apart[sets.members[0]] - (sets.ends * b)[:, None]
            parent, peak = np.nonzero(np.abs(off) < reach[:, None])
            sets = sets.extended(step, b, z, parent, promising[peak]).hopeful(looks, least)
        return self._weighed(sets, looks, least)

    def _triples(self, apart: Complex, promising: NDArray[np.intp], snr: Real) -> _Sets:
        """Peaks that may be p, q and the third by where they are, ``apart`` (P, P)."""
        model, step = self._model, self._steps[0]
        distances = np.abs(apart)
        first, second = np.nonzero(
            model.base.holds(apart, distances, self._slack) & (distances > 0)
        )
        p, third = np.nonzero(self._side.holds(apart, distances, self._slack))
        base, side = _sharing(first, p)
        ends, size = apart[first, second], distances[first, second]
        # Each is looked at as a view from each side.
        span = np.searchsorted(model.edges, size)[base] * FACETS
        span = (span + np.arange(FACETS)[:, None]).ravel()
        base, side = np.tile(base, FACETS), np.tile(side, FACETS)
        b = apart[p, third][side] / ends[base]
        below, near = step.judge(b - step.mean[span], span)
        kept = np.flatnonzero(near & (second[base] != third[side]))
        base, side, below, span = base[kept], side[kept], below[kept], span[kept]
        log_size = np.log(size[base])
        place = model.log_base(ends[base]) + model.log_share[span] - below
        members = promising[[first[base], second[base], third[side]]]
        along = float(model.along[2] - model.along[0])
        unlike = log_unlike(snr[members[0]], snr[members[2]], along)
        return _Sets(
            members=members,
            ends=ends[base],
            span=span,
            shape=b[None, kept],
            place=place + step.log_peak[span] - 2 * log_size,
            hope=place
            - model.log_share[span]
            + unlike
            + self._most[span]
            - 2 * len(self._steps) * log_size,
        )

    def _weighed(self, sets: _Sets, looks: _Looks, least: float) -> Candidates:
        """Sets of all markers whose evidence is ``least`` or more."""
        if not len(sets.hope):
            return self._none
        likely = looks.exactly(sets.members)
        kept = np.flatnonzero(sets.hope + likely >= least)
        if not len(kept):
            return self._none
        members = sets.members[:, kept]
        said = likely[kept] + looks.alike(members)
        evidence = sets.place[kept] - np.log(self._area) + said
        best = _best(evidence, int((evidence >= least).sum()))
        # The same peaks may be a view from more than one side.
        best = best[np.sort(np.unique(members[:, best], axis=1, return_index=True)[1])]
        return Candidates(members[self._by_marker][:, best].T, evidence[best], said[best])


@dataclass(frozen=True, slots=True)
class _Looks:
    """What the strengths and colours of N peaks say.

    At most, ``rarity`` (N,): see ``Clutter.most``; ``same`` (N, N): see ``Colours.most``, and
    ``nearest`` (N,): of the colour nearest to each one's.
    """

    snr: Real
    along: Real
    clutter: Clutter
    colours: Colours
    likeness: Real
    rarity: Real
    same: Real
    nearest: Real

    @classmethod
    def of(cls, model: ShapeModel, peaks: Peaks, clutter: Clutter) -> _Looks:
        snr, likeness = peaks.snr, peaks.likeness
        colours = Colours.of(peaks.chroma, snr, clutter.near)
        aside = len(model.order) - 1
        same = colours.most(aside)
        nearest = same.max(axis=1, initial=0.0)
        most = clutter.most(aside) + likeness
        return cls(snr, model.along, clutter, colours, likeness, most, same, nearest)

    def at_most(self, members: NDArray[np.intp]) -> Real:
        """Rarity and colours of sets whose first k members are (k, M), at most: if the others
        were as rare as the rarest of them (rarer ones would be too unlike) and of the colour
        nearest to that of the one that has the dock's.
        """
        others = len(self.along) - len(members)
        rarity = self.rarity[members]
        same = self.same.take(members[:, None] * len(self.rarity) + members).sum(axis=1)
        same += others * self.nearest[members]
        rest = others * np.maximum(rarity.max(axis=0), self.rarity.max())
        return np.asarray(rarity.sum(axis=0) + rest + same.max(axis=0))

    def alike(self, members: NDArray[np.intp]) -> Real:
        """Of sets (n, M): see ``log_alike``."""
        return log_alike(self.snr[members.T], self.along)

    def exactly(self, members: NDArray[np.intp]) -> Real:
        """Rarity and colours of sets (n, M)."""
        sets = np.ascontiguousarray(members.T)
        said = self.clutter.rarity_of(sets) + self.colours.log_common(sets)
        return np.asarray(said + self.likeness[sets].sum(axis=1))


@dataclass(frozen=True, slots=True)
class _Sets:
    """Peaks taken for the first k markers of the model's order.

    ``members`` (k, M); ``ends`` (M,) and ``span`` (M,): the base and its span of sizes;
    ``shape`` (k - 2, M); ``place`` (M,): log density of the places, the first's left out;
    ``hope`` (M,): the most that the evidence may become, without rarity and colours.
    """

    members: NDArray[np.intp]
    ends: Complex
    span: NDArray[np.intp]
    shape: Complex
    place: Real
    hope: Real

    def extended(
        self,
        step: _Step,
        expected: Complex,
        z: Complex,
        parent: NDArray[np.intp],
        peak: NDArray[np.intp],
    ) -> _Sets:
        """Sets ``parent`` (L,) with one more ``peak`` (L,) each, if that is not too far from
        where it is expected: (M,), see ``_Step.expected``."""
        before, span = self.members[:, parent], self.span[parent]
        b = (z[peak] - z[before[0]]) / self.ends[parent]
        below, near = step.judge(b - expected[parent], span)
        kept = np.flatnonzero(near & (before != peak).all(axis=0))
        parent, span, below = parent[kept], span[kept], below[kept]
        ends = self.ends[parent]
        return _Sets(
            np.concatenate([before[:, kept], peak[None, kept]]),
            ends,
            span,
            np.concatenate([self.shape[:, parent], b[None, kept]]),
            self.place[parent] + step.log_peak[span] - below - 2 * np.log(np.abs(ends)),
            self.hope[parent] - below,
        )

    def hopeful(self, looks: _Looks, least: float) -> _Sets:
        """Those that may come to ``least``, MAX_SETS."""
        hope = self.hope + looks.at_most(self.members)
        kept = np.flatnonzero(hope >= least)
        if len(kept) > MAX_SETS:
            kept = kept[_best(hope[kept], MAX_SETS)]
        return _Sets(
            self.members[:, kept],
            self.ends[kept],
            self.span[kept],
            self.shape[:, kept],
            self.place[kept],
            self.hope[kept],
        )


@dataclass(frozen=True, slots=True)
class _Step:
    """Where one more marker's b is, given those before it, for each span: a normal density.

    ``mean`` (S,) and ``before`` (k, S): the means of its b and of the k before; ``gain`` and
    ``mirrored`` (k, S): what it follows of their deviations and of these' conjugates; ``inverse``
    (3, S): xx, xy, yy of the inverse covariance, ``log_peak`` (S,), ``reach`` (S,): the distance
    that none goes beyond.
    """

    mean: Complex
    before: Complex
    gain: Complex
    mirrored: Complex
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
        by_before = -np.linalg.solve(own, precision[:, 2 * k :, : 2 * k])
        (xx, xy), (yx, yy) = np.moveaxis(by_before.reshape(len(noise), 2, k, 2), [1, 3], [0, 1])
        mean = np.ascontiguousarray(model.mean[:, :size]).view(np.complex128).T
        return cls(
            mean=mean[k],
            before=mean[:k],
            gain=(0.5 * (xx + yy + 1j * (yx - xy))).T,
            mirrored=(0.5 * (xx - yy + 1j * (yx + xy))).T,
            inverse=np.stack([own[:, 0, 0], own[:, 0, 1], own[:, 1, 1]]),
            log_peak=0.5 * np.linalg.slogdet(own)[1] - np.log(2 * np.pi),
            reach=np.sqrt(_NEAR / np.linalg.eigvalsh(own)[:, 0]),
        )

    def expected(self, before: Complex, span: NDArray[np.intp]) -> Complex:
        """(M,) b after (k, M) others."""
        off = before - self.before[:, span]
        follows = self.gain[:, span] * off + self.mirrored[:, span] * off.conj()
        return np.asarray(self.mean[span] + follows.sum(axis=0))

    def judge(self, off: Complex, span: NDArray[np.intp]) -> tuple[Real, NDArray[np.bool_]]:
        """How far below its peak the log density is (M,) off, and whether that is not too far."""
        x, y = off.real, off.imag
        xx, xy, yy = self.inverse[:, span]
        square = xx * x * x + 2 * xy * x * y + yy * y * y
        return 0.5 * square, square < _NEAR


def _sharing(
    first: NDArray[np.intp], p: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """All pairs of equals among (B,) and (P,), both ascending: indices (L,) into either."""
    start = np.searchsorted(first, p)
    each = np.searchsorted(first, p, side="right") - start
    side = np.repeat(np.arange(len(p)), each)
    base = np.arange(len(side)) + np.repeat(start + each - np.cumsum(each), each)
    return base, side


def _best(score: Real, most: int) -> NDArray[np.intp]:
    """Indices of the highest scores, the best first."""
    return np.argsort(-score, kind="stable")[:most]
