"""Lens models: from rays to places in the picture and back, each with its derivatives.

The one place that knows them; ``CameraModel.optics`` is the lens of a camera.  ``plumb_bob`` and
``rational_polynomial`` are one formula of OpenCV's with more or fewer coefficients, about a
pinhole.  ``equidistant`` is that of ``cv2.fisheye`` (Kannala and Brandt, PAMI 28 (2006) 1335),
written here since OpenCV's own takes what is behind the camera for what is in front of it: the
angle to the optical axis is theta, and

    theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)

is the distance from the principal point in focal lengths.

An *ideal* place is where the same kind of lens without coefficients would have it, in focal
lengths: the tangent of the angle to the axis for a pinhole, the angle itself, radians, for
``equidistant``; a flat picture cannot hold a ray at 90 degrees and more.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

COUNTS: dict[str, tuple[int, ...]] = {
    "plumb_bob": (0, 4, 5),
    "rational_polynomial": (0, 8, 12, 14),
    "equidistant": (0, 4),
}
"""The lenses, by ROS's names, and how many coefficients each may have; none: an ideal one."""

PINHOLE_COUNTS = (0, 4, 5, 8, 12, 14)
"""Those that OpenCV's pinhole formula takes."""

_ZERO = np.zeros(3)
_PLACE_AND_TURN = np.array([3, 4, 5, 0, 1, 2])  # columns of OpenCV's derivatives
_LEAST_DEPTH_M = 1e-3  # of a point that has to have some place in a flat picture
# OpenCV's own default stops after five rounds, which leaves almost a pixel of error at
# the corners of a wide lens.
_CONVERGED = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, 1e-10)
_STEPS = 2048  # of the table that an inversion starts from
_NEWTON_ROUNDS = 4  # from there to the last bit
_ALL_AROUND = np.pi - 1e-6  # straight behind has no direction in the picture
_ON_AXIS = 1e-12
_NEARLY = 0.99  # of the way to a fold: there OpenCV's iterations no longer converge


@dataclass(frozen=True, slots=True)
class Fold:
    """The angle to the axis, radians, beyond which a lens formula goes back towards the middle,
    and how far out it comes, in focal lengths."""

    angle_rad: float
    reach: float


class Lens(Protocol):
    """What a camera needs of its lens.  Points are metres in the camera frame."""

    @property
    def fold(self) -> Fold | None:
        """Where the formula turns back; None where it never does."""

    def sees(self, points: Real) -> NDArray[np.bool_]:
        """(..., 3) points to (...): whether each has a place in the picture, however large."""

    def within_reach(self, points: Real) -> Real:
        """(..., 3) points, changed as little as gives each a place in the picture."""

    def project(self, points: Real) -> tuple[Real, Real]:
        """(N, 3) points that it sees to (N, 2) pixels, and their (N, 2, 3) derivatives."""

    def project_turned(self, arms: Real, t: Real) -> tuple[Real, Real]:
        """Points at (N, 3) ``arms`` from ``t`` (3,) that it sees, and their (N, 2, 6) derivatives:
        by ``t``, then by turns of the arms about the camera's axes, radians."""

    def rays(self, pixels: Real) -> Real:
        """(N, 2) pixels to (N, 3) unit rays; NaN where no ray comes to a pixel."""

    def ideal(self, pixels: Real) -> Real:
        """(N, 2) pixels to (N, 2) ideal places; finite and one for each pixel in any case."""

    def ideal_of(self, points: Real) -> Real:
        """(..., 3) points that it sees to (..., 2) ideal places."""

    def rays_of(self, ideal: Real) -> Real:
        """(N, 2) ideal places to (N, 3) unit rays."""

    def depth(self, points: Real) -> Real:
        """(..., 3) points to (...): what their size in the picture is in proportion to 1 / of."""

    def log_volume(self, points: Real) -> Real:
        """(..., 3) points to (...): log of the volume, cubic metres, there that a square ideal
        focal length sees in one e-folding of range."""


