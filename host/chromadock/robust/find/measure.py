"""Candidates of one frame held to its pixels: where exactly the markers are, and the poses."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.pose import Estimate, Sighting, estimates, projected, same_minimum
from chromadock.geometry.pose import refined as refined_pose
from chromadock.results.detection import Misfit
from chromadock.robust.find.guided import HIDDEN, Expectation, Guess
from chromadock.robust.find.search import SearchedPeaks
from chromadock.robust.find.view import MAX_TRIALS, PEAK_ERROR, Candidate, View
from chromadock.robust.frame.bars import smaller
from chromadock.robust.frame.flux import fluxes
from chromadock.robust.frame.peaks import Peaks
from chromadock.robust.frame.plateau import on_one_thing
from chromadock.robust.frame.refine import Tops, leaning, refined
from chromadock.robust.frame.response import Response
from chromadock.robust.weigh.acceptance import (
    GAIN_OF_EXACT,
    LEAST_EVIDENCE,
    LEAST_FOR_A_TRACK,
    LIKELY,
    MORE_OF_DARK,
    Constellation,
    doubt_of_size,
)
from chromadock.robust.weigh.evidence import PlacedPeaks
from chromadock.robust.weigh.placement import Placement, PosePrior, placement
from chromadock.robust.weigh.shape import MIN_SPACING_CELLS
from chromadock.robust.weigh.told import told
from chromadock.robust.weigh.twin import is_image_of

MISFIT_DECADES = 8.0
"""Evidence from which on a set of peaks that is no rigid dock deserves a word: that of the search
where the places do not admit it for a dock at all.  No photograph without a dock has as much."""

MISFIT_ERRORS = 2.5
"""Standard errors of a place, root mean square, beyond which markers do not fit: chi-square 25 with
the two degrees of freedom that four markers leave, one in 300,000.  What fits better is right, or
was not taken for another reason, and neither the dock's file nor the calibration would mend it."""

MAX_CHOICES = 3
"""Places of each of four markers that are tried in every combination; of more markers two."""

SAME_PLACE_PX = 4.0
"""Of exact places: two that are nearer than this to each other are one lamp."""


