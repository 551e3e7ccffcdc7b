"""How surely three markers tell where the dock is.

Three places fit up to four poses exactly.  Near by, where the camera is about as far off as the
markers from each other, two of these are often about to become one (the dangerous cylinder:
Thompson, Photogrammetric Record 5 (1966) 201): the places hardly change from one to the other, and
a normal error about either says nothing of how far off the truth may be.  So the places are moved
by errors as they may have, again and again, and all poses found that fit exactly: a sample of what
may be true.  Each counts by its prior density, over the volume of places that a small volume of
poses about it becomes, and by the brightness of the markers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.many import normal_equations, rotation_vectors
from chromadock.geometry.pose import MIN_MARKERS, Estimate, Sighting
from chromadock.geometry.starts import Flat, Start
from chromadock.robust.frame.flux import Fluxes
from chromadock.robust.weigh.acceptance import PLACE_TOLERANCE
from chromadock.robust.weigh.nearness import log_nearness
from chromadock.robust.weigh.placement import PosePrior

Real = NDArray[np.float64]

SAMPLES = 128
"""Of the places: a doubt of a tenth is known to 0.03."""

ENOUGH = 20.0
"""Poses that count, about one that is told, from which on they tell its covariance: it has 21
numbers."""


@dataclass(frozen=True, eq=False, slots=True)
class Sample:
    """Poses ``R`` (M, 3, 3) and ``t`` (M, 3), metres, of markers ``points_dock`` (3, 3) that may be
    true; ``weights`` (M,): how likely each is, which sum to 1."""

    points_dock: Real
    R: Real
    t: Real
    weights: Real

    def doubt(self, told: Estimate, judged: Real) -> float:
        """Probability that the point ``judged`` (3,), metres, dock frame, is not where ``told``
        has it, to ``PLACE_TOLERANCE`` of its range."""
        there = told.t + told.R @ judged
        off = np.linalg.norm(self.t + self.R @ judged - there, axis=1)
        return float(self.weights @ (off > PLACE_TOLERANCE * np.linalg.norm(there)))

    def known(self, poses: tuple[Estimate, ...]) -> tuple[Estimate, ...]:
        """Poses with the second moments of the sample about each as their covariances.

        A pose of the sample is counted with the one that has the markers nearest to where it has
        them.  About which too few are, that keeps the information that it has.
        """
        markers = self.points_dock @ self.R.transpose(0, 2, 1) + self.t[:, None]
        own = np.array([self.points_dock @ pose.R.T + pose.t for pose in poses])
        nearest = ((markers[:, None] - own) ** 2).sum(axis=(2, 3)).argmin(axis=1)
        return tuple(self._about(pose, nearest == k) for k, pose in enumerate(poses))

    def _about(self, pose: Estimate, which: NDArray[np.bool_]) -> Estimate:
        """A pose with the information of those ``which`` (M,) are counted with it."""
        weights = self.weights * which
        if weights.sum() ** 2 <= ENOUGH * (weights**2).sum():
            return pose
        off = np.hstack([self.t - pose.t, rotation_vectors(self.R @ pose.R.T)])
        covariance = (weights / weights.sum() * off.T) @ off
        return replace(pose, information=np.asarray(np.linalg.inv(covariance)))


def sampled(
    sighting: Sighting, sigma_px: Real, prior: PosePrior, fluxes: Fluxes | None
) -> Sample | None:
    """What may be true of three markers.

    Parameters
    ----------
    sigma_px : (SAMPLES, 3) standard deviations of the places, pixels: each row as likely as another
        to be theirs.
    fluxes : of the markers; None where they are not known.

    Returns
    -------
    None where no places have a pose that the lens sees.
    """
    optics = sighting.camera.optics
    R, t = _fitting(sighting, sigma_px)
    information, _, _, seen = normal_equations(sighting, R, t, np.ones(MIN_MARKERS))
    seen &= optics.sees(t)
    if not seen.any():
        return None
    R, t, information = R[seen], t[seen], information[seen]
    turn = rotation_vectors(R @ prior.R_expected.T)
    log_weights = -0.5 * np.einsum("mi,ij,mj->m", turn, prior.R_information, turn)
    log_weights -= optics.log_volume(t) + 0.5 * np.linalg.slogdet(information)[1]
    log_weights += log_nearness(fluxes, sighting.points_dock, R, t)
    weights = np.exp(log_weights - log_weights.max())
    return Sample(sighting.points_dock, R, t, weights / weights.sum())


def _fitting(sighting: Sighting, sigma_px: Real) -> tuple[Real, Real]:
    """(M, 3, 3) and (M, 3): all poses that fit moved places exactly."""
    centre = sighting.points_dock.mean(axis=0)
    points = sighting.points_dock - centre
    found: list[Start] = []
    for places in sighting.pixels + sigma_px[:, :, None] * _errors():
        flat = Flat.of(sighting.camera, places)
        if flat is not None:
            _, rotations, translations = cv2.solveP3P(
                points, flat.places, np.eye(3), None, flags=cv2.SOLVEPNP_AP3P
            )
            found += flat.poses(rotations, translations)
    R = np.array([pose for pose, _ in found]).reshape(-1, 3, 3)
    t = np.array([place for _, place in found]).reshape(-1, 3)
    return R, t - R @ centre


@cache
def _errors() -> Real:
    """(SAMPLES, 3, 2) standard normal numbers, always the same ones; each has its negative beside
    it, so that their mean is zero."""
    half = np.random.default_rng(1).standard_normal((SAMPLES // 2, MIN_MARKERS, 2))
    return np.stack([half, -half], axis=1).reshape(SAMPLES, MIN_MARKERS, 2)
