"""The vehicle's side in one object: a frame in, a ``Detection`` out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock import method as contract
from chromadock.camera import CameraModel
from chromadock.colour.background import BackgroundColour, background_colour
from chromadock.colour.hsv import degrees, rgb_from_hsv
from chromadock.colour.marker import MAPPINGS, RollingHue, marker_hue, observed_colour
from chromadock.colour.working_image import smooth, working_image
from chromadock.detection import Background, Detection, Marker
from chromadock.dock import DockGeometry
from chromadock.errors import ChromadockError
from chromadock.paper.method import PaperMethod
from chromadock.stopwatch import Stopwatch

METHODS = ("paper",)
"""Ways to find the constellation; ``MAPPINGS`` are those to choose the colour."""

__all__ = ["MAPPINGS", "METHODS", "Detector"]


class Detector:
    """Finds the dock in one frame after the other.

    Parameters
    ----------
    camera
        The vehicle's camera; None takes ``CameraModel.nominal`` of each frame's size.
    dock
        Where the markers sit.
    method
        One of ``METHODS``.
    mapping
        One of ``MAPPINGS``; the dock must use the same.
    independent
        Treat each frame alone: no rolling mean of the marker colour.

    Raises
    ------
    ChromadockError
        Where a name is unknown or the dock has a shape that the method cannot find.
    """

    def __init__(
        self,
        camera: CameraModel | None,
        dock: DockGeometry,
        method: str = "paper",
        mapping: str = contract.DEFAULT_MAPPING_NAME,
        independent: bool = False,
    ) -> None:
        _check_name("method", method, METHODS)
        _check_name("mapping", mapping, MAPPINGS)
        self._camera = camera
        self._mapping = mapping
        self._rolling = None if independent else RollingHue()
        self._method = PaperMethod(dock)

    @property
    def mask(self) -> NDArray[np.bool_]:
        """(H, W) bool: the pixels of the last frame that passed the colour mask."""
        return self._method.mask.astype(np.bool_)

    def process(self, frame_bgr: NDArray[np.uint8], time_s: float) -> Detection:
        """Look for the dock in one frame.

        Parameters
        ----------
        frame_bgr : (H, W, 3) uint8, BGR, at most 5120 x 3840.
        time_s : when it was taken, seconds; any origin, monotonic.

        Raises
        ------
        ChromadockError
            For another shape or type, or a size that the camera is not calibrated for.
        """
        _check_frame(frame_bgr)
        camera = self._camera or CameraModel.nominal(frame_bgr.shape[1], frame_bgr.shape[0])
        camera.check_size(frame_bgr.shape)
        watch = Stopwatch()

        background = self._background(frame_bgr)
        hue = marker_hue(background, self._mapping)
        if self._rolling is not None:
            hue = self._rolling.add(hue, round(time_s * 1000))
        marker_rgb = rgb_from_hsv(hue, 255, 255)
        observed = observed_colour(background.rgb, marker_rgb)
        watch.lap("colour")

        found = self._method.find(frame_bgr, background.bin, observed, camera, watch)
        return Detection(
            state="not_found" if found.pose is None else "found",
            background=Background(
                background.rgb,
                degrees(background.hue) if background.meaningful else None,
                background.confidence / 255,
            ),
            marker=Marker(marker_rgb, degrees(hue)),
            observed=observed,
            passed_fraction=found.passed_fraction,
            blobs=found.blobs,
            markers=found.markers,
            pose=found.pose,
            timing_ms=watch.stop(),
        )

    @staticmethod
    def _background(frame_bgr: NDArray[np.uint8]) -> BackgroundColour:
        working_bgr = working_image(frame_bgr)
        return background_colour(smooth(np.ascontiguousarray(working_bgr[..., ::-1])))


def _check_name(what: str, name: str, known: tuple[str, ...]) -> None:
    if name not in known:
        raise ChromadockError(f"unknown {what} '{name}': choose one of {', '.join(known)}")


def _check_frame(frame: NDArray[np.uint8]) -> None:
    if frame.ndim != 3 or frame.shape[2] != 3 or frame.dtype != np.uint8:
        raise ChromadockError(
            f"a frame of shape {frame.shape} and type {frame.dtype}: "
            "it must be height x width x 3, uint8, BGR"
        )
    height, width = frame.shape[:2]
    if not (0 < width <= contract.MAX_FRAME_WIDTH and 0 < height <= contract.MAX_FRAME_HEIGHT):
        raise ChromadockError(
            f"a frame of {width}x{height} pixels: it must have at least one and at most "
            f"{contract.MAX_FRAME_WIDTH}x{contract.MAX_FRAME_HEIGHT}; scale it down"
        )
