"""The dock's pose from its markers' pixels."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock._native import ffi, lib
from chromadock.camera import CameraModel
from chromadock.geometry.starts import Flat, solutions, starts_of_three, tilted_back
from chromadock.native import doubles
from chromadock.results.pose import Pose
from chromadock.rotation import quaternion_from_matrix

MIN_MARKERS = 3
"""Fewer give no pose."""

_EXCLUDED = 20.0  # chi-square: a pose that fits by so much worse is not open; e^10 to one
_SAME_MINIMUM = 0.25  # squared standard deviations, between two that are one
_LEAST_KNOWN = 1e-14  # of what is known best: less is lost in rounding


def epnp(
    points_dock: NDArray[np.float64], pixels: NDArray[np.float64], camera: CameraModel
) -> Pose | None:
    """``T_camera_dock`` by EPnP (Lepetit, Moreno-Noguer, Fua, IJCV 2009).

    Parameters
    ----------
    points_dock : (N, 3) float64, metres, dock frame; N >= 4.
    pixels : (N, 2) float64, the same markers in the image.

    Returns
    -------
    The pose, or None where there is none that the camera sees whole.
    """
    flat = Flat.of(camera, pixels)
    if flat is None:
        return None
    solved, rotation, translation = cv2.solvePnP(
        points_dock, flat.places, np.eye(3), None, flags=cv2.SOLVEPNP_EPNP
    )
    found = next(flat.poses([rotation], [translation]), None)
    if not solved or found is None:
        return None
    R, t = found
    points_camera = points_dock @ R.T + t
    if not camera.optics.sees(points_camera).all():
        return None
    error = camera.project(points_camera) - pixels
    x, y, z = t.tolist()
    return Pose(
        t=(x, y, z),
        q_wxyz=quaternion_from_matrix(R),
        reprojection_px=float(np.sqrt((error**2).sum(axis=1).mean())),
    )


@dataclass(frozen=True, eq=False, slots=True)
class Estimate:
    """A pose that fits better than all nearby, and how sure it is.

    ``R`` (3, 3) and ``t`` (3,), metres, are ``T_camera_dock``.  ``chi_square``: the sum of
    squared errors in their standard deviations.  ``reprojection_px``: root mean square distance
    of the reprojected markers from the measured ones.  ``information`` (6, 6): the inverse of
    the covariance of x, y, z, metres, and of small turns about the camera's x, y and z axes
    through the dock's origin, radians.
    """

    R: NDArray[np.float64]
    t: NDArray[np.float64]
    chi_square: float
    reprojection_px: float
    information: NDArray[np.float64]

    @property
    def covariance(self) -> NDArray[np.float64]:
        """(6, 6) float64, the inverse of ``information``; what is unknown has a large variance."""
        known, axes = np.linalg.eigh(self.information)
        known = np.maximum(known, _LEAST_KNOWN * known[-1])
        return np.asarray(axes / known @ axes.T)

    def distance(self, R: NDArray[np.float64], t: NDArray[np.float64]) -> float:
        """Mahalanobis distance squared of another pose; below 12.6 for 95% of true poses."""
        turn = cv2.Rodrigues(R @ self.R.T)[0].ravel()
        off = np.concatenate([t - self.t, turn])
        return float(off @ self.information @ off)

    def about(self, origin: NDArray[np.float64]) -> Estimate:
        """The same pose of a dock frame with its origin at ``origin`` (3,), metres, dock frame."""
        arm = self.R @ origin
        back = lever(-arm)
        return replace(self, t=self.t + arm, information=back.T @ self.information @ back)

    def drawn(self, smaller: float) -> Estimate:
        """The same pose with one more error: the dock may look smaller than it is by a share of its
        size, one standard error, and then is nearer by that share.  ``t`` has to be the place of
        the markers' centroid, about which they are drawn together."""
        off = np.concatenate([smaller * self.t, np.zeros(3)])
        # The inverse of a sum: Sherman and Morrison.
        told = self.information @ off
        information = self.information - np.outer(told, told) / (1 + off @ told)
        return replace(self, information=information)

    def pose(self, alternative: Pose | None = None) -> Pose:
        """The same for a ``Detection``."""
        x, y, z = self.t.tolist()
        return Pose(
            (x, y, z),
            quaternion_from_matrix(self.R),
            self.reprojection_px,
            alternative,
            tuple(self.covariance.ravel().tolist()),
        )


