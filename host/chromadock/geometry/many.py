"""Many poses at once: numpy's calls, not the numbers, are what a few hundred poses cost."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock._native import lib
from chromadock.geometry.native import doubles
from chromadock.geometry.pose import Sighting

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


def errors(sighting: Sighting, R: Real, t: Real) -> tuple[Real, Real]:
    """Reprojection errors (M, 2N) of M poses in standard deviations, and their derivatives
    (M, 2N, 6) by x, y, z and by turns about the camera's axes, as in ``geometry.pose``."""
    count, optics = len(R), sighting.camera.optics
    arms = np.einsum("mij,nj->mni", R, sighting.points_dock)
    # No marker is projected from where the lens does not see.
    seen = optics.within_reach(arms + t[:, None])
    pixels, derivatives = optics.project(seen.reshape(-1, 3))
    markers = len(sighting.sigma_px)
    error, jacobian = np.empty((count, 2 * markers)), np.empty((count, 2 * markers, 6))
    given = (arms, pixels, derivatives, sighting.pixels, sighting.sigma_px)
    lib.poses_errors(count, markers, *map(doubles, (*given, error, jacobian)))
    return error, jacobian
