"""Poses that frames leave open, side by side until the data decide.

A Gaussian sum filter (Alspach and Sorenson, IEEE Trans. Automatic Control 17 (1972) 439): each
hypothesis is updated towards each pose that a frame leaves open, and weighted by how probable
that makes the frame; those that come out the same are one, and those that the data speak against
are dropped.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.weigh.acceptance import doubt, share_beyond
from chromadock.track.fusion import Fused, with_attitude, with_markers, with_turn_rate
from chromadock.track.motion import POSE, State, met, turn_between
from chromadock.track.sight import Sight

Floats = NDArray[np.float64]

MAX_HYPOTHESES = 5
"""The four poses that three markers leave open (Haralick et al., International Journal of Computer
Vision 13 (1994) 331), and one on its way from one to another."""

FORGOTTEN = 1e-3
"""Less likely hypotheses are dropped: the data have decided."""

SWITCH_ODDS = 3.0
"""The first of nearly equal hypotheses stays the first until another is so much likelier: noise
alone must not make the pose jump."""

REBORN = 0.05
"""Probability that the true pose is one that had been dropped, or never came up, when a frame
leaves one open that no hypothesis covers."""

MISTAKEN = 0.05
"""Probability that a frame's markers are none of this dock, where they stand nowhere near the
likeliest hypothesis but where another has them: a lamp beside a marker that has left the picture.
Of all frames after a lock one in 450 is so (39 of 17,526 in drawn approaches), of those that fit
an unlikely hypothesis alone far more.  As much as REBORN: what has just come up does not win by
one frame, but by two."""

# Not covered: 1.4 standard deviations of the difference, squared.  Farther, and a pose would never
# come back whose errors are as large as what tells it from the others: the flipped one of a dock
# that is far away, and the true one of three markers that are seen face on.
_FAR = 2.0

# Two equal normal distributions have one top up to two standard deviations apart, 2 in this
# measure; but what the pixels leave open is curved, and merged too soon the sum covers neither.
_SAME = 0.5


@dataclass(frozen=True, eq=False, slots=True)
class Hypothesis:
    """One way it may be, and its probability among those of its bank."""

    state: State
    weight: float


@dataclass(frozen=True, eq=False, slots=True)
class Bank:
    """Hypotheses of one dock, MAX_HYPOTHESES at most; their weights sum to 1.

    The first is the one to go by, mostly the likeliest: see SWITCH_ODDS.  ``log_likelihood`` of
    all that was taken in since the bank was made or doubted, by all hypotheses together, up to
    what is the same for each bank; ``misfit``: the largest chi-square over degrees of freedom
    among that, by the likeliest, infinite where that is nowhere near.  ``missed``: whether the
    last frame shows nothing where the first hypothesis has the dock.
    """

    hypotheses: tuple[Hypothesis, ...]
    log_likelihood: float = 0.0
    misfit: float = 0.0
    missed: bool = False

    @classmethod
    def of(cls, sight: Sight) -> Bank:
        """From the poses that a first frame leaves open."""
        return _bank(
            [_Branch(met(p.R, p.t, p.covariance), -p.chi_square / 2, False) for p in sight.poses]
        )

    @property
    def doubt(self) -> float:
        """Probability that the place of the dock's origin is off by more than 5 % of its range."""
        states = [h.state.as_told for h in self.hypotheses]
        return doubt(states, [h.weight for h in self.hypotheses])

    @property
    def elsewhere(self) -> float:
        """Probability of the hypotheses that have the dock's origin off from where the first has
        it by more than 5 % of its range."""
        t = np.array([h.state.t for h in self.hypotheses])
        weights = np.array([h.weight for h in self.hypotheses])
        # As if each were known exactly.
        return share_beyond(t[0], t, np.full(len(t), 1e-9), weights)

    def about(self, origin: Floats) -> Bank:
        """The same by a dock frame with its origin at ``origin`` (3,), metres, dock frame."""
        return Bank(tuple(Hypothesis(h.state.about(origin), h.weight) for h in self.hypotheses))

    def after(self, elapsed_s: float, swift: float = 0.0) -> Bank:
        """The same ``elapsed_s`` >= 0 later, nothing seen meanwhile, of a vehicle that manoeuvres
        with probability ``swift``."""
        moved = tuple(
            Hypothesis(h.state.after(elapsed_s, swift), h.weight) for h in self.hypotheses
        )
        return replace(self, hypotheses=moved)

    def seen(self, sight: Sight) -> Bank | None:
        """After a frame; None where that is no place for this dock to be: beyond the gate.

        A hypothesis that the frame is nowhere near stays where it is, as probable as that the
        frame is MISTAKEN.
        """
        modes = [_modes(h.state, sight) for h in self.hypotheses]
        if not any(modes):
            return None
        most = max(fused.log_likelihood for fits in modes for fused in fits)
        branches: list[_Branch] = []
        for i, (h, fits) in enumerate(zip(self.hypotheses, modes, strict=True)):
            branches += [_branch(h, fused, first=i == 0) for fused in fits]
            if not fits:
                log_weight = float(np.log(h.weight * MISTAKEN)) + most
                branches.append(_Branch(h.state, log_weight, i == 0, np.inf))
        after = self._then(_bank(branches))
        first = after.hypotheses[0].state
        missed = [h.state for h, fits in zip(self.hypotheses, modes, strict=True) if not fits]
        return replace(after, missed=any(first is state for state in missed))

    def doubting(self, sight: Sight) -> Bank:
        """With the poses of a frame that it is far from, moving as its first does: REBORN."""
        first = self.hypotheses[0].state
        branches = [
            _Branch(h.state, float(np.log(h.weight)), i == 0) for i, h in enumerate(self.hypotheses)
        ]
        for pose in sight.poses:
            anew = first.moved_to(pose.R, pose.t, pose.covariance)
            if all(_distance(anew, h.state) > _FAR for h in self.hypotheses):
                less = (pose.chi_square - sight.poses[0].chi_square) / 2
                branches.append(_Branch(anew, float(np.log(REBORN)) - less, False))
        return replace(_bank(branches), log_likelihood=0.0)

    def facing(self, R_expected: Floats, covariance: Floats) -> Bank:
        """After the vehicle told how it should see the dock turned: see ``with_attitude``."""
        return self._told(lambda state: with_attitude(state, R_expected, covariance))

    def turning(self, turn_rate: Floats, variance: float, strayed: float) -> Bank:
        """After the vehicle told at which rate (3,) rad/s its camera turns: see
        ``with_turn_rate``; its own rate may have changed meanwhile with variance ``strayed``."""
        return self._told(lambda state: with_turn_rate(state.strayed(strayed), turn_rate, variance))

    def _told(self, fuse: Callable[[State], Fused]) -> Bank:
        return self._then(
            _bank([_branch(h, fuse(h.state), first=i == 0) for i, h in enumerate(self.hypotheses)])
        )

    def _then(self, after: Bank) -> Bank:
        """``after`` one more thing was taken in."""
        return replace(
            after,
            log_likelihood=self.log_likelihood + after.log_likelihood,
            misfit=max(self.misfit, after.misfit),
        )