@dataclass(frozen=True, eq=False)
class Sighting:
    """Markers and where they were seen.

    ``points_dock`` (N, 3) float64, metres; ``pixels`` (N, 2) float64; ``sigma_px`` (N,) float64:
    standard deviation of each pixel, in x as in y; N >= 3.
    """

    points_dock: NDArray[np.float64]
    pixels: NDArray[np.float64]
    sigma_px: NDArray[np.float64]
    camera: CameraModel

    @property
    def native(self) -> Any:
        """All but the errors, as C has it."""
        return self._kept[0]

    @cached_property
    def _kept(self) -> tuple[Any, ...]:
        # C's pointers keep nothing alive.
        arrays = doubles(self.points_dock), doubles(self.pixels)
        given = (self.camera.optics.native, len(self.pixels), *arrays)
        return ffi.new("poses_sighting_t *", given), *arrays


def estimates(sighting: Sighting) -> tuple[Estimate, ...]:
    """All poses that the markers leave open, the better first.

    From afar a plane that is tilted one way looks as if it were tilted the other way
    (Schweighofer and Pinz, PAMI 28 (2006) 2024): where each of the two is a minimum of the
    reprojection error both are returned, and only motion or other sensors can tell.  Three
    markers fit up to four poses exactly (Gao et al., PAMI 25 (2003) 930): no error ranks
    them, and that comes first which turns the dock's face most squarely to the camera.

    It is the same wherever the dock frame has its origin: the markers' centroid is the origin
    meanwhile.

    Returns
    -------
    None, one or two estimates, of three markers up to four; all markers where the lens sees.
    """
    flat = Flat.of(sighting.camera, sighting.pixels)
    if flat is None:
        return ()
    centre = sighting.points_dock.mean(axis=0)
    points = sighting.points_dock - centre

    def downhill(R: NDArray[np.float64], place: NDArray[np.float64]) -> Estimate | None:
        return refined(sighting, R, place - R @ centre)

    if len(points) == MIN_MARKERS:
        return _of_three(downhill(*start) for start in starts_of_three(points, flat))
    _, spread, axes = np.linalg.svd(points, full_matrices=False)
    fits = (downhill(*start) for start in solutions(points, flat, spread))
    first = next(filter(None, fits), None)
    if first is None:
        return ()
    place = first.t + first.R @ centre
    second = downhill(tilted_back(first.R, place, normal=axes[2]), place)
    if second is None or same_minimum(second, first):
        return (first,)
    better, worse = sorted((first, second), key=lambda estimate: estimate.chi_square)
    return (better,) if worse.chi_square > better.chi_square + _EXCLUDED else (better, worse)


def _of_three(fits: Iterable[Estimate | None]) -> tuple[Estimate, ...]:
    """All poses of three markers among minima, the least turned first."""
    found: list[Estimate] = []
    for pose in fits:
        if pose is None or pose.chi_square > _EXCLUDED:
            continue
        if not any(same_minimum(pose, other) for other in found):
            found.append(pose)
    return tuple(sorted(found, key=lambda pose: -float(np.trace(pose.R))))


def refined(sighting: Sighting, R: NDArray[np.float64], t: NDArray[np.float64]) -> Estimate | None:
    """The minimum of chi-square downhill of a pose: see ``poses_refine`` in ``host/native``.

    None where a marker would be out of view, none is reached in so many rounds (the way there
    leads through poses that hardly fit), or it has a marker in the lens or all in one point.
    """
    R, t = np.array(R, np.float64, order="C"), np.array(t, np.float64)
    information, fit = np.empty((6, 6)), ffi.new("poses_fit_t *")
    arrays = map(doubles, (sighting.sigma_px, R, t, information))
    if not lib.poses_refine(sighting.native, *arrays, fit):
        return None
    return Estimate(R, t, fit.chi_square, fit.reprojection_px, information)


def lever(arm: NDArray[np.float64]) -> NDArray[np.float64]:
    """(6, 6): what errors of a pose (place, small turns about the camera's axes) do to the pose of
    the same body at a point ``arm`` (3,), metres, camera axes, from its origin."""
    x, y, z = arm
    J = np.eye(6)
    J[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]  # turn x arm
    return J


def same_minimum(a: Estimate, b: Estimate) -> bool:
    """Whether two minima are one, up to where their searches ended: along the flat valley of a
    pose that is hardly known these stop some way apart, within half a standard deviation."""
    return a.distance(b.R, b.t) < _SAME_MINIMUM and b.distance(a.R, a.t) < _SAME_MINIMUM


def projected(
    points_dock: NDArray[np.float64],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    camera: CameraModel,
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Pixels (N, 2) of markers at a pose, and their derivatives (N, 2, 6).

    The derivatives are by x, y, z and by turns about the camera's axes, as in ``Estimate``.
    None where a marker is out of the lens's view: of a pinhole behind the camera.
    """
    count = len(points_dock)
    pixels, jacobian = np.empty((count, 2)), np.empty((count, 2, 6))
    arrays = map(doubles, (points_dock, R, t, pixels, jacobian))
    seen = lib.poses_project(camera.optics.native, count, *arrays)
    return (pixels, jacobian) if seen else None
