"""What makes numbers impossible, or implausible, as a camera's: each in words for one line."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.lens import COUNTS, PINHOLE_COUNTS, Lens

LEAST_FOCAL_PER_SIDE = 0.15
"""Of the picture's shorter side: less is no focal length in pixels.  It is a pinhole's picture of
147 degrees from edge to edge."""

LEAST_FOCAL_PER_SIDE_EQUIDISTANT = 0.1
"""The same of a fisheye, whose whole circle may fill a part of the picture only."""

MOST_FOCAL_PER_SIDE = 50.0
"""Of the picture's longer side, at most: a picture of one degree."""

MOST_ASPECT = 3.0
"""Of fx to fy or fy to fx: pixels twice as wide as high are those of an interlaced field."""

LEAST_FOLD_RAD = np.radians(75.0)
"""A fisheye's formula may turn back within the picture beyond this angle: its circle ends there."""

Real = NDArray[np.float64]


def impossible(width: int, height: int, matrix: Real, distortion: Real, lens: str) -> str | None:
    """What makes these numbers no camera, or None; ``lens`` may be empty."""
    if width <= 0 or height <= 0:
        return f"image_width x image_height is {width}x{height}: both must be positive"
    if matrix.shape != (3, 3):
        return f"camera_matrix is {'x'.join(map(str, matrix.shape))}: it must be 3x3"
    if not np.isfinite(matrix).all():
        return "camera_matrix has a number that is not finite: calibrate again"
    fault = _count_fault(distortion.size, lens)
    if fault:
        return fault
    if not np.isfinite(distortion).all():
        return "distortion_coefficients has a number that is not finite: calibrate again"
    return _matrix_fault(matrix)


def implausible(width: int, height: int, matrix: Real, lens: str, optics: Lens) -> str | None:
    """What no camera has, though a formula could, or None."""
    fx, fy = float(matrix[0, 0]), float(matrix[1, 1])
    sides = width / fx, height / fy
    equidistant = lens == "equidistant"
    least = LEAST_FOCAL_PER_SIDE_EQUIDISTANT if equidistant else LEAST_FOCAL_PER_SIDE
    given, size = f"camera_matrix has fx = {fx:g}, fy = {fy:g}", f"{width}x{height} pixels"
    if least * min(sides) > 1:
        return (
            f"{given}, far too short for {size}: if that is millimetres, give pixels, "
            "mm * image width / sensor width, or better calibrate"
        )
    if MOST_FOCAL_PER_SIDE * max(sides) < 1:
        return f"{given}, far too long for {size}: give pixels, or calibrate again"
    if max(fx / fy, fy / fx) > MOST_ASPECT:
        return f"{given}: a camera's two are nearly the same, so correct the one that is wrong"
    return _folded(width, height, matrix, lens, optics)


def _folded(width: int, height: int, matrix: Real, lens: str, optics: Lens) -> str | None:
    """Whether the distortion leaves more than the corners of the picture without a ray."""
    fold = optics.fold
    if fold is None or (lens == "equidistant" and fold.angle_rad >= LEAST_FOLD_RAD):
        return None
    (fx, fy), (cx, cy) = matrix[[0, 1], [0, 1]], matrix[:2, 2]
    side = float(max(cx / fx, (width - 1 - cx) / fx, cy / fy, (height - 1 - cy) / fy))
    if fold.reach >= side:
        return None
    focal = float(np.sqrt(fx * fy))
    return (
        f"distortion_coefficients fold the picture {fold.reach * focal:.0f} px from its middle, "
        f"and its side is at {side * focal:.0f} px: check the distortion_model, here {lens}, "
        "or calibrate again with the board near the sides"
    )


def _count_fault(count: int, lens: str) -> str | None:
    """What is wrong with so many coefficients of a lens, whose name may be empty, or None."""
    if not lens:
        if count in PINHOLE_COUNTS:
            return None
        return (
            f"distortion_coefficients has {count} numbers: it must have 4, 5, 8, 12 or 14, or none"
        )
    if lens not in COUNTS:
        return f"the lens {lens} is not supported: choose one of {', '.join(COUNTS)}"
    if count not in COUNTS[lens]:
        allowed = " or ".join(str(n) for n in COUNTS[lens] if n)
        return (
            f"distortion_coefficients has {count} numbers, "
            f"but {lens} has {allowed}: correct the list or the distortion_model"
        )
    return None


def _matrix_fault(matrix: NDArray[np.float64]) -> str | None:
    """What is wrong with a finite 3x3 camera matrix, or None."""
    fx, fy = matrix[0, 0], matrix[1, 1]
    mend = "it must read fx 0 cx, 0 fy cy, 0 0 1 with fx and fy positive, in pixels"
    scale = np.abs(matrix).max()
    if scale == 0 or abs(np.linalg.det(matrix / scale)) < 1e-12:
        return f"camera_matrix is singular: {mend}"
    if fx <= 0 or fy <= 0:
        return f"camera_matrix has fx = {fx:g}, fy = {fy:g}: {mend}"
    if not np.allclose(matrix[2], (0, 0, 1)):
        last = " ".join(f"{v:g}" for v in matrix[2])
        return f"camera_matrix ends with the row {last} (transposed?): {mend}"
    if abs(matrix[1, 0]) > 1e-6 * fy or abs(matrix[0, 1]) > 1e-6 * fx:
        return f"camera_matrix has skew, which is not supported: {mend}"
    return None