@dataclass(frozen=True, eq=False)
class PinholeLens:
    """OpenCV's formula: ``matrix`` (3, 3), ``coefficients`` (n,): k1 k2 p1 p2 [k3 [k4 k5 k6 ...]].

    Angles are below 90 degrees.
    """

    matrix: Real
    coefficients: Real

    @cached_property
    def fold(self) -> Fold | None:
        """By the radial part: r_d = r N / D, polynomials in u = r^2, rises until its derivative or
        D has a root, at which r_d is infinite."""
        k = np.zeros(8)
        k[: min(self.coefficients.size, 8)] = self.coefficients[:8]
        u = np.polynomial.Polynomial([0.0, 1.0])
        N, D = 1 + u * (k[0] + u * (k[1] + u * k[4])), 1 + u * (k[5] + u * (k[6] + u * k[7]))
        turn = _least_root((N + 2 * u * N.deriv()) * D - 2 * u * N * D.deriv())
        if not turn < _least_root(D):
            return None
        r = np.sqrt(turn)
        return Fold(float(np.arctan(r)), float(r * N(turn) / D(turn)))

    def sees(self, points: Real) -> NDArray[np.bool_]:
        """See ``Lens``."""
        in_front = points[..., 2] > 0
        if self.fold is None:
            return np.asarray(in_front)
        across = np.hypot(points[..., 0], points[..., 1])
        return np.asarray(in_front & (across < np.tan(self.fold.angle_rad) * points[..., 2]))

    def within_reach(self, points: Real) -> Real:
        """See ``Lens``."""
        near = np.array(points)
        np.maximum(near[..., 2], _LEAST_DEPTH_M, out=near[..., 2])
        return near

    def project(self, points: Real) -> tuple[Real, Real]:
        """See ``Lens``."""
        pixels, derivatives = cv2.projectPoints(
            points, _ZERO, _ZERO, self.matrix, self.coefficients
        )
        by_place = np.asarray(derivatives[:, 3:6], np.float64).reshape(-1, 2, 3)
        return np.asarray(pixels, np.float64).reshape(-1, 2), by_place

    def project_turned(self, arms: Real, t: Real) -> tuple[Real, Real]:
        """See ``Lens``: from a rotation of zero OpenCV's derivatives by it are by such turns."""
        pixels, derivatives = cv2.projectPoints(arms, _ZERO, t, self.matrix, self.coefficients)
        by_place_and_turn = np.asarray(derivatives, np.float64).take(_PLACE_AND_TURN, axis=1)
        return np.asarray(pixels, np.float64).reshape(-1, 2), by_place_and_turn.reshape(-1, 2, 6)

    def rays(self, pixels: Real) -> Real:
        """See ``Lens``."""
        rays = self.rays_of(self.ideal(pixels))
        rays[self._beyond(pixels) > 1] = np.nan
        return rays

    def ideal(self, pixels: Real) -> Real:
        """See ``Lens``: beyond the fold it goes on as from just before it."""
        if self.fold is None:
            return self._inverted(pixels)
        beyond = np.maximum(self._beyond(pixels), 1.0)[:, None]
        centre = self.matrix[:2, 2]
        return self._inverted((pixels - centre) / beyond + centre) * beyond

    def _beyond(self, pixels: Real) -> Real:
        """(N,) distance of (N, 2) pixels from the principal point, over that of the fold."""
        if self.fold is None:
            return np.zeros(len(pixels))
        off = (pixels - self.matrix[:2, 2]) / self.matrix[[0, 1], [0, 1]]
        return np.asarray(np.hypot(*off.T) / (_NEARLY * self.fold.reach))

    def _inverted(self, pixels: Real) -> Real:
        given = np.asarray(pixels, np.float64).reshape(-1, 1, 2)
        if not len(given):
            return np.empty((0, 2))
        if hasattr(cv2, "undistortPointsIter"):  # OpenCV 4; in 5 it became an argument
            places = cv2.undistortPointsIter(
                given, self.matrix, self.coefficients, None, None, _CONVERGED
            )
        else:
            places = cv2.undistortPoints(given, self.matrix, self.coefficients, criteria=_CONVERGED)
        return np.asarray(places, np.float64).reshape(-1, 2)

    def ideal_of(self, points: Real) -> Real:
        """See ``Lens``."""
        return np.asarray(points[..., :2] / points[..., 2:])

    def rays_of(self, ideal: Real) -> Real:
        """See ``Lens``."""
        rays = np.column_stack([ideal, np.ones(len(ideal))])
        return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))

    def depth(self, points: Real) -> Real:
        """See ``Lens``: the distance along the axis."""
        return np.asarray(points[..., 2])

    def log_volume(self, points: Real) -> Real:
        """See ``Lens``: z^3, for dx dy dz = z^2 du dv dz, and dz = z dlog z."""
        return np.asarray(3 * np.log(points[..., 2]))