@dataclass(frozen=True, eq=False, slots=True)
class _Branch:
    """What may become a hypothesis; ``first``: it comes of the bank's first."""

    state: State
    log_weight: float
    first: bool
    misfit: float = 0.0


def _modes(state: State, sight: Sight) -> list[Fused]:
    """What a state may become by a frame: its most probable poses, those within the gate."""
    fits: list[Fused] = []
    for R, t in [(state.R, state.t), *((p.R, p.t) for p in sight.poses)]:
        if any(_is_there(fit.state, R, t) for fit in fits):
            continue
        fused = with_markers(state, sight.markers, R, t, sight.smaller)
        if fused is not None and fused.within_gate:
            fits.append(fused)
    # Ways to one top end a little apart, and each would count it anew.
    modes: list[Fused] = []
    for fit in sorted(fits, key=lambda fit: -fit.log_likelihood):
        if all(_distance(fit.state, mode.state) >= _SAME for mode in modes):
            modes.append(fit)
    return modes


def _is_there(state: State, R: Floats, t: Floats) -> bool:
    """Whether from a pose one comes to that of a state again: it is well within its errors."""
    off = np.concatenate([t - state.t, turn_between(state.R, R)])
    return bool(off @ np.linalg.solve(state.covariance[POSE, POSE], off) < _SAME)


def _branch(h: Hypothesis, fused: Fused, first: bool) -> _Branch:
    log_weight = float(np.log(h.weight)) + fused.log_likelihood
    return _Branch(fused.state, log_weight, first, fused.chi_square / fused.freedom)


def _bank(branches: list[_Branch]) -> Bank:
    """Merged, pruned, and in order."""
    most = max(b.log_weight for b in branches)
    left = sorted(branches, key=lambda b: -b.log_weight)
    kept: list[_Branch] = []
    while left:
        one = left.pop(0)
        for other in [b for b in left if _distance(one.state, b.state) < _SAME]:
            one = _merged(one, other)
            left.remove(other)
        kept.append(one)
    kept = [b for b in kept if b.log_weight > most + np.log(FORGOTTEN)]
    kept = sorted(kept, key=lambda b: -b.log_weight)[:MAX_HYPOTHESES]
    kept.sort(key=lambda b: -b.log_weight - (np.log(SWITCH_ODDS) if b.first else 0.0))
    weights = np.exp([b.log_weight - most for b in kept])
    total = float(weights.sum())
    return Bank(
        tuple(Hypothesis(b.state, float(w / total)) for b, w in zip(kept, weights, strict=True)),
        most + float(np.log(total)),
        max(branches, key=lambda b: b.log_weight).misfit,
    )


def _off(a: State, b: State) -> Floats:
    """(12,) from a to b."""
    return np.concatenate(
        [
            b.t - a.t,
            turn_between(a.R, b.R),
            b.velocity - a.velocity,
            b.turn_rate - a.turn_rate,
        ]
    )


def _distance(a: State, b: State) -> float:
    """Squared, of the poses, in standard deviations of their difference."""
    off = _off(a, b)[POSE]
    return float(off @ np.linalg.solve((a.covariance + b.covariance)[POSE, POSE], off))


def _merged(a: _Branch, b: _Branch) -> _Branch:
    """One normal distribution with the mean and the covariance of both together."""
    log_weight = float(np.logaddexp(a.log_weight, b.log_weight))
    share = float(np.exp(b.log_weight - log_weight))
    off = _off(a.state, b.state)
    covariance = (1 - share) * a.state.covariance + share * b.state.covariance
    covariance = covariance + share * (1 - share) * np.outer(off, off)
    drawn = (1 - share) * a.state.drawn + share * b.state.drawn
    state = replace(a.state.corrected(share * off, covariance), drawn=drawn)
    return _Branch(state, log_weight, a.first or b.first)
