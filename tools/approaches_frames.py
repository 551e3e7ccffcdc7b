"""What one frame of an approach comes to: the track's pose and the single frame's, judged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from limit import standing_out
from recall_trials import NEAR_PX, NEAR_SHARE, PLACE_SHARE

from chromadock import Detection
from chromadock.results.track import TrackedPose
from chromadock.rotation import matrix_from_quaternion
from chromadock.track.motion import turn_between
from chromadock.variety import Moment, Truth
from chromadock.variety.docks import ORIGINAL_WIDTH_M, matched

IN_95_PERCENT = {6: 12.59, 3: 7.81}
"""Chi-square, by degrees of freedom."""

SAME_SHARE = 0.01
"""Of the width: a marker that a turn puts within this of another has taken its place."""


@dataclass(frozen=True, slots=True)
class Seen:
    """One frame.

    Parameters
    ----------
    time_s, distance_m
        Since the first; z of a dock as wide as the original that looks as large.  NaN of none.
    shown
        Whether all markers are within the frame.
    state, error
        The track's, and how far its pose is off in shares of the range; None without a pose.
    covered
        Whether the truth is in the 95 % region of the track's pose or of its alternative.
    single, evidence, single_error
        The single frame's state, evidence in decades, and how far its pose is off.
    markers
        Where its markers are: ``right``, ``elsewhere``, or ``none``.
    standing_out
        Whether all markers stand out of the noise where they truly are; told only of frames that
        show them all and in which nothing was seen or tracked.
    """

    time_s: float
    distance_m: float
    shown: bool
    state: str
    error: float | None
    covered: bool | None
    single: str
    evidence: float | None
    single_error: float | None
    markers: str
    standing_out: bool | None = None

    @property
    def tracked(self) -> bool:
        """Whether the dock was measured just now."""
        return self.state == "tracking"

    @property
    def wrong(self) -> bool:
        """Whether the track has the dock elsewhere than it is."""
        return self.error is not None and not self.error <= PLACE_SHARE

    @property
    def single_wrong(self) -> bool:
        """Whether the single frame's pose is wrong."""
        return self.single_error is not None and not self.single_error <= PLACE_SHARE


def seen(moment: Moment, detection: Detection, width_m: float) -> Seen:
    """A frame and what the detector made of it; of no dock every pose is infinitely far off."""
    truth, track, pose = moment.truth, detection.track, detection.pose
    tracked = [] if track is None else [p for p in (track.pose, track.alternative) if p]
    shown = bool(len(truth.in_view)) and bool(truth.in_view.all())
    stands = None
    if shown and not detection.markers and (track is None or track.state != "tracking"):
        hue = detection.marker.hue_deg
        stands = standing_out(moment.frame_bgr, truth.camera, truth.pixels, hue)
    return Seen(
        time_s=moment.time_s,
        distance_m=float(truth.t[2]) * ORIGINAL_WIDTH_M / width_m,
        shown=shown,
        state="never_seen" if track is None else track.state,
        error=_error(tracked[0].t, truth) if tracked else None,
        covered=any(covers(p, truth) for p in tracked) if tracked and truth.dock else None,
        single=detection.state,
        evidence=detection.evidence,
        single_error=_error(pose.t, truth) if pose else None,
        markers=_markers(detection, truth),
        standing_out=stands,
    )


def covers(pose: TrackedPose, truth: Truth) -> bool:
    """Whether the truth is in a pose's 95 % region: its place alone where the dock is alike after
    a turn, for such a dock has several attitudes at once."""
    assert truth.dock is not None
    turn = turn_between(matrix_from_quaternion(pose.q_wxyz), truth.R)
    numbers = 3 if alike_after_a_turn(truth.dock.points) else 6
    off = np.concatenate([truth.t - pose.t, turn])[:numbers]
    covariance = np.reshape(pose.covariance, (6, 6))[:numbers, :numbers]
    return bool(off @ np.linalg.solve(covariance, off) <= IN_95_PERCENT[numbers])


def alike_after_a_turn(points: np.ndarray) -> bool:
    """Whether markers (N, 3) are where they were after a third of a turn or less about the dock's
    z axis.  Half a turn does not count: no vehicle swims upside down."""
    centred = points - points.mean(axis=0)
    most = SAME_SHARE * float(np.ptp(points, axis=0).max())
    for fold in range(3, 9):
        c, s = np.cos(2 * np.pi / fold), np.sin(2 * np.pi / fold)
        turned = centred @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        apart = np.linalg.norm(turned[:, None] - centred[None], axis=2)
        if (apart.min(axis=1) < most).all():
            return True
    return False


def _error(place: tuple[float, float, float], truth: Truth) -> float:
    if truth.dock is None:
        return float("inf")
    return float(np.linalg.norm(truth.t - place) / np.linalg.norm(truth.t))


def _markers(detection: Detection, truth: Truth) -> str:
    """All that were found count, be they all of the dock's or not."""
    if not detection.markers:
        return "none"
    if truth.dock is None:
        return "elsewhere"
    found = np.array(list(detection.markers.values()), np.float64)
    apart = np.linalg.norm(matched(found, truth.pixels) - found, axis=1)
    near = max(NEAR_PX, NEAR_SHARE * truth.camera.width)
    return "right" if float(apart.max()) < near else "elsewhere"
