"""The robust detector from the frame to the pose."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice, product

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.detection import Blob
from chromadock.dock import DockGeometry
from chromadock.look import Found, Look
from chromadock.pose import Estimate, Sighting, estimates, same_rotation
from chromadock.pose import refined as refined_pose
from chromadock.profile import widened
from chromadock.robust.acceptance import HOPEFUL, LEAST_EVIDENCE, MOST_DOUBT, Constellation, doubt
from chromadock.robust.guided import Guess, guided
from chromadock.robust.incomplete import Incomplete
from chromadock.robust.peaks import MIN_SNR, Peaks, find_peaks
from chromadock.robust.placement import PosePrior, placement
from chromadock.robust.received import received_hue
from chromadock.robust.refine import Tops, refined
from chromadock.robust.response import MIN_SIDE, Response, respond
from chromadock.robust.search import Search
from chromadock.robust.shape import ATTITUDE_RAD, MIN_SPACING_CELLS, ShapeModel, focal_px, ideal
from chromadock.robust.twin import is_image_of
from chromadock.stopwatch import Stopwatch

MAX_TRIALS = 6
"""Candidates of a frame that are measured: bounds the time.  The true one is almost always the
first; some of the others are the same dock with one marker mistaken, and its image."""

MAX_CHOICES = 3
"""Places of each of four markers that are tried in every combination; of more markers two."""

MAX_BLOBS = 16
"""Peaks that are reported."""

# Error of a peak's place, in cells.
_PEAK_ERROR = 0.25


class RobustMethod:
    """Matched filter, peaks, constellations by likelihood ratio, both poses."""

    def __init__(self, dock: DockGeometry) -> None:
        self._dock = dock
        self._view: _View | None = None
        self._shape = (0, 0)
        self._response: Response | None = None

    @property
    def mask(self) -> NDArray[np.uint8]:
        """(H, W): the pixels of the last frame that stand out in the markers' colour."""
        if self._response is None:
            return np.zeros(self._shape, np.uint8)
        cells = _standing_out(self._response).astype(np.uint8)
        size = self._shape[::-1]
        return np.asarray(cv2.resize(cells, size, interpolation=cv2.INTER_NEAREST), np.uint8)

    def find(self, look: Look, watch: Stopwatch) -> Found:
        """Look for the dock in one frame; nothing less than all markers where no prior is."""
        frame_bgr = look.frame_bgr
        self._shape, self._response = frame_bgr.shape[:2], None
        if min(self._shape) < MIN_SIDE:
            return Found("not_found", 0.0)
        view = self._view_of(look.camera)
        response = respond(frame_bgr, look.hue, view.focal_px)
        self._response = response
        watch.lap("response")
        peaks = find_peaks(response)
        watch.lap("peaks")
        candidates = []
        if look.everywhere:
            candidates = [c for cell, found in peaks.items() for c in view.candidates(cell, found)]
            candidates.sort(key=lambda c: -c.evidence)
        watch.lap("search")
        measured = _Measured(frame_bgr, response, view, self._dock.points)
        best = measured.best(candidates)
        if best is None and look.everywhere and look.incomplete:
            best = measured.incomplete(peaks)
        best = measured.about(best, look.priors, peaks)
        watch.lap("pose")
        return self._report(best, peaks, response)

    def _view_of(self, camera: CameraModel) -> _View:
        if self._view is None or not self._view.is_of(camera):
            self._view = _View(self._dock.points, camera)
        return self._view

    def _report(
        self, best: Constellation | None, peaks: dict[int, Peaks], response: Response
    ) -> Found:
        cells = _standing_out(response)
        passed = int(np.count_nonzero(cells)) / cells.size
        blobs = _blobs(best, peaks)
        if best is None:
            return Found("not_found", passed, blobs)
        names = self._dock.names
        places = zip(best.markers.tolist(), best.xy.tolist(), strict=True)
        if best.doubt > MOST_DOUBT:
            return Found(
                state="uncertain",
                passed_fraction=passed,
                blobs=blobs,
                markers={names[marker]: (x, y) for marker, (x, y) in places},
                estimates=best.poses,
                evidence=best.evidence / float(np.log(10)),
                hue=received_hue(response, best.xy),
            )
        alternative = best.poses[1].pose() if len(best.poses) > 1 else None
        return Found(
            state="found" if len(best.markers) == len(names) else "partial",
            passed_fraction=passed,
            blobs=blobs,
            markers={names[marker]: (x, y) for marker, (x, y) in places},
            pose=best.poses[0].pose(alternative),
            estimates=best.poses,
            evidence=best.evidence / float(np.log(10)),
            hue=received_hue(response, best.xy),
        )


@dataclass(frozen=True, eq=False, slots=True)
class _Candidate:
    """Peaks at one scale, one for each marker; ``looks``: see ``search.Candidates``."""

    cell: int
    xy: NDArray[np.float64]
    noise: NDArray[np.float64]
    looks: float
    evidence: float


