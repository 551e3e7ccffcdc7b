"""The robust detector from the frame to the pose."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.look import Found, Look
from chromadock.results.detection import Blob, Misfit
from chromadock.robust.find.measure import Measure
from chromadock.robust.find.view import View, upright
from chromadock.robust.frame.native import lib, pointer
from chromadock.robust.frame.overexposure import clipped_at, stops_over
from chromadock.robust.frame.peaks import Peaks, find_peaks
from chromadock.robust.frame.received import received_hue
from chromadock.robust.frame.response import MIN_SIDE, Response, respond
from chromadock.robust.weigh.acceptance import HOPEFUL, HOPEFUL_DARK, MOST_DOUBT, Constellation
from chromadock.stopwatch import Stopwatch

MAX_BLOBS = 16
"""Peaks that are reported."""


@dataclass(frozen=True, eq=False, slots=True)
class Seen:
    """``peaks`` of one sense, the dock among them, and what stood like it but does not fit."""

    peaks: dict[int, Peaks]
    best: Constellation | None
    misfit: Misfit | None


class RobustMethod:
    """Matched filters, peaks, constellations by likelihood ratio, both poses."""

    def __init__(self, dock: DockGeometry) -> None:
        self._dock = dock
        # Wherever the dock frame has its origin: about the centroid the pose is best known.
        self._points = dock.points - dock.centre
        self._view: View | None = None
        self._shape = (0, 0)
        self._response: Response | None = None

    @property
    def mask(self) -> NDArray[np.uint8]:
        """(H, W): the pixels of the last frame that stand out in the markers' colour."""
        if self._response is None:
            return np.zeros(self._shape, np.uint8)
        cells, _ = _standing_out(self._response)
        size = self._shape[::-1]
        return np.asarray(cv2.resize(cells, size, interpolation=cv2.INTER_NEAREST), np.uint8)

    def find(self, look: Look, watch: Stopwatch) -> Found:
        """Look for the dock in one frame; nothing less than all markers where no prior is."""
        frame_bgr = look.frame_bgr
        self._shape, self._response = frame_bgr.shape[:2], None
        if min(self._shape) < MIN_SIDE:
            return Found("not_found", 0.0)
        view = self._view_of(look.camera)
        response = respond(frame_bgr, look.hue, view.focal_px, preferred=look.colour == "hue")
        self._response = response
        watch.lap("response")
        seen = self._seen(look, view, response, watch)
        peaks = seen.peaks
        if response.dark is not None and not self._whole(seen.best):
            # Where lamps are not to be seen their holders may be.
            dark = self._seen(look, view, response.dark, watch)
            if dark.best is not None and _evidence(dark.best) > _evidence(seen.best):
                seen, response = dark, response.dark
        cells, count = _standing_out(self._response)
        found = self._report(frame_bgr, seen.best, peaks, response, count / cells.size)
        return found if seen.misfit is None else replace(found, misfit=seen.misfit)

    def _seen(self, look: Look, view: View, response: Response, watch: Stopwatch) -> Seen:
        """What of a frame stands out, and what of that is the dock."""
        peaks = find_peaks(response)
        watch.lap("peaks")
        turn = upright(look.R_expected)
        searched, candidates = {}, []
        if look.everywhere:
            searched = view.searched(peaks, turn)
            least = HOPEFUL if response.sense > 0 else HOPEFUL_DARK
            by_scale = (view.candidates(cell, among, least) for cell, among in searched.items())
            candidates = sorted((c for found in by_scale for c in found), key=lambda c: -c.evidence)
        watch.lap("search")
        prior = view.prior(look.R_expected, look.R_covariance)
        dock = self._dock
        farthest, judged = dock.largest_range_m or np.inf, dock.judged - dock.centre
        measure = Measure(look.frame_bgr, response, view, prior, turn, farthest, judged)
        best = measure.best(candidates)
        if best is None and look.incomplete and response.sense > 0:
            best = measure.incomplete(searched)
        if best is None:
            priors = tuple(prior.about(dock.centre) for prior in look.priors)
            best = measure.about(priors, peaks)
        watch.lap("pose")
        if best is not None:
            return Seen(peaks, best, best.misfit)
        return Seen(peaks, None, max(measure.misfits, key=lambda m: m.evidence, default=None))

    def _whole(self, best: Constellation | None) -> bool:
        """Whether all markers of the dock were found."""
        return best is not None and len(best.markers) == len(self._points)

    def _view_of(self, camera: CameraModel) -> View:
        if self._view is None or not self._view.is_of(camera):
            self._view = View(self._points, camera)
        return self._view

    def _report(
        self,
        frame_bgr: NDArray[np.uint8],
        best: Constellation | None,
        peaks: dict[int, Peaks],
        response: Response,
        passed: float,
    ) -> Found:
        blobs = _blobs(best, peaks)
        if best is None:
            return Found("not_found", passed, blobs)
        names, lit = self._dock.names, response.sense > 0
        places = zip(best.markers.tolist(), best.xy.tolist(), strict=True)
        sure = best.doubt <= MOST_DOUBT
        whole = "found" if len(best.markers) == len(names) else "partial"
        poses = tuple(pose.about(-self._dock.centre) for pose in best.poses)
        alternative = poses[1].pose() if len(poses) > 1 else None
        return Found(
            state=whole if sure else "uncertain",
            passed_fraction=passed,
            blobs=blobs,
            markers={names[marker]: (x, y) for marker, (x, y) in places},
            pose=poses[0].pose(alternative) if sure else None,
            estimates=poses,
            evidence=best.evidence / float(np.log(10)),
            hue=received_hue(response, best.xy) if lit else None,
            clipped=float(clipped_at(frame_bgr, best.xy).mean()) if lit else None,
            stops_over=stops_over(frame_bgr, best.xy) if lit else None,
            sigma_px=tuple(best.sigma_px.tolist()),
            smaller=best.smaller,
        )


def _evidence(best: Constellation | None) -> float:
    """Natural log of the likelihood ratio; of nothing the least."""
    return -np.inf if best is None else best.evidence


def _standing_out(response: Response) -> tuple[NDArray[np.uint8], int]:
    """Which cells of the finest scale that shows all hues have the least signal to noise of a peak:
    (rows, columns) of 0 and 1; and how many."""
    scale = 1
    cells = np.empty(response.layout.shapes[scale], np.uint8)
    return cells, lib.front_standing_out(response.native, scale, pointer(cells))


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
