"""Where the search for a pose starts: solvers that need no start themselves.

They know of no camera but an ideal pinhole.  A start is R (3, 3) and t (3,), metres,
``T_camera_dock`` of a dock frame with its origin in the markers' centroid.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.camera import CameraModel

Real = NDArray[np.float64]
Start = tuple[Real, Real]

_PLANAR = 1e-6  # thickness over width of a set of points
_NEAR_AXIS = 0.5  # cosine: a flat picture stretches what is farther from its middle


@dataclass(frozen=True, eq=False, slots=True)
class Flat:
    """Markers as a pinhole would see them.

    ``places`` (N, 2): normalised coordinates; ``R_camera_flat`` (3, 3): that pinhole's axes.
    """

    places: Real
    R_camera_flat: Real

    @classmethod
    def of(cls, camera: CameraModel, pixels: Real) -> Flat | None:
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
    ) -> Iterator[Start]:
        """Solutions as rotation vectors and places, those that are finite, in the camera's axes."""
        for r, t in zip(rotations, translations, strict=True):
            if np.isfinite(r).all() and np.isfinite(t).all():
                place = np.asarray(t, np.float64).ravel()
                yield self.R_camera_flat @ _matrix(r), self.R_camera_flat @ place


def solutions(points: Real, flat: Flat, spread: Real) -> Iterator[Start]:
    """Poses near one of the minima of four markers or more (N, 3), the likelier first.

    ``spread`` (3,): the points' singular values.
    """
    planar = spread[2] < _PLANAR * spread[0]
    _, rotations, translations, _ = cv2.solvePnPGeneric(
        points,
        flat.places,
        np.eye(3),
        None,
        # SQPnP's guess for a dock with depth is now and then behind the camera.
        flags=cv2.SOLVEPNP_IPPE if planar else cv2.SOLVEPNP_EPNP,
    )
    yield from islice(flat.poses(rotations, translations), 1)
    yield from filter(None, [_face_on(points, flat)])


def starts_of_three(points: Real, flat: Flat) -> list[Start]:
    """Near all poses of three markers (3, 3)."""
    _, rotations, translations = cv2.solveP3P(
        points, flat.places, np.eye(3), None, flags=cv2.SOLVEPNP_AP3P
    )
    found = list(flat.poses(rotations, translations))
    # Of two poses close together noise may leave none that fits exactly, but one that fits well.
    return found + [(np.eye(3), t) for _, t in found]


def tilted_back(R: Real, t: Real, normal: Real) -> Real:
    """The rotation that shows a plane with that normal at the same places, tilted the other way.

    Mirrored in depth along the line of sight, and the plane in itself.
    """
    view = t / np.linalg.norm(t)
    mirror = np.eye(3) - 2 * np.outer(view, view)
    return np.asarray(mirror @ R @ (np.eye(3) - 2 * np.outer(normal, normal)))


def _face_on(points: Real, flat: Flat) -> Start | None:
    """The pose of a dock, its centroid the origin, that faces the camera: roll and size fit best.

    From there the way leads to the pose of markers that lie in a plane which is seen from its
    edge, where solvers for planes fail: of nearly straight lines, level with the camera.
    """
    dock = points[:, :2] @ (1, 1j)
    seen = flat.places @ (1, 1j)
    middle = seen.mean()
    # Least squares: seen - middle = size * dock, the size a complex number that turns as well.
    size = np.vdot(dock, seen - middle) / max(np.vdot(dock, dock).real, 1e-12)
    if not abs(size) > 0:
        return None
    place = np.array([middle.real, middle.imag, 1.0]) / abs(size)
    roll = _matrix(np.array([0.0, 0.0, np.angle(size)]))
    return flat.R_camera_flat @ roll, flat.R_camera_flat @ place


def _matrix(rotation: ArrayLike) -> Real:
    """(3, 3) of a rotation vector."""
    return np.asarray(cv2.Rodrigues(np.asarray(rotation, np.float64))[0], np.float64)
