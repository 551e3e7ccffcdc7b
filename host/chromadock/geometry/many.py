"""Many poses at once: numpy's calls, not the numbers, are what a few hundred poses cost."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from chromadock._native import ffi, lib
from chromadock.geometry.pose import Sighting
from chromadock.native import doubles

Real = NDArray[np.float64]


def rotations(turns: Real) -> Real:
    """(M, 3, 3) rotations by (M, 3) rotation vectors, radians: Rodrigues' formula."""
    R = np.empty((len(turns), 3, 3))
    lib.poses_rotations(len(turns), doubles(turns), doubles(R))
    return R


def rotation_vectors(R: Real) -> Real:
    """(M, 3) rotation vectors, radians, of (M, 3, 3) rotations by less than half a turn."""
    axis = np.stack(
        [R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1
    )
    sine, cosine = np.linalg.norm(axis, axis=1), np.trace(R, axis1=1, axis2=2) - 1
    angle = np.arctan2(sine, cosine)
    return np.asarray(axis * np.where(sine > 1e-9, angle / np.maximum(sine, 1e-9), 0.5)[:, None])


class Normal(NamedTuple):
    """The normal equations of M poses: e are reprojection errors in standard deviations, J their
    derivatives by x, y, z and by turns about the camera's axes, as in ``geometry.pose``.

    ``information`` (M, 6, 6): J'J; ``gradient`` (M, 6): J'e; ``chi_square`` (M,): e'e; ``seen``
    (M,): whether the lens sees all markers.  Of a marker that it does not see the error is that
    of a place somewhere.
    """

    information: Real
    gradient: Real
    chi_square: Real
    seen: NDArray[np.bool_]


def normal_equations(sighting: Sighting, R: Real, t: Real, sigma_px: Real | None = None) -> Normal:
    """Those of poses (M, 3, 3), (M, 3), with standard deviations (M, N) in place of the
    sighting's, if there are."""
    count = len(R)
    sigma_px = sighting.sigma_px if sigma_px is None else sigma_px
    given = (R, t, np.broadcast_to(sigma_px, (count, len(sighting.pixels))))
    normal = Normal(
        np.empty((count, 6, 6)), np.empty((count, 6)), np.empty(count), np.empty(count, np.bool_)
    )
    arrays = map(doubles, (*given, *normal[:3]))
    lib.poses_normal(sighting.native, count, *arrays, ffi.from_buffer("uint8_t[]", normal.seen))
    return normal