class _View:
    """What one camera makes of one dock: prepared once."""

    def __init__(self, points: NDArray[np.float64], camera: CameraModel) -> None:
        self.camera = camera
        self.focal_px = focal_px(camera)
        self.model = ShapeModel.learn(points, camera)
        corners = ideal(np.array([(0, 0), (camera.width - 1.0, camera.height - 1.0)]), camera)
        across = corners[1] - corners[0]
        self.area = float(abs(across.real * across.imag))
        self._points = points
        nearest = float(np.ptp(points, axis=0).max()) * self.focal_px / max(camera.width, camera.height)
        self.prior = PosePrior(camera, self.area, self.focal_px, float(np.log(20)), np.eye(3), ATTITUDE_RAD)
        self._searches: dict[int, Search] = {}

    @cached_property
    def incomplete(self) -> Incomplete:
        """The search for all markers but one: learnt when it is first needed."""
        return Incomplete(self._points, self.camera, self.area)

    def is_of(self, camera: CameraModel) -> bool:
        """Whether this camera's geometry is the same."""
        mine = self.camera
        return mine is camera or (
            (mine.width, mine.height) == (camera.width, camera.height)
            and np.array_equal(mine.matrix, camera.matrix)
            and np.array_equal(mine.distortion, camera.distortion)
        )

    def candidates(self, cell: int, peaks: Peaks) -> list[_Candidate]:
        """What may be the dock among the peaks of one scale, the best first."""
        if len(peaks.snr) < len(self.model.order):
            return []
        if cell not in self._searches:
            apart_px = MIN_SPACING_CELLS * cell  # so that cells do not touch
            self._searches[cell] = Search(self.model, _PEAK_ERROR * cell, self.area, apart_px)
        found = self._searches[cell].find(ideal(peaks.xy, self.camera), peaks, HOPEFUL)
        best = zip(found.members, found.looks.tolist(), found.evidence.tolist(), strict=True)
        return [
            _Candidate(cell, peaks.xy[members], peaks.noise[members], looks, evidence)
            for members, looks, evidence in islice(best, MAX_TRIALS)
        ]


    def log_shape(
        self, xy: NDArray[np.float64], sigma: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(N,) log density of places (N, n, 2), known to (N, n), as shapes of the dock."""
        order = list(self.model.order)
        z = ideal(xy.reshape(-1, 2), self.camera).reshape(sigma.shape)[:, order]
        base = self.model.log_base(z[:, 1] - z[:, 0])
        return np.asarray(base + self.model.log_shape(z, sigma[:, order]))


@dataclass(frozen=True, eq=False, slots=True)
class _Measured:
    """Candidates of one frame held to its pixels."""

    frame_bgr: NDArray[np.uint8]
    response: Response
    view: _View
    points: NDArray[np.float64]

    def best(self, candidates: list[_Candidate]) -> Constellation | None:
        """The dock: the candidate with most evidence, or what it is an image of."""
        accepted: list[Constellation] = []
        for candidate in candidates[:MAX_TRIALS]:
            if any(_overlap(candidate.xy, c.xy, candidate.cell) for c in accepted):
                continue
            constellation = self._accepted(candidate)
            if constellation is not None:
                accepted.append(constellation)
        if not accepted:
            return None
        best = max(accepted, key=lambda c: c.evidence)
        originals = [c for c in accepted if is_image_of(best, c, self.view.camera)]
        return max(originals, key=lambda c: c.evidence) if originals else best

    def about(
        self, best: Constellation | None, priors: tuple[Estimate, ...], peaks: dict[int, Peaks]
    ) -> Constellation | None:
        """``best``, or what stands about where the priors have the dock, if that says more.

        All the poses that it leaves open, as far as the priors are near them: which of them
        is right is the track's to say, not the priors'.
        """
        for prior in priors:
            for cell, found in peaks.items():
                guess = guided(self.points, prior, found, _PEAK_ERROR * cell, self.view.camera)
                if guess is None or guess.evidence < LEAST_EVIDENCE:
                    continue
                if best is not None and (len(best.markers), best.evidence) >= (
                    len(guess.markers),
                    guess.evidence,
                ):
                    continue
                best = self._partly(guess, cell, found, priors) or best
        return best

    def incomplete(self, peaks: dict[int, Peaks]) -> Constellation | None:
        """The dock with a marker out, if that explains the frame well enough."""
        best: Constellation | None = None
        for cell, found in peaks.items():
            least = LEAST_EVIDENCE if best is None else best.evidence
            guess = self.view.incomplete.find(cell, found, _PEAK_ERROR * cell, least)
            if guess is not None:
                best = self._partly(guess, cell, found) or best
        return best

    def _accepted(self, candidate: _Candidate) -> Constellation | None:
        tops = self._refined(candidate.xy, candidate.cell, candidate.noise)
        if tops is None:
            return None
        xy, sigma = _choices(tops)
        best = int(self.view.log_shape(xy, sigma).argmax()) if len(xy) > 1 else 0
        # So many places to choose from are so many chances for clutter.
        sighting = Sighting(self.points, xy[best], sigma[best], self.view.camera)
        poses = estimates(sighting)
        if not poses:
            return None
        placed = placement(sighting, poses, self.view.prior)
        evidence = placed.log_density + candidate.looks - np.log(len(xy))
        if evidence < LEAST_EVIDENCE:
            return None
        sighting = Sighting(self.points, xy[best], placed.sigma_px, self.view.camera)
        again = [refined_pose(sighting, pose.R, pose.t) or pose for pose in poses]
        order = np.argsort(-placed.weights)
        wide = tuple(widened(sighting, again[k]) for k in order)
        return Constellation(
            np.arange(len(self.points)),
            xy[best],
            float(evidence),
            wide,
            doubt(wide, placed.weights[order]),
        )

    def _partly(
        self, guess: Guess, cell: int, peaks: Peaks, priors: tuple[Estimate, ...] = ()
    ) -> Constellation | None:
        """What was guessed, measured: markers at the places that are nearest to the guess."""
        found = peaks.xy[guess.members]
        tops = self._refined(found, cell, peaks.noise[guess.members])
        if tops is None:
            return None
        places = found if guess.expected is None else guess.expected
        nearest = [top.nearest(place) for top, place in zip(tops, places, strict=True)]
        xy, sigma = (np.array(values) for values in zip(*nearest, strict=True))
        return self._posed(guess.markers, xy, sigma, guess.evidence, priors)

    def _posed(
        self,
        markers: NDArray[np.intp],
        xy: NDArray[np.float64],
        sigma: NDArray[np.float64],
        evidence: float,
        priors: tuple[Estimate, ...],
    ) -> Constellation | None:
        """With all the poses that are left open; None where none is a rigid dock's."""
        sighting = Sighting(self.points[markers], xy, sigma, self.view.camera)
        poses = _poses(sighting, priors) if priors else estimates(sighting)
        if not poses:
            return None
        placed = placement(sighting, poses, self.view.prior)
        sighting = replace(sighting, sigma_px=placed.sigma_px)
        wide = tuple(widened(sighting, pose) for pose in poses)
        return Constellation(markers, xy, evidence, wide)

    def _refined(
        self, xy: NDArray[np.float64], cell: int, noise: NDArray[np.float64]
    ) -> list[Tops] | None:
        layout = self.response.layout
        scale = layout.cells.index(cell)
        height, width = layout.shapes[scale]
        column, row = np.clip(((xy + 0.5) / cell).astype(int), 0, [width - 1, height - 1]).T
        best = self.response.best.ravel()[layout.at(scale, row, column)]
        best = np.bincount(best).argmax()
        return refined(
            self.frame_bgr, xy, cell, self.response.weights[[best] * len(xy)], noise
        )


def _choices(tops: list[Tops]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """All ways to choose a place for each marker: (N, n, 2) places and their (N, n) errors."""
    each = MAX_CHOICES if len(tops) <= 4 else 2
    xy = product(*(top.xy[:each] for top in tops))
    sigma = product(*(top.sigma[:each] for top in tops))
    return np.array(list(xy)), np.array(list(sigma))


def _poses(sighting: Sighting, priors: tuple[Estimate, ...]) -> tuple[Estimate, ...]:
    """All the poses that markers leave open, from scratch and downhill of priors; best first.

    Three places fit up to four poses exactly, of which none is better than another.
    """
    found = list(estimates(sighting))
    for prior in priors:
        pose = refined_pose(sighting, prior.R, prior.t)
        if pose is not None and not any(same_rotation(pose.R, other.R) for other in found):
            found.append(pose)
    return tuple(sorted(found, key=lambda pose: pose.chi_square))


def _overlap(a: NDArray[np.float64], b: NDArray[np.float64], cell: int) -> bool:
    """Whether two sets of places share one, within two cells."""
    return bool((np.linalg.norm(a[:, None] - b[None], axis=2) < 2 * cell).any())


def _standing_out(response: Response) -> NDArray[np.bool_]:
    """Which finest cells are above the least signal to noise."""
    return np.asarray(response.snr[response.layout.inside(0)] >= MIN_SNR)


def _blobs(best: Constellation | None, peaks: dict[int, Peaks]) -> tuple[Blob, ...]:
    """The dock's markers, then the strongest peaks of the finest scale."""
    finest = min(peaks)
    radius = finest / 2
    others = peaks[finest].xy
    mine: list[Blob] = []
    if best is not None:
        mine = [Blob(x, y, radius, True) for x, y in best.xy.tolist()]
        apart = np.linalg.norm(others[:, None] - best.xy, axis=2).min(axis=1)
        others = others[apart > 2 * finest]
    rest = others[: MAX_BLOBS - len(mine)].tolist()
    return tuple(mine + [Blob(x, y, radius, False) for x, y in rest])
