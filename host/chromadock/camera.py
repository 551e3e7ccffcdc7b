"""The camera's geometry: from pixels to rays and back.

All pixels have their origin at the centre of the top left pixel, x right, y down.
Camera frame: OpenCV's (x right, y down, z forward), metres.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.errors import ChromadockError

DISTORTION_COUNTS = (0, 4, 5, 8, 12, 14)
"""Numbers of coefficients that OpenCV's lens model takes; none means no distortion."""

NOMINAL_FOCAL_PER_WIDTH = 0.8
"""A plain webcam lens sees about 64 degrees across: f is 0.8 widths."""

# OpenCV's own default stops after five rounds, which leaves almost a pixel of error at
# the corners of a wide lens.
_CONVERGED = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, 1e-10)


@dataclass(frozen=True, eq=False)
class CameraModel:
    """A pinhole camera with OpenCV's lens distortion.

    Parameters
    ----------
    width, height
        Size of the frames that the calibration holds for, pixels.
    matrix
        3x3 float64 ``[[fx, 0, cx], [0, fy, cy], [0, 0, 1]]``, pixels.
    distortion
        (n,) float64 with n one of 0, 4, 5, 8, 12, 14: k1 k2 p1 p2 [k3 [k4 k5 k6 [...]]].
    name
        What messages call this camera: its file.

    Raises
    ------
    ChromadockError
        Where the numbers cannot be a camera.
    """

    width: int
    height: int
    matrix: NDArray[np.float64]
    distortion: NDArray[np.float64] = field(default_factory=lambda: np.zeros(5))
    name: str = "camera"

    def __post_init__(self) -> None:
        matrix = np.array(self.matrix, dtype=np.float64)
        distortion = np.array(self.distortion, dtype=np.float64).reshape(-1)
        matrix.setflags(write=False)
        distortion.setflags(write=False)
        object.__setattr__(self, "matrix", matrix)
        object.__setattr__(self, "distortion", distortion)
        fault = _fault(self.width, self.height, matrix, distortion)
        if fault:
            raise ChromadockError(f"{self.name}: {fault}")

    @classmethod
    def from_yaml(cls, path: str | Path) -> CameraModel:
        """The camera in a ROS ``camera_info`` YAML, as calibration tools write it.

        Raises
        ------
        ChromadockError
            One line with the file, the key, what is wrong and the mend.
        """
        from chromadock.camera_file import read_camera_file

        return cls(*read_camera_file(Path(path)), name=str(path))

    @classmethod
    def nominal(cls, width: int, height: int) -> CameraModel:
        """A guess for ``width`` x ``height`` pixels when there is no calibration.

        f = 0.8 width, principal point in the centre, no distortion: directions are
        about right, distances rough.
        """
        focal = NOMINAL_FOCAL_PER_WIDTH * width
        centre_x, centre_y = (width - 1) / 2, (height - 1) / 2
        matrix = np.array([[focal, 0, centre_x], [0, focal, centre_y], [0, 0, 1]])
        return cls(width, height, matrix, name="nominal camera")

    def undistort(self, points: ArrayLike) -> NDArray[np.float64]:
        """Nx2 pixels to Nx2 normalised coordinates: the ray is ``(x, y, 1)``, camera frame."""
        pixels = np.asarray(points, dtype=np.float64).reshape(-1, 1, 2)
        if not len(pixels):
            return np.empty((0, 2))
        if hasattr(cv2, "undistortPointsIter"):  # OpenCV 4; in 5 it became an argument
            rays = cv2.undistortPointsIter(
                pixels, self.matrix, self.distortion, None, None, _CONVERGED
            )
        else:
            rays = cv2.undistortPoints(pixels, self.matrix, self.distortion, criteria=_CONVERGED)
        return np.asarray(rays, dtype=np.float64).reshape(-1, 2)

    def project(self, points_camera: ArrayLike) -> NDArray[np.float64]:
        """Nx3 metres in the camera frame to Nx2 pixels; NaN for points not in front."""
        points = np.asarray(points_camera, dtype=np.float64).reshape(-1, 3)
        pixels = np.full((len(points), 2), np.nan)
        in_front = points[:, 2] > 0
        if in_front.any():
            zero = np.zeros(3)
            seen, _ = cv2.projectPoints(points[in_front], zero, zero, self.matrix, self.distortion)
            pixels[in_front] = seen.reshape(-1, 2)
        return pixels

    def check_size(self, shape: tuple[int, ...]) -> None:
        """Refuse frames of another size than the calibration's; ``shape`` is HxW[xC].

        A camera's modes crop as well as scale, so intrinsics cannot just be scaled along.

        Raises
        ------
        ChromadockError
            One line with both sizes and the mend.
        """
        height, width = shape[:2]
        if (width, height) != (self.width, self.height):
            raise ChromadockError(
                f"{self.name}: calibrated for {self.width}x{self.height} pixels, but the frames "
                f"are {width}x{height}: calibrate the camera in the mode you use it in"
            )


def _fault(
    width: int, height: int, matrix: NDArray[np.float64], distortion: NDArray[np.float64]
) -> str | None:
    """What makes these numbers impossible as a camera, or None."""
    if width <= 0 or height <= 0:
        return f"image_width x image_height is {width}x{height}: both must be positive"
    if matrix.shape != (3, 3):
        return f"camera_matrix is {'x'.join(map(str, matrix.shape))}: it must be 3x3"
    if not np.isfinite(matrix).all():
        return "camera_matrix has a number that is not finite: calibrate again"
    if distortion.size not in DISTORTION_COUNTS:
        return (
            f"distortion_coefficients has {distortion.size} numbers: "
            "it must have 4, 5, 8, 12 or 14, or none"
        )
    if not np.isfinite(distortion).all():
        return "distortion_coefficients has a number that is not finite: calibrate again"
    return _matrix_fault(matrix)


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
