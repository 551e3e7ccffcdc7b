"""The dock's pose from its markers' pixels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock._native import lib
from chromadock.camera import CameraModel
from chromadock.geometry.native import doubles
from chromadock.results.pose import Pose
from chromadock.rotation import quaternion_from_matrix

MIN_MARKERS = 3
"""Fewer give no pose."""

_MAX_ROUNDS = 100  # most take five; along the flat valley of a far plane it is slow
# A round that takes less than this off chi-square moves the pose by a thirtieth of its error.
_CONVERGED = 1e-3
_LEAST_DAMPING, _FIRST_DAMPING, _MOST_DAMPING = 1e-9, 1e-3, 1e6
_EXCLUDED = 20.0  # chi-square: a pose that fits by so much worse is not open; e^10 to one
_SAME_ROTATION = 1e-3  # radians, between two minima that are one
_LEAST_KNOWN = 1e-14  # of what is known best: less is lost in rounding
# Markers' depths (see ``Lens``), in widths of the dock: nearer one is in the lens, farther the dock
# is a point, and a search that came there ran away.
_NEAREST, _FARTHEST = 1e-3, 1e4
_PLANAR = 1e-6  # thickness over width of a set of points
_NEAR_AXIS = 0.5  # cosine: a flat picture stretches what is farther from its middle


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
    flat = _Flat.of(camera, pixels)
    if flat is None:
        return None
    solved, rotation, translation = cv2.solvePnP(
        points_dock, flat.places, np.eye(3), None, flags=cv2.SOLVEPNP_EPNP
    )
    found = flat.poses([rotation], [translation])
    if not solved or not found:
        return None
    [(R, t)] = found
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


@dataclass(frozen=True, eq=False, slots=True)
class Sighting:
    """Markers and where they were seen.

    ``points_dock`` (N, 3) float64, metres; ``pixels`` (N, 2) float64; ``sigma_px`` (N,) float64:
    standard deviation of each pixel, in x as in y; N >= 3.
    """

    points_dock: NDArray[np.float64]
    pixels: NDArray[np.float64]
    sigma_px: NDArray[np.float64]
    camera: CameraModel

    def about(self, origin: NDArray[np.float64]) -> Sighting:
        """The same in a dock frame with its origin at ``origin`` (3,), metres, dock frame."""
        return replace(self, points_dock=self.points_dock - origin)

    def errors(
        self, R: NDArray[np.float64], t: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        """Reprojection errors (2N,) of a pose (3, 3), (3,) in standard deviations, and their
        derivatives (2N, 6) as those of ``projected``; None where a marker is out of its view."""
        seen = projected(self.points_dock, R, t, self.camera)
        if seen is None:
            return None
        pixels, derivatives = seen
        error = (pixels - self.pixels) / self.sigma_px[:, None]
        jacobian = derivatives / self.sigma_px[:, None, None]
        return error.ravel(), jacobian.reshape(-1, 6)


def estimates(sighting: Sighting) -> tuple[Estimate, ...]:
    """All poses that the markers leave open, the better first.

    From afar a plane that is tilted one way looks as if it were tilted the other way
    (Schweighofer and Pinz, PAMI 28 (2006) 2024): where each of the two is a minimum of the
    reprojection error both are returned, and only motion or other sensors can tell.  Three
    markers fit up to four poses exactly (Gao et al., PAMI 25 (2003) 930): no error ranks
    them, and that comes first which turns the dock's face most squarely to the camera.

    It is the same wherever the dock frame has its origin: the markers' centroid is the origin
    meanwhile, about which places and turns are about independent.

    Returns
    -------
    None, one or two estimates, of three markers up to four; all markers where the lens sees.
    """
    centre = sighting.points_dock.mean(axis=0)
    return tuple(pose.about(-centre) for pose in _estimates(sighting.about(centre)))


def _estimates(sighting: Sighting) -> tuple[Estimate, ...]:
    """The same of markers about the origin."""
    if len(sighting.pixels) == 3:
        return _of_three(sighting)
    starts = filter(None, (guess(sighting) for guess in (_first_guess, _face_on)))
    first = next(filter(None, (_refined(sighting, *start) for start in starts)), None)
    if first is None:
        return ()
    second = _refined(sighting, _tilted_back(first, sighting.points_dock), first.t)
    if second is None or same_rotation(second.R, first.R):
        return (first,)
    better, worse = sorted((first, second), key=lambda estimate: estimate.chi_square)
    return (better,) if worse.chi_square > better.chi_square + _EXCLUDED else (better, worse)


def refined(sighting: Sighting, R: NDArray[np.float64], t: NDArray[np.float64]) -> Estimate | None:
    """The minimum of chi-square downhill of a pose, by Levenberg and Marquardt's method.

    Searched about the markers' centroid, so that the origin of the dock frame does not matter.
    None where a marker would be out of view, none is reached in so many rounds (the way there
    leads through poses that hardly fit), or it has a marker in the lens or all in one point.
    """
    centre = sighting.points_dock.mean(axis=0)
    pose = _refined(sighting.about(centre), R, t + R @ centre)
    return None if pose is None else pose.about(-centre)


def _refined(sighting: Sighting, R: NDArray[np.float64], t: NDArray[np.float64]) -> Estimate | None:
    """The same of markers about the origin."""
    damping = _FIRST_DAMPING
    now = _Fit.of(sighting, R, t)
    if now is None:
        return None
    for _ in range(_MAX_ROUNDS):
        after = _Fit.of(sighting, *now.stepped(damping))
        if after is not None and after.chi_square <= now.chi_square:
            gained = now.chi_square - after.chi_square
            now = after
            damping = max(damping / 10, _LEAST_DAMPING)
            if gained < _CONVERGED:
                break
        else:
            damping *= 10
            if damping > _MOST_DAMPING:
                break
    else:
        return None
    R, t = now.R, now.t
    depths = sighting.camera.optics.depth(sighting.points_dock @ R.T + t)
    width = np.ptp(sighting.points_dock, axis=0).max()
    if not (depths.min() > _NEAREST * width and depths.max() < _FARTHEST * width):
        return None
    off = now.error.reshape(-1, 2) * sighting.sigma_px[:, None]
    reprojection_px = math.sqrt((off**2).sum() / len(off))
    return Estimate(R, t, now.chi_square, reprojection_px, now.jacobian.T @ now.jacobian)


def lever(arm: NDArray[np.float64]) -> NDArray[np.float64]:
    """(6, 6): what errors of a pose (place, small turns about the camera's axes) do to the pose of
    the same body at a point ``arm`` (3,), metres, camera axes, from its origin."""
    x, y, z = arm
    J = np.eye(6)
    J[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]  # turn x arm
    return J


def same_rotation(a: NDArray[np.float64], b: NDArray[np.float64]) -> bool:
    """Whether two minima (3, 3) are one, up to where their search ended."""
    return bool(np.abs(a - b).max() < _SAME_ROTATION)


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
    arms = points_dock @ R.T
    if not camera.optics.sees(arms + t).all():
        return None
    return camera.optics.project_turned(arms, t)


@dataclass(frozen=True, eq=False, slots=True)
class _Fit:
    """Errors of a pose in their standard deviations (2N,), and their derivatives (2N, 6)."""

    R: NDArray[np.float64]
    t: NDArray[np.float64]
    error: NDArray[np.float64]
    jacobian: NDArray[np.float64]
    chi_square: float

    @classmethod
    def of(cls, sighting: Sighting, R: NDArray[np.float64], t: NDArray[np.float64]) -> _Fit | None:
        errors = sighting.errors(R, t)
        if errors is None:
            return None
        error, jacobian = errors
        return cls(R, t, error, jacobian, float(error @ error))

    def stepped(self, damping: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The pose after a step downhill: see ``host/native/poses.h``."""
        R, t = np.empty((3, 3)), np.empty(3)
        given = map(doubles, (self.R, self.t, R, t))
        errors = doubles(self.error), doubles(self.jacobian)
        lib.poses_step(len(self.error), *errors, damping, *given)
        return R, t


def _of_three(sighting: Sighting) -> tuple[Estimate, ...]:
    """All poses of three markers, the least turned first."""
    flat = _Flat.of(sighting.camera, sighting.pixels)
    if flat is None:
        return ()
    _, rotations, translations = cv2.solveP3P(
        sighting.points_dock, flat.places, np.eye(3), None, flags=cv2.SOLVEPNP_AP3P
    )
    starts = flat.poses(rotations, translations)
    # Of two poses close together noise may leave none that fits exactly, but one that fits well.
    starts += [(_matrix(np.zeros(3)), t) for _, t in starts]
    found: list[Estimate] = []
    for R, t in starts:
        pose = _refined(sighting, R, t)
        if pose is None or pose.chi_square > _EXCLUDED:
            continue
        if not any(same_rotation(pose.R, other.R) for other in found):
            found.append(pose)
    return tuple(sorted(found, key=lambda pose: -float(np.trace(pose.R))))


def _first_guess(
    sighting: Sighting,
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Some pose of four markers or more near one of the minima, without need of a start."""
    spread = np.linalg.svd(_centred(sighting.points_dock), compute_uv=False)
    planar = spread[2] < _PLANAR * spread[0]
    flat = _Flat.of(sighting.camera, sighting.pixels)
    if flat is None:
        return None
    _, rotations, translations, _ = cv2.solvePnPGeneric(
        sighting.points_dock,
        flat.places,
        np.eye(3),
        None,
        # SQPnP's guess for a dock with depth is now and then behind the camera.
        flags=cv2.SOLVEPNP_IPPE if planar else cv2.SOLVEPNP_EPNP,
    )
    return next(iter(flat.poses(rotations, translations)), None)


def _face_on(sighting: Sighting) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """The pose of a dock, its centroid the origin, that faces the camera: roll and size fit best.

    From there the way leads to the pose of markers that lie in a plane which is seen from its
    edge, where solvers for planes fail: of nearly straight lines, level with the camera.
    """
    flat = _Flat.of(sighting.camera, sighting.pixels)
    if flat is None:
        return None
    dock = _centred(sighting.points_dock)[:, :2] @ (1, 1j)
    seen = flat.places @ (1, 1j)
    middle = seen.mean()
    # Least squares: seen - middle = size * dock, the size a complex number that turns as well.
    size = np.vdot(dock, seen - middle) / max(np.vdot(dock, dock).real, 1e-12)
    if not abs(size) > 0:
        return None
    place = np.array([middle.real, middle.imag, 1.0]) / abs(size)
    roll = _matrix(np.array([0.0, 0.0, np.angle(size)]))
    return flat.R_camera_flat @ roll, flat.R_camera_flat @ place


@dataclass(frozen=True, eq=False, slots=True)
class _Flat:
    """Markers as a pinhole would see them, for solvers that know of no other camera.

    ``places`` (N, 2): normalised coordinates; ``R_camera_flat`` (3, 3): that pinhole's axes.
    """

    places: NDArray[np.float64]
    R_camera_flat: NDArray[np.float64]

    @classmethod
    def of(cls, camera: CameraModel, pixels: NDArray[np.float64]) -> _Flat | None:
        """With the camera's axes, unless a marker is far off its own: then it looks at them.

        None where no ray comes to one, or they are all around.
        """
        rays = camera.rays(pixels)
        if (rays[:, 2] > _NEAR_AXIS).all():
            return cls(camera.undistort(pixels), np.eye(3))
        ahead = rays.mean(axis=0)
        if not np.linalg.norm(ahead) > 0:  # NaN too
            return None
        z = ahead / np.linalg.norm(ahead)
        # Any turn will do; this one is never far from singular.
        x = np.cross(np.eye(3)[np.abs(z).argmin()], z)
        x /= np.linalg.norm(x)
        R = np.column_stack([x, np.cross(z, x), z])
        turned = rays @ R
        if not (turned[:, 2] > 0).all():
            return None
        return cls(turned[:, :2] / turned[:, 2:], R)

    def poses(
        self, rotations: Sequence[ArrayLike], translations: Sequence[ArrayLike]
    ) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Solutions as rotation vectors and places, those that are finite, in the camera's axes."""
        return [
            (self.R_camera_flat @ _matrix(r), self.R_camera_flat @ np.asarray(t, float).ravel())
            for r, t in zip(rotations, translations, strict=True)
            if np.isfinite(r).all() and np.isfinite(t).all()
        ]


def _tilted_back(estimate: Estimate, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rotation that shows a plane at the same places, tilted the other way.

    Mirrored in depth along the line of sight, and the plane in itself.
    """
    view = estimate.t / np.linalg.norm(estimate.t)
    normal = np.linalg.svd(_centred(points))[2][2]
    mirror = np.eye(3) - 2 * np.outer(view, view)
    return np.asarray(mirror @ estimate.R @ (np.eye(3) - 2 * np.outer(normal, normal)))


def _centred(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(points - points.mean(axis=0), np.float64)


def _matrix(rotation: ArrayLike) -> NDArray[np.float64]:
    """(3, 3) of a rotation vector."""
    return np.asarray(cv2.Rodrigues(np.asarray(rotation, np.float64))[0], np.float64)
