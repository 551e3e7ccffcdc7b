"""The spatial filter: right triangles with the dock's side ratio, four corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.dock import DockGeometry
from chromadock.errors import ChromadockError

# A yaw of 25 degrees shortens the wide side by a tenth, perspective and the centroid's
# error take as much again.
RATIO_TOLERANCE = 0.2
# Roll keeps right angles; yaw and pitch together bend them by a few degrees.
ANGLE_TOLERANCE_DEG = 10.0

CORNERS = ("top_left", "top_right", "bottom_left", "bottom_right")


@dataclass(frozen=True, slots=True)
class Rectangle:
    """The dock's four markers by corner: index into the geometry, and the side ratio."""

    corner: dict[str, int]
    ratio: float

    @classmethod
    def of(cls, dock: DockGeometry) -> Rectangle:
        """The dock as a rectangle.

        Raises
        ------
        ChromadockError
            Where it is none: the paper's method knows no other shape.
        """
        fault = ChromadockError(
            f"{dock.source}: method paper needs four markers at the corners of a rectangle "
            "in the plane z = 0; use another method for this dock"
        )
        if len(dock.names) != 4 or np.ptp(dock.points[:, 2]) > 1e-6:
            raise fault
        corner = corners(dock.points[:, :2])
        if corner is None:
            raise fault
        tl, tr, bl, br = (dock.points[corner[name], :2] for name in CORNERS)
        sides = np.array([tr - tl, br - bl, bl - tl, br - tr])
        lengths = np.linalg.norm(sides, axis=1)
        parallel = np.allclose(sides[0], sides[1], atol=0.01 * lengths.max())
        square = abs(sides[0] @ sides[2]) < 0.01 * lengths[0] * lengths[2]
        if not (parallel and square):
            raise fault
        long, short = sorted((lengths[0], lengths[2]), reverse=True)
        return cls(corner, float(long / short))


def corners(points: NDArray[np.float64]) -> dict[str, int] | None:
    """Index of the top left, top right, bottom left and bottom right most point.

    ``points`` is (4, 2), x right, y down; None where one point would be two corners.
    """
    along, across = points.sum(axis=1), points[:, 0] - points[:, 1]
    found = {
        "top_left": int(along.argmin()),
        "top_right": int(across.argmax()),
        "bottom_left": int(across.argmin()),
        "bottom_right": int(along.argmax()),
    }
    return found if len(set(found.values())) == 4 else None


def right_triangles(points: NDArray[np.float64], ratio: float) -> NDArray[np.float64]:
    """How far each triple of points is from a right triangle with the dock's ratio of legs.

    Parameters
    ----------
    points : (N, 2) float64, pixels.
    ratio : long over short side of the dock's rectangle.

    Returns
    -------
    (N, N, N) float64, indexed by the right angle's vertex, the long leg's end, the short
    leg's end: the squared error of angle and ratio in tolerances, infinite beyond them.
    """
    legs = points[None, :, :] - points[:, None, :]
    length = np.linalg.norm(legs, axis=2)
    np.fill_diagonal(length, np.nan)  # no leg from a point to itself
    # In place: with many points most of the time goes into fresh memory.
    ratio_error = length[:, :, None] / length[:, None, :]
    ratio_error /= ratio
    ratio_error -= 1
    np.abs(ratio_error, out=ratio_error)
    ratio_error /= RATIO_TOLERANCE
    i, j, k = _where(ratio_error <= 1)
    product = legs[i, j, 0] * legs[i, k, 0] + legs[i, j, 1] * legs[i, k, 1]
    cosine = product / (length[i, j] * length[i, k])
    angle_error = np.abs(cosine) / np.sin(np.radians(ANGLE_TOLERANCE_DEG))
    both = angle_error**2 + ratio_error[i, j, k] ** 2
    error = np.full(ratio_error.shape, np.inf)
    error[i, j, k] = np.where(angle_error <= 1, both, np.inf)
    return error


def four_blobs(error: NDArray[np.float64]) -> tuple[int, int, int, int] | None:
    """The four points every three of which form such a triangle, the best if several do.

    ``error`` is that of ``right_triangles``.  None where no four do.
    """
    a, b, c = _where(np.isfinite(error))
    if not len(a):
        return None
    # The fourth point lies across from a: the same triangle at each corner.
    total = error[a, b, c][:, None] + error[b, a, :] + error[c, :, a] + error[:, c, b].T
    best, fourth = divmod(int(total.argmin()), total.shape[1])
    if not np.isfinite(total[best, fourth]):
        return None
    return int(a[best]), int(b[best]), int(c[best]), fourth


def _where(condition: NDArray[np.bool_]) -> tuple[NDArray[np.intp], ...]:
    """``np.nonzero``, ten times faster where little is true."""
    return np.unravel_index(np.flatnonzero(condition), condition.shape)