@dataclass(frozen=True, eq=False, slots=True)
class Measure:
    """One frame and what is known of it.

    ``frame_bgr`` (H, W, 3) uint8; ``prior``: of the dock's pose; ``upright``: see ``View``;
    ``largest_range_m``: a dock farther away is none.  ``judged`` (3,): metres, in the frame of the
    view's markers: see ``DockGeometry.judged``.  ``misfits`` receives what stood like a dock and
    does not fit.
    """

    frame_bgr: NDArray[np.uint8]
    response: Response
    view: View
    prior: PosePrior
    upright: complex
    largest_range_m: float
    judged: NDArray[np.float64]
    misfits: list[Misfit] = field(default_factory=list)

    @property
    def _more(self) -> float:
        """Evidence that is asked beside that of lamps."""
        return MORE_OF_DARK if self.response.sense < 0 else 0.0

    def best(self, candidates: list[Candidate]) -> Constellation | None:
        """The dock: the candidate with most evidence, or what it is an image of."""
        accepted: list[Constellation] = []
        cells: list[int] = []
        likely = sum(c.evidence >= LIKELY for c in candidates[:MAX_TRIALS])
        for candidate in candidates[: likely + 1]:
            # Where no likely one is the dock one more is worth the time.
            if accepted and candidate.evidence < LIKELY:
                break
            if any(_outdone(candidate, c) for c in accepted):
                continue
            constellation = self._accepted(candidate)
            if constellation is not None:
                accepted.append(constellation)
                cells.append(candidate.cell)
        if not accepted:
            return None
        first = max(range(len(accepted)), key=lambda k: accepted[k].evidence)
        finer = [c for c, cell in zip(accepted, cells, strict=True) if cell < cells[first]]
        best = _best_placed(accepted[first], cells[first], finer)
        # No lamp is a lamp of the image, too.
        others = [c for c in accepted if not _shared(best.xy, c.xy, SAME_PLACE_PX).any()]
        originals = [c for c in others if is_image_of(best, c, self.view.camera)]
        return max(originals, key=lambda c: c.evidence) if originals else best

    def about(self, priors: tuple[Estimate, ...], peaks: dict[int, Peaks]) -> Constellation | None:
        """What stands about where a track has the dock, if that is evidence enough.

        With the poses downhill of the track's: which of them is right is the track's to say.
        """
        guesses: list[tuple[Guess, int, Peaks]] = []
        expectations: list[Expectation] = []
        placed: dict[int, PlacedPeaks] = {}
        view = self.view
        for prior in priors:
            expectation = Expectation(view.points, view.along, prior, view.camera)
            # The two poses of a plane differ in what they are, not in where the markers are.
            if any(expectation.like(other) for other in expectations):
                continue
            expectations.append(expectation)
            spacing_px = expectation.spacing_px
            for cell, found in peaks.items():
                if spacing_px < MIN_SPACING_CELLS * cell:
                    break  # two markers are one peak in cells so wide
                if cell not in placed:
                    area = float(view.camera.width * view.camera.height)
                    placed[cell] = PlacedPeaks(found.xy, found, area)
                guess = expectation.guess(placed[cell], PEAK_ERROR * cell)
                if guess is not None and guess.evidence >= LEAST_FOR_A_TRACK + self._more:
                    guesses.append((guess, cell, found))
        guesses.sort(key=lambda g: g[0].evidence, reverse=True)
        measured = (self._partly(*guess, priors) for guess in guesses)
        return next(filter(None, measured), None)

    def incomplete(self, searched: dict[int, SearchedPeaks]) -> Constellation | None:
        """The dock with a marker out, if that explains the frame well enough."""
        measured: list[Constellation] = []
        for cell, among in searched.items():
            guess = self.view.incomplete.find(cell, among, PEAK_ERROR * cell, LEAST_FOR_A_TRACK)
            seen = None if guess is None else self._partly(guess, cell, among.peaks)
            if seen is not None:
                measured.append(seen)
        return max(measured, key=lambda seen: seen.evidence, default=None)

    def _accepted(self, candidate: Candidate) -> Constellation | None:
        peaks, members = candidate.peaks, candidate.members
        found = candidate.xy
        tops = refined(self.frame_bgr, found, candidate.cell, self.response, peaks.noise[members])
        if tops is None:
            return None
        xy, sigma, drift = _choices(tops)
        likely = self.view.log_shape(xy, sigma, self.upright) if len(xy) > 1 else np.zeros(1)
        k = int(likely.argmax())
        if on_one_thing(self.frame_bgr, xy[k], self.response.sense):
            return None
        sighting = Sighting(self.view.points, xy[k], sigma[k], self.view.camera)
        poses = estimates(sighting)
        if not poses:
            return None
        placed = placement(sighting, poses, self.prior)
        # So many places to choose from are so many chances for clutter.
        evidence = placed.log_density + candidate.looks - float(np.log(len(xy)))
        if evidence < LEAST_EVIDENCE + self._more:
            amiss = misfit(candidate.evidence, poses, np.hypot(sigma[k], drift[k]))
            self.misfits.extend(filter(None, [amiss]))
            return None
        amiss = misfit(evidence, poses, np.hypot(sigma[k], drift[k]))
        sighting, poses, unsure, drawn = self._told(
            sighting, poses, placed, drift[k], tops, self.judged
        )
        if self._too_far(poses) or not self._all_belong(candidate, sighting, poses[0]):
            return None
        markers, sigma_px = np.arange(len(self.view.points)), sighting.sigma_px
        return Constellation(markers, xy[k], sigma_px, evidence, poses, unsure, amiss, drawn)

    def _too_far(self, poses: tuple[Estimate, ...]) -> bool:
        """Whether the likeliest pose has the markers' centroid beyond the range of a dock."""
        return bool(np.linalg.norm(poses[0].t) > self.largest_range_m)

    def _all_belong(self, candidate: Candidate, sighting: Sighting, pose: Estimate) -> bool:
        """Whether each marker is likelier where it was taken to be than hidden, with a peak of
        clutter near where it should be."""
        seen = projected(sighting.points_dock, pose.R, pose.t, sighting.camera)
        if seen is None:
            return False
        variance = sighting.sigma_px**2
        square = ((seen[0] - sighting.pixels) ** 2).sum(axis=1)
        places = -0.5 * square / variance - np.log(2 * np.pi * variance)
        hidden = float(np.log(HIDDEN / (1 - HIDDEN)))
        return all(
            candidate.looks + place - candidate.looks_without(marker, self.view.along) > hidden
            for marker, place in enumerate(places.tolist())
        )

    def _told(
        self,
        sighting: Sighting,
        poses: tuple[Estimate, ...],
        placed: Placement,
        drift_px: NDArray[np.float64],
        tops: list[Tops],
        judged: NDArray[np.float64],
    ) -> tuple[Sighting, tuple[Estimate, ...], float, float]:
        """See ``weigh.told``; the poses with the error that bars may make, and that error, see
        ``look.Found.smaller``."""
        bright = fluxes(self.frame_bgr, sighting.pixels) if self.response.sense > 0 else None
        sighting, poses, unsure = told(
            sighting, poses, placed, drift_px, bright, self.prior, judged
        )
        drawn = smaller(sighting.pixels, leaning(self.frame_bgr, tops))
        if self.response.sense < 0:
            # A dark bar ends at no holder that is darker: it draws nearly each as far as it may.
            unsure = max(unsure, doubt_of_size(drawn))
        return sighting, tuple(pose.drawn(drawn) for pose in poses), unsure, drawn

    def _partly(
        self, guess: Guess, cell: int, peaks: Peaks, priors: tuple[Estimate, ...] = ()
    ) -> Constellation | None:
        """What was guessed, measured: markers at the places that are nearest to the guess."""
        found = peaks.xy[guess.members]
        tops = refined(self.frame_bgr, found, cell, self.response, peaks.noise[guess.members])
        if tops is None:
            return None
        places = found if guess.expected is None else guess.expected
        nearest = [top.nearest(place) for top, place in zip(tops, places, strict=True)]
        xy, sigma, drift = (np.array(values) for values in zip(*nearest, strict=True))
        # Where a track has the dock its lamps may be so near that they run into each other.
        if not priors and on_one_thing(self.frame_bgr, xy, self.response.sense):
            return None
        points = self.view.points[guess.markers]
        sighting = Sighting(points, xy, sigma, self.view.camera)
        poses = _downhill(sighting, priors) if priors else estimates(sighting)
        if not poses:
            return None
        placed = placement(sighting, poses, self.prior)
        evidence = guess.evidence if guess.looks is None else placed.log_density + guess.looks
        if evidence < LEAST_FOR_A_TRACK + self._more:
            return None
        whole = len(guess.markers) == len(self.view.points)
        amiss = misfit(evidence, poses, np.hypot(sigma, drift)) if whole else None
        # Where the dock's origin is from its centroid the track's attitude tells, and with a marker
        # out better than the frame does.
        judged = np.zeros(3) if priors else self.judged
        sighting, poses, unsure, drawn = self._told(sighting, poses, placed, drift, tops, judged)
        if self._too_far(poses):
            return None
        sigma_px = sighting.sigma_px
        return Constellation(guess.markers, xy, sigma_px, evidence, poses, unsure, amiss, drawn)


