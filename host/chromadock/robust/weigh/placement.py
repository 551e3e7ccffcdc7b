"""How likely markers are to stand where they were measured, if they are the dock's.

The density of the places, integrated over all poses of the dock by Laplace's method: about each
pose that the markers leave open, the reprojection errors are a quadratic form of the pose's, and
the integral of a normal density is known (MacKay, Information Theory, Inference, and Learning
Algorithms, 2003, chapter 27).  No threshold is asked of the reprojection error: a poor fit is
less likely, and that is all.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.geometry.many import normal_equations
from chromadock.geometry.pose import Estimate, Sighting
from chromadock.lens import Lens

Real = NDArray[np.float64]

MISFITS = np.array([0.0, 0.001, 0.002, 0.004, 0.008])
"""Errors that all markers of a frame share in kind, of the dock's extent in the picture: a file
that is some per cent off, a lens that the calibration describes badly, a rolling or interlaced
shutter on a moving vehicle.  Of a thousand right sets, those of a real dock among them, none needs
more than 0.004; with twice the last of these, sets with another lamp for a marker fit too."""

_SELDOM = 0.5 ** np.arange(len(MISFITS))
LOG_SHARES = np.log(_SELDOM / _SELDOM.sum())
"""(M,) log probability of each, half that of the one before."""


@dataclass(frozen=True, eq=False)
class PosePrior:
    """What is known of a dock's pose before the frame is seen.

    Its bearing is anywhere in the picture, its range anywhere on a logarithmic scale that spans
    ``log_ranges`` e-foldings; its attitude is normal about ``R_expected`` (3, 3), with the
    covariance ``R_covariance`` (3, 3), radians squared, of turns about the camera's axes.
    """

    focal_px: float
    area_px: float
    log_ranges: float
    R_expected: Real
    R_covariance: Real

    @cached_property
    def R_information(self) -> Real:
        """(3, 3): the inverse of the covariance."""
        return np.asarray(np.linalg.inv(self.R_covariance))

    @cached_property
    def _most(self) -> float:
        """Log density of the expected attitude where a square pixel and e-folding of range have a
        volume of 1 / f^2 behind them."""
        place = 2 * math.log(self.focal_px) - math.log(self.area_px * self.log_ranges)
        return place - 0.5 * float(np.linalg.slogdet(2 * np.pi * self.R_covariance)[1])

    def log_density(self, R: Real, t: Real, optics: Lens) -> float:
        """Of a pose before that lens, a cubic metre and cubic radian."""
        turn = cv2.Rodrigues(R @ self.R_expected.T)[0].ravel()
        square = float(turn @ self.R_information @ turn)
        return self._most - float(optics.log_volume(t)) - 0.5 * square


@dataclass(frozen=True, eq=False, slots=True)
class Placement:
    """``log_density`` of the places, a square pixel each; ``weights`` (P,): of the poses, which sum
    to 1.  ``variances`` (M, N): squares of the places' errors with what they may share, and
    ``shares`` (M,): how likely each of these turned out to be."""

    log_density: float
    weights: Real
    variances: Real
    shares: Real

    @property
    def sigma_px(self) -> Real:
        """(N,): the places' errors, with what they turned out to share."""
        return np.asarray(np.sqrt(self.shares @ self.variances))

    def errors(self, count: int) -> Real:
        """(count, N): errors that the places may have, of each kind as many as it is likely."""
        quantiles = (np.arange(count) + 0.5) / count
        kind = np.searchsorted(self.shares.cumsum(), quantiles)
        return np.asarray(np.sqrt(self.variances[np.minimum(kind, len(self.shares) - 1)]))

    def weighed(self, log_density: Real) -> Placement:
        """The same with what something else says of the poses: (P,) natural logarithms."""
        weights = self.weights * np.exp(log_density - log_density.max())
        return replace(self, weights=weights / weights.sum())


def placement(sighting: Sighting, poses: tuple[Estimate, ...], prior: PosePrior) -> Placement:
    """Of markers that leave ``poses`` open, one or more."""
    extent = float(np.linalg.norm(np.ptp(sighting.pixels, axis=0)))
    variances = sighting.sigma_px**2 + (MISFITS[:, None] * extent) ** 2
    logs = np.array([_of_pose(sighting, pose, prior, np.sqrt(variances)) for pose in poses])
    logs += LOG_SHARES - np.log(2 * np.pi * variances).sum(axis=1)
    by_misfit = np.logaddexp.reduce(logs, axis=0)
    shares = np.exp(by_misfit - np.logaddexp.reduce(by_misfit))
    by_pose = np.logaddexp.reduce(logs, axis=1)
    weights = np.exp(by_pose - np.logaddexp.reduce(by_pose))
    return Placement(float(np.logaddexp.reduce(by_misfit)), weights, variances, shares)


def _of_pose(sighting: Sighting, pose: Estimate, prior: PosePrior, sigma_px: Real) -> Real:
    """(M,) log density of the places about one pose, for (M, N) errors of theirs, but for the
    factor that the normal density has of these alone."""
    count, optics = len(sigma_px), sighting.camera.optics
    R, t = np.broadcast_to(pose.R, (count, 3, 3)), np.broadcast_to(pose.t, (count, 3))
    known, _, chi_square, seen = normal_equations(sighting, R, t, sigma_px)
    if not (seen[0] and optics.sees(pose.t)):
        return np.full(count, -np.inf)
    known[:, 3:, 3:] += prior.R_information
    known[:, :3, :3] += np.eye(3) / float(optics.depth(pose.t)) ** 2
    volume = 3 * np.log(2 * np.pi) - 0.5 * np.linalg.slogdet(known)[1]
    return np.asarray(volume - 0.5 * chi_square + prior.log_density(pose.R, pose.t, optics))