@dataclass(frozen=True, eq=False)
class EquidistantLens:
    """``matrix`` (3, 3), ``coefficients`` (4,) k1 k2 k3 k4 or none; angles of up to 180 degrees."""

    matrix: Real
    coefficients: Real

    @cached_property
    def _series(self) -> tuple[float, float, float, float]:
        k1, k2, k3, k4 = self.coefficients.tolist() if self.coefficients.size else (0.0,) * 4
        return k1, k2, k3, k4

    @cached_property
    def fold(self) -> Fold | None:
        """Where theta_d, whose derivative is a polynomial in theta^2, turns back."""
        k1, k2, k3, k4 = self._series
        turn = _least_root(np.polynomial.Polynomial([1, 3 * k1, 5 * k2, 7 * k3, 9 * k4]))
        angle = float(np.sqrt(turn))
        return Fold(angle, float(self._bent(np.array(angle))[0])) if angle < _ALL_AROUND else None

    @cached_property
    def _most(self) -> float:
        """The widest angle to the axis, radians, that has a place in the picture."""
        return _ALL_AROUND if self.fold is None else self.fold.angle_rad

    @cached_property
    def _table(self) -> tuple[Real, Real]:
        angles = np.linspace(0.0, self._most, _STEPS + 1)
        return angles, self._bent(angles)[0]

    def _bent(self, angle: Real) -> tuple[Real, Real]:
        """theta_d of theta, and its derivative."""
        (k1, k2, k3, k4), u = self._series, angle * angle
        bent = angle * (1 + u * (k1 + u * (k2 + u * (k3 + u * k4))))
        return bent, 1 + u * (3 * k1 + u * (5 * k2 + u * (7 * k3 + u * 9 * k4)))

    def _straightened(self, bent: Real) -> Real:
        """The theta of a theta_d >= 0; beyond the fold both go on in step."""
        angles, places = self._table
        cell = np.clip(np.searchsorted(places, bent) - 1, 0, _STEPS - 1)
        angle = np.interp(bent, places, angles)
        for _ in range(_NEWTON_ROUNDS):
            value, slope = self._bent(angle)
            angle = angle - (value - bent) / np.maximum(slope, 1e-9)
            angle = np.clip(angle, angles[cell], angles[cell + 1])
        return np.asarray(np.where(bent > places[-1], angles[-1] + bent - places[-1], angle))

    def sees(self, points: Real) -> NDArray[np.bool_]:
        """See ``Lens``."""
        return np.asarray(_off_axis(points)[1] < self._most)

    def within_reach(self, points: Real) -> Real:
        """See ``Lens``: the formula has a place for every direction."""
        return points

    def project(self, points: Real) -> tuple[Real, Real]:
        """See ``Lens``."""
        x, y, z = points.T
        across, angle = _off_axis(points)
        bent, slope = self._bent(angle)
        square = np.maximum(across**2 + z**2, _ON_AXIS**2)
        on_axis = across < _ON_AXIS * np.sqrt(square)
        safe = np.where(on_axis, 1.0, across)
        c, s = np.where(on_axis, 1.0, x / safe), np.where(on_axis, 0.0, y / safe)
        # Across the line to the principal point, and along it.
        around = np.where(on_axis, 1 / np.sqrt(square), bent / safe)
        along = slope * z / square
        place = np.stack([bent * c, bent * s], axis=1)
        derivatives = np.empty((len(points), 2, 3))
        derivatives[:, 0, 0] = along * c * c + around * s * s
        derivatives[:, 1, 1] = along * s * s + around * c * c
        derivatives[:, 0, 1] = derivatives[:, 1, 0] = (along - around) * c * s
        derivatives[:, 0, 2], derivatives[:, 1, 2] = -slope * x / square, -slope * y / square
        focal, centre = self.matrix[[0, 1], [0, 1]], self.matrix[:2, 2]
        return place * focal + centre, derivatives * focal[:, None]

    def project_turned(self, arms: Real, t: Real) -> tuple[Real, Real]:
        """See ``Lens``."""
        pixels, by_place = self.project(arms + t)
        by_turn = np.cross(arms[:, None], by_place)
        return pixels, np.concatenate([by_place, by_turn], axis=2)

    def rays(self, pixels: Real) -> Real:
        """See ``Lens``."""
        ideal = self.ideal(pixels)
        rays = self.rays_of(ideal)
        rays[np.hypot(*ideal.T) > self._most] = np.nan
        return rays

    def ideal(self, pixels: Real) -> Real:
        """See ``Lens``."""
        place = (pixels - self.matrix[:2, 2]) / self.matrix[[0, 1], [0, 1]]
        bent = np.hypot(*place.T)
        ratio = np.where(bent > _ON_AXIS, self._straightened(bent) / np.maximum(bent, _ON_AXIS), 1)
        return np.asarray(place * ratio[:, None])

    def ideal_of(self, points: Real) -> Real:
        """See ``Lens``."""
        across, angle = _off_axis(points)
        ratio = angle / np.maximum(across, _ON_AXIS)
        return np.asarray(points[..., :2] * ratio[..., None])

    def rays_of(self, ideal: Real) -> Real:
        """See ``Lens``."""
        angle = np.hypot(*ideal.T)
        # numpy's sinc is of a turn's half: sin(pi x) / (pi x).
        return np.column_stack([ideal * np.sinc(angle / np.pi)[:, None], np.cos(angle)])

    def depth(self, points: Real) -> Real:
        """See ``Lens``: the distance."""
        return np.asarray(np.linalg.norm(points, axis=-1))

    def log_volume(self, points: Real) -> Real:
        """See ``Lens``: r^3 sin(theta) / theta, the solid angle being
        sin(theta) dtheta dphi and the square focal length theta dtheta dphi."""
        angle = _off_axis(points)[1]
        return np.asarray(3 * np.log(self.depth(points)) + np.log(np.sinc(angle / np.pi)))


def lens_of(name: str, matrix: Real, coefficients: Real) -> Lens:
    """The lens of one of the names in COUNTS."""
    kind = EquidistantLens if name == "equidistant" else PinholeLens
    return kind(matrix, coefficients)


def _off_axis(points: Real) -> tuple[Real, Real]:
    """Distance from the optical axis, and angle to it, radians, of (..., 3) points."""
    across = np.hypot(points[..., 0], points[..., 1])
    return across, np.arctan2(across, points[..., 2])


def _least_root(polynomial: np.polynomial.Polynomial) -> float:
    """The smallest positive real root; infinity where there is none."""
    roots = polynomial.trim().roots()
    real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)]
    return float(real.min(initial=np.inf))
