"""Where pixels look: unit rays of whole images, full size or on a coarse grid, and solid angles.

What varies slowly over an image is worked out on a coarse grid and enlarged, which costs
a sixteenth and, because the rays come from the calibrated lens, keeps its distortion.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.camera import CameraModel

Image = NDArray[np.float32]

__all__ = ["RayGrid", "solid_angles", "unit_rays"]


def unit_rays(camera: CameraModel, pixels: ArrayLike) -> NDArray[np.float64]:
    """(N, 2) pixels to (N, 3) unit vectors in the camera frame."""
    plane = camera.undistort(pixels)
    rays = np.column_stack([plane, np.ones(len(plane))])
    return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))


def solid_angles(camera: CameraModel, pixels: ArrayLike) -> NDArray[np.float64]:
    """(N, 2) pixel centres to (N,) solid angles of those pixels, sr.

    The area that the pixel's two edges span on the unit sphere; cos^3 / f^2 where the
    lens is a pinhole.
    """
    centres = np.asarray(pixels, dtype=np.float64).reshape(-1, 2)
    half = np.array([[0.5, 0.0], [-0.5, 0.0], [0.0, 0.5], [0.0, -0.5]])
    edges = unit_rays(camera, (centres[:, None] + half).reshape(-1, 2)).reshape(-1, 4, 3)
    across, down = edges[:, 0] - edges[:, 1], edges[:, 2] - edges[:, 3]
    return np.asarray(np.linalg.norm(np.cross(across, down), axis=1))


class RayGrid:
    """Every so many pixels a's ray, laid out so that ``enlarge`` meets the full image.

    Parameters
    ----------
    camera
        Whose image.
    step
        Pixels between neighbours of the grid, across and down; 1 is every pixel.
    """

    def __init__(self, camera: CameraModel, step: tuple[int, int]) -> None:
        self._size = (camera.width, camera.height)
        self.width, self.height = (
            math.ceil(pixels / every) for pixels, every in zip(self._size, step, strict=True)
        )
        # Where OpenCV's resize, which counts from pixels' corners, will look for them.
        columns = (np.arange(self.width) + 0.5) * camera.width / self.width - 0.5
        rows = (np.arange(self.height) + 0.5) * camera.height / self.height - 0.5
        self.pixels = np.stack(np.meshgrid(columns, rows), axis=-1)
        """(h, w, 2) float64: the nodes' places in the full image, pixels."""
        rays = unit_rays(camera, self.pixels.reshape(-1, 2))
        self.rays = np.ascontiguousarray(rays.T.astype(np.float32)).reshape(3, *self.shape)
        """(3, h, w) float32: x, y and z of unit vectors, camera frame."""

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.height, self.width

    def turned(self, rotation: ArrayLike) -> Image:
        """(3, h, w) the rays in the frame that a (3, 3) rotation takes the camera's to."""
        matrix = np.asarray(rotation, np.float32)
        return (matrix @ self.rays.reshape(3, -1)).reshape(self.rays.shape)

    def enlarge(self, image: Image, onto: RayGrid | None = None) -> Image:
        """(h, w[, C]) on the grid to (H, W[, C]), or to a finer grid: bilinear."""
        size = self._size if onto is None else (onto.width, onto.height)
        return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_LINEAR))
