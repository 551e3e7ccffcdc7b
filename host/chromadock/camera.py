"""The camera's geometry: from pixels to rays and back.

All pixels have their origin at the centre of the top left pixel, x right, y down.
Camera frame: OpenCV's (x right, y down, z forward), metres.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.camera_check import implausible, impossible
from chromadock.errors import ChromadockError
from chromadock.lens import Lens, lens_of

NOMINAL_FOCAL_PER_WIDTH = 0.8
"""A plain webcam lens sees about 64 degrees across: f is 0.8 widths."""


@dataclass(frozen=True, eq=False)
class CameraModel:
    """A camera: its pixels, and one of the lenses in ``lens.COUNTS``.

    Parameters
    ----------
    width, height
        Size of the frames that the calibration holds for, pixels.
    matrix
        3x3 float64 ``[[fx, 0, cx], [0, fy, cy], [0, 0, 1]]``, pixels.
    distortion
        (n,) float64.  ``plumb_bob`` has 0, 4 or 5, ``rational_polynomial`` 0, 8, 12 or 14:
        k1 k2 p1 p2 [k3 [k4 k5 k6 [...]]], as OpenCV; ``equidistant`` 0 or 4: k1 k2 k3 k4, as
        ``cv2.fisheye``.
    name
        What messages call this camera: its file.
    lens
        ``plumb_bob``, ``rational_polynomial`` or ``equidistant``; unless given one of the first
        two, by the number of coefficients.

    Raises
    ------
    ChromadockError
        Where the numbers cannot be a camera: a focal length that must be in millimetres, say, or a
        distortion that folds the picture.
    """

    width: int
    height: int
    matrix: NDArray[np.float64]
    distortion: NDArray[np.float64] = field(default_factory=lambda: np.zeros(5))
    name: str = "camera"
    lens: str = ""

    def __post_init__(self) -> None:
        matrix = np.array(self.matrix, dtype=np.float64)
        distortion = np.array(self.distortion, dtype=np.float64).reshape(-1)
        matrix.setflags(write=False)
        distortion.setflags(write=False)
        object.__setattr__(self, "matrix", matrix)
        object.__setattr__(self, "distortion", distortion)
        fault = impossible(self.width, self.height, matrix, distortion, self.lens)
        if not self.lens:
            by_count = "plumb_bob" if distortion.size <= 5 else "rational_polynomial"
            object.__setattr__(self, "lens", by_count)
        fault = fault or implausible(self.width, self.height, matrix, self.lens, self.optics)
        if fault:
            raise ChromadockError(f"{self.name}: {fault}")

    @classmethod
    def from_yaml(cls, path: str | Path) -> CameraModel:
        """The camera in a file that a calibration tool wrote: see ``camera_file``.

        Raises
        ------
        ChromadockError
            One line with the file, the key, what is wrong and the mend.
        """
        from chromadock.camera_file import read_camera_file

        read = read_camera_file(Path(path))
        name = str(path) + read.window
        return cls(read.width, read.height, read.matrix, read.distortion, name, read.lens)

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

    @cached_property
    def optics(self) -> Lens:
        """What its lens does to rays."""
        return lens_of(self.lens, self.matrix, self.distortion)

    @property
    def key(self) -> tuple[int, int, bytes, bytes, str]:
        """The same for cameras of the same geometry, whatever their names."""
        numbers = self.matrix.tobytes(), self.distortion.tobytes()
        return self.width, self.height, *numbers, self.lens

    @classmethod
    def of_key(cls, key: tuple[int, int, bytes, bytes, str]) -> CameraModel:
        """A camera of that geometry."""
        width, height, matrix, distortion, lens = key
        numbers = np.frombuffer(matrix).reshape(3, 3), np.frombuffer(distortion)
        return cls(width, height, *numbers, lens=lens)

    def rays(self, points: ArrayLike) -> NDArray[np.float64]:
        """Nx2 pixels to Nx3 unit vectors, camera frame; NaN where the lens sends no ray."""
        return self.optics.rays(np.asarray(points, dtype=np.float64).reshape(-1, 2))

    def undistort(self, points: ArrayLike) -> NDArray[np.float64]:
        """Nx2 pixels to Nx2 normalised coordinates: the ray is ``(x, y, 1)``, camera frame.

        NaN for rays at 90 degrees and more from the axis, which have none: see ``rays``.
        """
        pixels = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        if self.lens != "equidistant":
            return self.optics.ideal(pixels)
        rays = self.optics.rays(pixels)
        ahead = np.where(rays[:, 2:] > 0, rays[:, 2:], np.nan)
        return np.asarray(rays[:, :2] / ahead)

    def project(self, points_camera: ArrayLike) -> NDArray[np.float64]:
        """Nx3 metres in the camera frame to Nx2 pixels; NaN for points that the lens cannot see:
        of a pinhole those not in front."""
        points = np.asarray(points_camera, dtype=np.float64).reshape(-1, 3)
        pixels = np.full((len(points), 2), np.nan)
        seen = self.optics.sees(points)
        if seen.any():
            pixels[seen] = self.optics.project(points[seen])[0]
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
