"""Unit quaternions ``(w, x, y, z)`` and rotation matrices."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.errors import ChromadockError

NOT_ORTHONORMAL = 1e-3
"""Largest element of R^T R - 1 of a matrix that is still a rotation written with few digits: a
hundredth of a degree more than a mounting can be measured to would be a slip."""


UNKNOWN_ANGLE = math.pi**2 / 3
"""Variance, radians squared, of an angle that may be any: uniform over a full turn."""


def checked_rotation(matrix: ArrayLike, name: str) -> NDArray[np.float64]:
    """A rotation that a user gave, made orthonormal and read-only.

    Parameters
    ----------
    matrix : (3, 3), orthonormal to ``NOT_ORTHONORMAL``, determinant +1.
    name : what the message calls it.

    Returns
    -------
    (3, 3) float64: the nearest rotation (Higham, Matrix Procrustes Problems, 1995: U V^T of the
    singular value decomposition).

    Raises
    ------
    ChromadockError
        For anything that is not a rotation: one line with the name, what is wrong, the mend.
    """
    try:
        R = np.array(matrix, np.float64)
    except (TypeError, ValueError):
        raise ChromadockError(f"{name} is no matrix of numbers: {_MEND}") from None
    fault = _fault(R)
    if fault:
        raise ChromadockError(f"{name} {fault}: {_MEND}")
    left, _, right = np.linalg.svd(R)
    nearest = np.asarray(left @ right, np.float64)
    nearest.setflags(write=False)
    return nearest


_MEND = "give a 3x3 rotation, its columns the unit vectors of one frame's axes in the other frame"


def _fault(R: NDArray[np.float64]) -> str | None:
    """Why an array is no rotation, or None."""
    if R.shape != (3, 3):
        return f"has the shape {R.shape}"
    if not np.isfinite(R).all():
        return "has a number that is not finite"
    off = float(np.abs(R.T @ R - np.eye(3)).max())
    if off > NOT_ORTHONORMAL:
        lengths = ", ".join(f"{length:.4g}" for length in np.linalg.norm(R, axis=0))
        return f"is not orthonormal (columns of length {lengths}, R^T R off by {off:.2g})"
    if np.linalg.det(R) < 0:
        return "is a reflection (determinant -1, a left-handed frame)"
    return None


def matrix_from_quaternion(q_wxyz: ArrayLike) -> NDArray[np.float64]:
    """The 3x3 rotation of a quaternion (4,), which need not be of unit length.

    Raises
    ------
    ChromadockError
        For another shape, a number that is not finite, or a length of zero.
    """
    q = np.asarray(q_wxyz, dtype=np.float64)
    length = float(np.linalg.norm(q))
    if q.shape != (4,) or not 0 < length < np.inf:
        raise ChromadockError(
            f"quaternion {q.tolist()}: it must be four finite numbers w, x, y, z, not all zero"
        )
    w, x, y, z = q / length
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def quaternion_from_matrix(R: ArrayLike) -> tuple[float, float, float, float]:
    """The unit quaternion of a 3x3 rotation, with w >= 0.

    By its largest component, so that no rotation divides by a small number.
    """
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = np.asarray(R, dtype=np.float64).tolist()
    # 4 q q^T, from the definition of the matrix above.
    outer = (
        (1 + xx + yy + zz, zy - yz, xz - zx, yx - xy),
        (zy - yz, 1 + xx - yy - zz, xy + yx, xz + zx),
        (xz - zx, xy + yx, 1 - xx + yy - zz, yz + zy),
        (yx - xy, xz + zx, yz + zy, 1 - xx - yy + zz),
    )
    w, x, y, z = max(enumerate(outer), key=lambda row: row[1][row[0]])[1]
    length = math.hypot(w, x, y, z) * (-1 if w < 0 else 1)
    return w / length, x / length, y / length, z / length
