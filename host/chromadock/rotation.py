"""Unit quaternions ``(w, x, y, z)`` and rotation matrices."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def matrix_from_quaternion(q_wxyz: ArrayLike) -> NDArray[np.float64]:
    """The 3x3 rotation of a quaternion, which need not be of unit length."""
    w, x, y, z = np.asarray(q_wxyz, dtype=np.float64) / np.linalg.norm(q_wxyz)
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
    m = np.asarray(R, dtype=np.float64)
    # 4 q q^T, from the definition of the matrix above.
    outer = np.array(
        [
            [
                1 + m[0, 0] + m[1, 1] + m[2, 2],
                m[2, 1] - m[1, 2],
                m[0, 2] - m[2, 0],
                m[1, 0] - m[0, 1],
            ],
            [
                m[2, 1] - m[1, 2],
                1 + m[0, 0] - m[1, 1] - m[2, 2],
                m[0, 1] + m[1, 0],
                m[0, 2] + m[2, 0],
            ],
            [
                m[0, 2] - m[2, 0],
                m[0, 1] + m[1, 0],
                1 - m[0, 0] + m[1, 1] - m[2, 2],
                m[1, 2] + m[2, 1],
            ],
            [
                m[1, 0] - m[0, 1],
                m[0, 2] + m[2, 0],
                m[1, 2] + m[2, 1],
                1 - m[0, 0] - m[1, 1] + m[2, 2],
            ],
        ]
    )
    q = outer[int(np.argmax(np.diag(outer)))]
    q = q / np.linalg.norm(q) * (-1 if q[0] < 0 else 1)
    w, x, y, z = q.tolist()
    return w, x, y, z
