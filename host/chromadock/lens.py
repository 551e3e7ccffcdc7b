"""Lens models: from rays to places in the picture and back, each with its derivatives.

With ``host/native/lens.c``, which has the formulas, the one place that knows them;
``CameraModel.optics`` is the lens of a camera.  ``plumb_bob`` and ``rational_polynomial`` are one
formula of OpenCV's with more or fewer coefficients, about a pinhole.  ``equidistant`` is that of
``cv2.fisheye`` (Kannala and Brandt, PAMI 28 (2006) 1335), but for what is behind the camera, which
OpenCV's own takes for what is in front of it: the angle to the optical axis is theta, and

    theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)

is the distance from the principal point in focal lengths.

An *ideal* place is where the same kind of lens without coefficients would have it, in focal
lengths: the tangent of the angle to the axis for a pinhole, the angle itself, radians, for
``equidistant``; a flat picture cannot hold a ray at 90 degrees and more.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock._native import ffi, lib
from chromadock.native import doubles

Real = NDArray[np.float64]

COUNTS: dict[str, tuple[int, ...]] = {
    "plumb_bob": (0, 4, 5),
    "rational_polynomial": (0, 8, 12, 14),
    "equidistant": (0, 4),
}
"""The lenses, by ROS's names, and how many coefficients each may have; none: an ideal one."""

PINHOLE_COUNTS = (0, 4, 5, 8, 12, 14)
"""Those that OpenCV's pinhole formula takes."""

_UNTILTED = 12  # coefficients before the two angles of a tilted sensor
_STEPS = 2048  # of the table that an inversion starts from
_NEWTON_ROUNDS = 4  # from there to the last bit
_ALL_AROUND = np.pi - 1e-6  # straight behind has no direction in the picture
_ON_AXIS = 1e-12
_NEARLY = 0.99  # of the way to a fold: beyond it a pixel hardly tells where it comes from


@dataclass(frozen=True, slots=True)
class Fold:
    """The angle to the axis, radians, beyond which a lens formula goes back towards the middle,
    and how far out it comes, in focal lengths."""

    angle_rad: float
    reach: float


class Lens(Protocol):
    """What a camera needs of its lens.  Points are metres in the camera frame."""

    @property
    def native(self) -> Any:
        """As C has it."""

    @property
    def fold(self) -> Fold | None:
        """Where the formula turns back; None where it never does."""

    def sees(self, points: Real) -> NDArray[np.bool_]:
        """(..., 3) points to (...): whether each has a place in the picture, however large."""

    def project(self, points: Real) -> tuple[Real, Real]:
        """(N, 3) points that it sees to (N, 2) pixels, and their (N, 2, 3) derivatives."""

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
class _NativeLens(ABC):
    """What C computes of a lens: ``matrix`` (3, 3), ``coefficients`` (n,)."""

    matrix: Real
    coefficients: Real

    @cached_property
    @abstractmethod
    def native(self) -> Any:
        """See ``Lens``."""

    def __reduce__(self) -> tuple[Any, ...]:
        """C's memory stays where it is."""
        return type(self), (self.matrix, self.coefficients)

    def _native(self, kind: int, coefficients: Real, tilt: Real, widest: float) -> Any:
        """``lens_t`` of ``host/native/lens.h``."""
        focal, centre = self.matrix[[0, 1], [0, 1]], self.matrix[:2, 2]
        lists = [array.tolist() for array in (focal, centre, coefficients, tilt.ravel())]
        return ffi.new("lens_t *", (kind, *lists, widest))

    def sees(self, points: Real) -> NDArray[np.bool_]:
        """See ``Lens``."""
        seen = np.empty(points.shape[:-1], np.bool_)
        lib.lens_sees(self.native, seen.size, doubles(points), ffi.from_buffer("uint8_t[]", seen))
        return seen

    def project(self, points: Real) -> tuple[Real, Real]:
        """See ``Lens``."""
        pixels, derivatives = np.empty((len(points), 2)), np.empty((len(points), 2, 3))
        arrays = map(doubles, (points, pixels, derivatives))
        lib.lens_project(self.native, len(points), *arrays)
        return pixels, derivatives

    def depth(self, points: Real) -> Real:
        """See ``Lens``."""
        depth = np.empty(points.shape[:-1])
        lib.lens_depth(self.native, depth.size, doubles(points), doubles(depth))
        return depth