def misfit(
    evidence: float, poses: tuple[Estimate, ...], sigma_px: NDArray[np.float64]
) -> Misfit | None:
    """What stands like a dock, by its natural log of evidence, but is no rigid dock: by the best of
    its poses the root mean square error is beyond what those of its places, ``sigma_px`` (n,),
    explain.  None of what fits."""
    decades = evidence / float(np.log(10))
    error_px = poses[0].reprojection_px
    known_px = float(np.sqrt(np.mean(sigma_px**2)))
    if decades < MISFIT_DECADES or error_px <= MISFIT_ERRORS * known_px:
        return None
    return Misfit(decades, error_px)


def _choices(tops: list[Tops]) -> tuple[NDArray[np.float64], ...]:
    """All ways to choose a place for each marker: (N, n, 2) places, their (N, n) errors and their
    drifts."""
    each = MAX_CHOICES if len(tops) <= 4 else 2
    of_all = [t.xy for t in tops], [t.sigma for t in tops], [t.drift for t in tops]
    return tuple(np.array(list(product(*(of[:each] for of in values)))) for values in of_all)


def _downhill(sighting: Sighting, priors: tuple[Estimate, ...]) -> tuple[Estimate, ...]:
    """The poses that markers leave open downhill of priors, best first; from scratch, if none."""
    found: list[Estimate] = []
    for prior in priors:
        pose = refined_pose(sighting, prior.R, prior.t)
        if pose is not None and not any(same_minimum(pose, other) for other in found):
            found.append(pose)
    return tuple(sorted(found, key=lambda pose: pose.chi_square)) or estimates(sighting)


def _outdone(candidate: Candidate, accepted: Constellation) -> bool:
    """Whether a candidate has a place in common with an accepted set and is that set again, seen
    in cells of another size, or cannot have as much evidence even with exact places."""
    shared = _shared(candidate.xy, accepted.xy, 2 * candidate.cell)
    hopeless = candidate.evidence + GAIN_OF_EXACT < accepted.evidence
    return bool(shared.all() or (shared.any() and hopeless))


def _shared(a: NDArray[np.float64], b: NDArray[np.float64], near_px: float) -> NDArray[np.bool_]:
    """(n,) which of the places (n, 2) are also among (m, 2) others."""
    return np.asarray((np.linalg.norm(a[:, None] - b[None], axis=2) < near_px).any(axis=1))


def _best_placed(best: Constellation, cell: int, finer: list[Constellation]) -> Constellation:
    """``best``, found in cells ``cell`` pixels wide, or that of the sets found in ``finer`` cells
    which is the same dock, each marker within two of the wider cells, and has better known places.

    What a dock's bars add to coarse cells is evidence for a dock here too, but the corners of bars
    are not where the lamps are.
    """
    same = [c for c in finer if np.linalg.norm(c.xy - best.xy, axis=1).max() < 2 * cell]
    return min([best, *same], key=lambda c: float(c.sigma_px.mean()))
