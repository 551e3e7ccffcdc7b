"""The paper's detector from the frame to the pose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.colour.marker import observed_colour
from chromadock.dock import DockGeometry
from chromadock.geometry.pose import epnp
from chromadock.look import Found, Look
from chromadock.paper.blobs import find_spots
from chromadock.paper.constellation import CORNERS, Rectangle, corners, four_blobs, right_triangles
from chromadock.paper.mask import colour_mask, foreground
from chromadock.paper.peaks import Spot
from chromadock.results.detection import Blob
from chromadock.results.pose import Pose
from chromadock.rotation import matrix_from_quaternion
from chromadock.stopwatch import Stopwatch


class PaperMethod:
    """Mask, Laplacian of Gaussian, right triangles, corners, EPnP."""

    def __init__(self, dock: DockGeometry) -> None:
        self._dock = dock
        self._rectangle = Rectangle.of(dock)
        self.mask: NDArray[np.uint8] = np.zeros((0, 0), np.uint8)

    def find(self, look: Look, watch: Stopwatch) -> Found:
        """Look for the dock in one frame, everywhere: no prior is used."""
        marker_rgb = look.marker_rgb
        assert marker_rgb is not None, "a mask needs a colour"
        observed = observed_colour(look.background.rgb, marker_rgb)
        mask = colour_mask(look.frame_bgr, observed)
        self.mask = mask & foreground(look.frame_bgr, look.background.bin)
        watch.lap("mask")
        return self.find_in_mask(self.mask, look.camera, watch)

    def find_in_mask(self, mask: NDArray[np.uint8], camera: CameraModel, watch: Stopwatch) -> Found:
        """Look for the dock in a (H, W) uint8 mask, 0 or 255, whatever filter it came from."""
        spots = find_spots(mask)
        watch.lap("blobs")

        points = np.array([(s.x, s.y) for s in spots], dtype=np.float64).reshape(-1, 2)
        triangles = right_triangles(points, self._rectangle.ratio)
        chosen = four_blobs(triangles)
        indices = None if chosen is None else self._by_corner(points, list(chosen))
        watch.lap("constellation")

        pose = None
        if indices is not None:
            pose = self._pose(points[indices], camera)
        watch.lap("pose")

        markers = None
        if pose is not None and indices is not None:
            markers = {
                name: (float(points[i, 0]), float(points[i, 1]))
                for name, i in zip(self._dock.names, indices, strict=True)
            }
        return Found(
            state="not_found" if pose is None else "found",
            passed_fraction=float(np.count_nonzero(mask)) / mask.size,
            blobs=_blobs(spots, set(np.argwhere(np.isfinite(triangles)).ravel().tolist())),
            markers=markers,
            pose=pose,
        )

    def _pose(self, pixels: NDArray[np.float64], camera: CameraModel) -> Pose | None:
        """Of the dock's own frame, solved for about the centroid: wherever its origin is."""
        centre = self._dock.centre
        pose = epnp(self._dock.points - centre, pixels, camera)
        farthest = self._dock.largest_range_m
        if pose is None or (farthest is not None and np.linalg.norm(pose.t) > farthest):
            return None
        x, y, z = (np.array(pose.t) - matrix_from_quaternion(pose.q_wxyz) @ centre).tolist()
        return replace(pose, t=(x, y, z))

    def _by_corner(self, points: NDArray[np.float64], chosen: list[int]) -> list[int] | None:
        """The blob of each dock marker, in the geometry's order."""
        seen = corners(points[chosen])
        if seen is None:
            return None
        blob_of = {self._rectangle.corner[name]: chosen[seen[name]] for name in CORNERS}
        return [blob_of[marker] for marker in range(4)]


def _blobs(spots: list[Spot], accepted: set[int]) -> tuple[Blob, ...]:
    return tuple(Blob(s.x, s.y, s.radius, i in accepted) for i, s in enumerate(spots))