@dataclass(frozen=True, eq=False)
class PinholeLens(_NativeLens):
    """OpenCV's formula: ``matrix`` (3, 3), ``coefficients`` (n,): k1 k2 p1 p2 [k3 [k4 k5 k6 ...]].

    Angles are below 90 degrees.
    """

    @cached_property
    def native(self) -> Any:
        """See ``Lens``."""
        widest = np.inf if self.fold is None else float(np.tan(self.fold.angle_rad))
        tilt = _tilt(*self.coefficients[_UNTILTED:])
        return self._native(lib.LENS_PINHOLE, self.coefficients[:_UNTILTED], tilt, widest)

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
        ideal = np.empty((len(pixels), 2))
        lib.lens_straighten(self.native, len(pixels), doubles(pixels), doubles(ideal))
        return ideal

    def ideal_of(self, points: Real) -> Real:
        """See ``Lens``."""
        return np.asarray(points[..., :2] / points[..., 2:])

    def rays_of(self, ideal: Real) -> Real:
        """See ``Lens``."""
        rays = np.column_stack([ideal, np.ones(len(ideal))])
        return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))

    def log_volume(self, points: Real) -> Real:
        """See ``Lens``: z^3, for dx dy dz = z^2 du dv dz, and dz = z dlog z."""
        return np.asarray(3 * np.log(points[..., 2]))


@dataclass(frozen=True, eq=False)
class EquidistantLens(_NativeLens):
    """``matrix`` (3, 3), ``coefficients`` (4,) k1 k2 k3 k4 or none; angles of up to 180 degrees."""

    @cached_property
    def native(self) -> Any:
        """See ``Lens``."""
        return self._native(lib.LENS_EQUIDISTANT, self.coefficients, _tilt(), self._most)

    @cached_property
    def _series(self) -> Real:
        return self.coefficients if self.coefficients.size else np.zeros(4)

    @cached_property
    def fold(self) -> Fold | None:
        """Where theta_d, whose derivative is a polynomial in theta^2, turns back."""
        k1, k2, k3, k4 = self._series.tolist()
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
        bent, slope = np.empty_like(angle), np.empty_like(angle)
        lib.lens_bend(doubles(self._series), angle.size, *map(doubles, (angle, bent, slope)))
        return bent, slope

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

    def log_volume(self, points: Real) -> Real:
        """See ``Lens``: r^3 sin(theta) / theta, the solid angle being
        sin(theta) dtheta dphi and the square focal length theta dtheta dphi."""
        angle = _off_axis(points)[1]
        return np.asarray(3 * np.log(self.depth(points)) + np.log(np.sinc(angle / np.pi)))


def lens_of(name: str, matrix: Real, coefficients: Real) -> Lens:
    """The lens of one of the names in COUNTS."""
    kind = EquidistantLens if name == "equidistant" else PinholeLens
    return kind(matrix, coefficients)


def _tilt(across: float = 0.0, down: float = 0.0) -> Real:
    """(3, 3): what OpenCV has a sensor do to places (x, y, 1) that is turned by angles, radians,
    about the picture's axis to the right and that downwards."""
    a, b = cv2.Rodrigues(np.array([-across, 0, 0]))[0], cv2.Rodrigues(np.array([0, -down, 0]))[0]
    R = b @ a
    onto = np.array([[R[2, 2], 0, -R[0, 2]], [0, R[2, 2], -R[1, 2]], [0, 0, 1]])
    return np.asarray(onto @ R)


def _off_axis(points: Real) -> tuple[Real, Real]:
    """Distance from the optical axis, and angle to it, radians, of (..., 3) points."""
    across = np.hypot(points[..., 0], points[..., 1])
    return across, np.arctan2(across, points[..., 2])


def _least_root(polynomial: np.polynomial.Polynomial) -> float:
    """The smallest positive real root; infinity where there is none."""
    roots = polynomial.trim().roots()
    real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)]
    return float(real.min(initial=np.inf))
