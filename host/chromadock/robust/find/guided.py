"""Markers where a pose known beforehand expects them, of which one may be missing."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.geometry.pose import MIN_MARKERS, Estimate, projected
from chromadock.robust.frame.peaks import Peaks
from chromadock.robust.weigh.evidence import evidence_of_sets, placed_along

HIDDEN = 0.1
"""How often a marker is out or behind something."""

SAME_PLACE_PX = 0.5
"""Pixels.  Two poses that have every marker within this of each other expect the same peaks: a
peak's own place is no better known."""

# Chi-square with two degrees of freedom that true markers exceed in 0.1%.
_GATE = 13.8
# The same that they exceed in 5%: a marker so far from where the others have it may be none.
_UNLIKELY = 6.0
# Ways to choose the peaks: bounds the time.
_MAX_CHOICES = 64


@dataclass(frozen=True, slots=True)
class Guess:
    """``markers`` (k,) of the dock at ``members`` (k,) of the peaks, and the evidence.

    ``looks``: the part of the evidence that has nothing to do with where exactly they are, where
    no pose was expected; ``expected`` (k, 2): pixels, where they were expected, if they were.
    """

    markers: NDArray[np.intp]
    members: NDArray[np.intp]
    evidence: float
    looks: float | None = None
    expected: NDArray[np.float64] | None = None


class Expectation:
    """Where ``prior`` has the (n, 3) markers of a dock, metres, in a frame of the camera.

    ``prior`` is the pose expected of this frame, with its information.
    """

    def __init__(
        self, points_dock: NDArray[np.float64], prior: Estimate, camera: CameraModel
    ) -> None:
        self._area = float(camera.width * camera.height)
        self._along = placed_along(points_dock)
        seen = projected(points_dock, prior.R, prior.t, camera)
        self._places = None if seen is None else seen[0]
        if seen is not None:
            jacobian = seen[1].reshape(-1, 6)
            self._covariance = jacobian @ prior.covariance @ jacobian.T
            # What shines at the border is no marker beyond it, but what is left of its halo.
            size = np.array([camera.width, camera.height])
            self._inside = ((seen[0] > 0) & (seen[0] < size - 1)).all(axis=1)

    def like(self, other: Expectation) -> bool:
        """Whether both have the markers at the same places."""
        if self._places is None or other._places is None:
            return self._places is other._places
        return bool(np.abs(self._places - other._places).max() < SAME_PLACE_PX)

    @property
    def spacing_px(self) -> float:
        """Pixels between the two markers that are closest to each other; 0 out of view."""
        if self._places is None:
            return 0.0
        apart = np.linalg.norm(self._places[:, None] - self._places, axis=2)
        np.fill_diagonal(apart, np.inf)
        return float(apart.min())

    def guess(self, peaks: Peaks, sigma_px: float) -> Guess | None:
        """The best set of all markers, or of all but one, among peaks located to ``sigma_px``.

        The evidence is the same likelihood ratio as the search's, with what the prior says of
        the pose in place of all views.  One marker is taken for hidden where it has no peak, or
        where the one that it has is unlikely to be it.
        """
        if self._places is None or len(peaks.snr) < MIN_MARKERS:
            return None
        count = len(self._places)
        covariance = self._covariance + sigma_px**2 * np.eye(2 * count)
        options = self._options(peaks, covariance)
        hidden = [marker for marker, near in enumerate(options) if not near]
        every = np.arange(count)
        if hidden:
            others = np.delete(every, hidden[0])
            alone = len(hidden) == 1 and len(others) >= MIN_MARKERS
            return self._best(peaks, covariance, options, others)[0] if alone else None
        best, unlikely = self._best(peaks, covariance, options, every)
        guesses = [best]
        for marker in unlikely if count > MIN_MARKERS else ():
            others = np.delete(every, marker)
            guesses.append(self._best(peaks, covariance, options, others)[0])
        return max(filter(None, guesses), key=lambda guess: guess.evidence, default=None)

    def _options(self, peaks: Peaks, covariance: NDArray[np.float64]) -> list[list[int]]:
        """Of each marker the peaks that may be it, the nearest first."""
        count = len(covariance) // 2
        most = max(1, int(_MAX_CHOICES ** (1 / count)))
        own = covariance.reshape(count, 2, count, 2)[range(count), :, range(count)]
        off = peaks.xy - np.asarray(self._places)[:, None]
        square = np.einsum("mpi,mij,mpj->mp", off, np.linalg.inv(own), off)
        # What is left of the halo of a marker beyond the border is no other marker either.
        beyond = np.asarray(~self._inside)
        square[:, beyond[square.argmin(axis=0)]] = np.inf
        square[beyond] = np.inf
        near = np.argsort(square, axis=1)[:, :most]
        within = np.take_along_axis(square, near, axis=1) < _GATE
        return [n[w].tolist() for n, w in zip(near, within, strict=True)]

    def _best(
        self,
        peaks: Peaks,
        covariance: NDArray[np.float64],
        options: list[list[int]],
        markers: NDArray[np.intp],
    ) -> tuple[Guess | None, list[int]]:
        """Of sets of these markers the likeliest, and which of its markers are far from where
        its others have them; none and all of them where no set has a peak for each."""
        choices = [c for c in product(*(options[m] for m in markers)) if len(set(c)) == len(c)]
        if not choices:
            return None, markers.tolist()
        members = np.array(choices)
        rows = (2 * markers[:, None] + [0, 1]).ravel()
        part = covariance[np.ix_(rows, rows)]
        whiten = np.linalg.inv(np.linalg.cholesky(part))
        log_norm = float(np.log(np.diagonal(whiten) / np.sqrt(2 * np.pi)).sum())
        inverse = whiten.T @ whiten
        places = np.asarray(self._places)[markers]
        off = (peaks.xy[members] - places).reshape(len(members), -1)
        weighed = off @ inverse
        chance = np.log(1 - HIDDEN if len(markers) == len(options) else HIDDEN)
        evidence = chance + log_norm - 0.5 * (weighed * off).sum(axis=1)
        z = peaks.xy @ np.array([1, 1j])
        evidence += evidence_of_sets(z, peaks, self._area, members, self._along[markers])
        k = int(evidence.argmax())
        # Given the others' places a marker's is normal, with the inverse of its own block of the
        # information for its covariance.
        size = len(markers)
        blocks = inverse.reshape(size, 2, size, 2)[range(size), :, range(size)]
        pull = weighed[k].reshape(size, 2, 1)
        square = (pull * np.linalg.solve(blocks, pull)).sum(axis=(1, 2))
        guess = Guess(markers, members[k], float(evidence[k]), expected=places)
        return guess, markers[square > _UNLIKELY].tolist()
