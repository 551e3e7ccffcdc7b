"""Which of the poses that markers leave open is told, and how much that is to be doubted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.pose import MIN_MARKERS, Estimate, Sighting, refined
from chromadock.geometry.profile import widened
from chromadock.robust.frame.flux import Fluxes
from chromadock.robust.weigh.acceptance import NO_DOUBT, doubt
from chromadock.robust.weigh.nearness import log_nearness
from chromadock.robust.weigh.placement import Placement, PosePrior
from chromadock.robust.weigh.three import SAMPLES, sampled
from chromadock.robust.weigh.tilts import doubt_over_tilts

Real = NDArray[np.float64]

SAME_ERROR = 0.05
"""Share by which markers' errors may grow and the poses stay as they are fitted."""


def told(
    sighting: Sighting,
    poses: tuple[Estimate, ...],
    placed: Placement,
    drift_px: Real,
    fluxes: Fluxes | None,
    prior: PosePrior,
    judged: Real,
) -> tuple[Sighting, tuple[Estimate, ...], float]:
    """The sighting with the errors that the markers turned out to have, the poses, the one to tell
    first, and the probability that this one has the dock at a wrong place.

    Parameters
    ----------
    placed : of these poses.
    drift_px : (n,) standard deviations of what may draw the markers aside.
    fluxes : of the markers, None where they are not known.
    judged : (3,) metres, in the sighting's dock frame: the point whose place is asked for.
    """
    bright = placed.weighed(_log_nearness(fluxes, sighting, poses))
    seen, poses, weights = fitted_again(sighting, poses, bright, drift_px)
    poses = tuple(widened(seen, pose) for pose in poses)
    roughly = doubt([pose.about(judged) for pose in poses], weights.tolist())
    if roughly < NO_DOUBT:
        return seen, poses, roughly
    if len(seen.pixels) > MIN_MARKERS:
        finely = doubt_over_tilts(seen, poses[0], prior, judged, fluxes)
        return seen, poses, roughly if finely is None else finely
    sample = sampled(seen, np.hypot(placed.errors(SAMPLES), drift_px), prior, fluxes)
    if sample is None:
        return seen, poses, roughly
    poses = sample.known(poses)
    doubts = [sample.doubt(pose, judged) for pose in poses]
    order = np.argsort(doubts, kind="stable").tolist()
    return seen, tuple(poses[k] for k in order), doubts[order[0]]


def fitted_again(
    sighting: Sighting, poses: tuple[Estimate, ...], placed: Placement, drift_px: Real
) -> tuple[Sighting, tuple[Estimate, ...], Real]:
    """The sighting with the errors that the markers turned out to have; poses fitted with these,
    the likeliest first, and their weights.

    What may draw a marker aside, by ``drift_px`` (n,), counts here and not in the evidence: that a
    place is not sure makes a pose less sure, but no dock of what would be none with sure places.
    """
    order = np.argsort(-placed.weights, kind="stable").tolist()
    poses, weights = tuple(poses[k] for k in order), placed.weights[order]
    sigma_px = np.hypot(placed.sigma_px, drift_px)
    if (np.abs(sigma_px / sighting.sigma_px - 1) <= SAME_ERROR).all():
        return sighting, poses, weights
    sighting = replace(sighting, sigma_px=sigma_px)
    again = tuple(refined(sighting, pose.R, pose.t) or pose for pose in poses)
    return sighting, again, weights


def _log_nearness(fluxes: Fluxes | None, sighting: Sighting, poses: tuple[Estimate, ...]) -> Real:
    R, t = np.array([pose.R for pose in poses]), np.array([pose.t for pose in poses])
    return log_nearness(fluxes, sighting.points_dock, R, t)
