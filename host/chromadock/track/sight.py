"""The markers of a frame as a measurement for the track."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.dock import DockGeometry
from chromadock.geometry.pose import MIN_MARKERS, Estimate, Sighting, projected

FLOOR_PX = 0.2
"""Of a marker's error, however bright it is: a colour camera samples red and blue at every other
pixel, and a good calibration leaves 0.1 to 0.3 pixels."""

SAME_PLACE = 0.2
"""Of the distance from where a marker is expected to where another is: nearer to that one it
stands where the other does."""

MIN_OTHERS = 2
"""One marker may move to another's place by chance."""


@dataclass(frozen=True, eq=False, slots=True)
class Sight:
    """``markers`` with their errors, and the poses that they leave open, the best first.

    ``whole``: whether they are all of the dock's; ``smaller``: see ``look.Found``.
    """

    markers: Sighting
    poses: tuple[Estimate, ...]
    whole: bool
    smaller: float = 0.0

    @classmethod
    def of(
        cls,
        markers: Mapping[str, tuple[float, float]],
        sigma_px: Sequence[float],
        poses: Sequence[Estimate],
        dock: DockGeometry,
        camera: CameraModel,
        smaller: float = 0.0,
    ) -> Sight | None:
        """From what a method found: ``markers`` with standard deviations in their order;
        ``smaller``: as of ``look.Found``.

        None where the best pose has a marker out of the camera's view.
        """
        points = dock.points[[dock.names.index(name) for name in markers]]
        best = poses[0]
        if not camera.optics.sees(points @ best.R.T + best.t).all():
            return None
        variance = np.square(sigma_px)
        widened = float(np.mean(1 / variance) / np.mean(1 / (variance + FLOOR_PX**2)))
        return cls(
            Sighting(
                points,
                np.array(list(markers.values())),
                np.sqrt(variance + FLOOR_PX**2),
                camera,
            ),
            tuple(
                replace(p, chi_square=p.chi_square / widened, information=p.information / widened)
                for p in poses
            ),
            whole=len(points) == len(dock.points),
            smaller=smaller,
        )

    @property
    def telling(self) -> bool:
        """Whether it is all of the dock, or so much that it says as much as all of four markers:
        three places fit anywhere in several ways, more of them do not."""
        return self.whole or not self.exact

    @property
    def exact(self) -> bool:
        """Whether poses fit its places without any error, whatever their errors are: three markers
        have as many numbers as a pose."""
        return len(self.markers.pixels) == MIN_MARKERS

    def misnamed(self, dock: DockGeometry, R: NDArray[np.float64], t: NDArray[np.float64]) -> bool:
        """Whether markers stand where others of the dock are by a pose (3, 3), (3,).

        So does a row of lamps that is taken for the dock with one lamp more at its end: no motion
        of the vehicle moves a dock by just the distance of its markers.
        """
        own = projected(self.markers.points_dock, R, t, self.markers.camera)
        every = projected(dock.points, R, t, self.markers.camera)
        if own is None or every is None:
            return False
        apart = np.linalg.norm(own[0][:, None] - every[0], axis=2)
        off = np.linalg.norm(self.markers.pixels[:, None] - every[0], axis=2)
        return bool(np.count_nonzero((off < SAME_PLACE * apart).any(axis=1)) >= MIN_OTHERS)

    def worth(self, share: float) -> Sight:
        """The same with ``share`` 0..1 of its information."""
        seen = self.markers
        sigma_px = seen.sigma_px / np.sqrt(max(share, 1e-9))
        return replace(self, markers=replace(seen, sigma_px=sigma_px))
