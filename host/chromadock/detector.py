"""The vehicle's side in one object: a frame in, a ``Detection`` out."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import cv2
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
from chromadock.look import Look, Method
from chromadock.paper.method import PaperMethod
from chromadock.robust.method import RobustMethod
from chromadock.stopwatch import Stopwatch
from chromadock.track.attitude import Attitude
from chromadock.track.result import Track
from chromadock.track.tracker import Tracker

_METHODS: dict[str, Callable[[DockGeometry], Method]] = {
    "robust": RobustMethod,
    "paper": PaperMethod,
}
METHODS = tuple(_METHODS)
"""Ways to find the constellation; ``MAPPINGS`` are those to choose the colour."""
DEFAULT_METHOD = "robust"
_TRACKED = frozenset({"robust"})
"""Methods that weigh their evidence and tell how sure a pose is, which a track needs."""

__all__ = ["DEFAULT_METHOD", "MAPPINGS", "METHODS", "Detector"]


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
        Treat each frame alone: no rolling mean of the marker colour, no track.
    tracker
        With extrinsics or a dock of your own; None takes ``Tracker(dock)`` with method
        ``robust``, and none with others.

    Raises
    ------
    ChromadockError
        Where a name is unknown or the dock has a shape that the method cannot find.
    """

    def __init__(
        self,
        camera: CameraModel | None,
        dock: DockGeometry,
        method: str = DEFAULT_METHOD,
        mapping: str = contract.DEFAULT_MAPPING_NAME,
        independent: bool = False,
        tracker: Tracker | None = None,
    ) -> None:
        _check_name("method", method, METHODS)
        _check_name("mapping", mapping, MAPPINGS)
        self._camera = camera
        self._mapping = mapping
        self._rolling = None if independent else RollingHue()
        self._method = _METHODS[method](dock)
        self._tracker = None
        if method in _TRACKED and not independent:
            self._tracker = tracker or Tracker(dock)

    @property
    def mask(self) -> NDArray[np.bool_]:
        """(H, W) bool: the pixels of the last frame that stand out in the markers' colour."""
        return self._method.mask.astype(np.bool_)

    def predicted(self, time_s: float) -> Track | None:
        """The track run on from the newest frame to a time after it, such as now.

        A frame is processed some time after it was taken; this takes the delay out.  None
        where nothing is tracked: ``independent``, or a method that cannot.
        """
        return None if self._tracker is None else self._tracker.at(time_s)

    def process(
        self, frame_bgr: NDArray[np.uint8], time_s: float, attitude: Attitude | None = None
    ) -> Detection:
        """Look for the dock in one frame.

        Parameters
        ----------
        frame_bgr : (H, W, 3) uint8, BGR, at most 5120 x 3840.
        time_s : when it was taken, seconds; any origin, monotonic.  The track does not use a
            frame that is not newer than the last, and starts anew when time goes back by more
            than a second.
        attitude : the vehicle's when the frame was taken, where it is known, for the track.

        Raises
        ------
        ChromadockError
            For another shape or type, a size that the camera is not calibrated for, or a time
            that is not finite.
        """
        _check_frame(frame_bgr)
        if not math.isfinite(time_s):
            raise ChromadockError(f"time_s is {time_s}: give when the frame was taken, in seconds")
        camera = self._camera or _nominal(frame_bgr.shape[1], frame_bgr.shape[0])
        camera.check_size(frame_bgr.shape)
        watch = Stopwatch()

        background = self._background(frame_bgr)
        hue = marker_hue(background, self._mapping)
        if self._rolling is not None:
            hue = self._rolling.add(hue, round(time_s * 1000))
        marker_rgb = rgb_from_hsv(hue, 255, 255)
        observed = observed_colour(background.rgb, marker_rgb)
        watch.lap("colour")

        look = Look(frame_bgr, background, hue, camera)
        track = None
        if self._tracker is None:
            found = self._method.find(look, watch)
        else:
            plan = self._tracker.plan(time_s)
            look = replace(
                look,
                priors=plan.priors,
                everywhere=plan.everywhere,
                incomplete=plan.incomplete,
            )
            found = self._method.find(look, watch)
            track = self._tracker.update(time_s, plan, found, camera, attitude)
            watch.lap("track")
        return Detection(
            state=found.state,
            background=Background(
                background.rgb,
                degrees(background.hue) if background.meaningful else None,
                background.confidence / 255,
            ),
            marker=Marker(
                marker_rgb,
                degrees(hue),
                None if found.hue is None else degrees(found.hue),
            ),
            observed=observed,
            passed_fraction=found.passed_fraction,
            blobs=found.blobs,
            markers=found.markers,
            pose=found.pose,
            evidence=found.evidence,
            estimates=found.estimates,
            track=track,
            timing_ms=watch.stop(),
        )

    @staticmethod
    def _background(frame_bgr: NDArray[np.uint8]) -> BackgroundColour:
        working_rgb = cv2.cvtColor(working_image(frame_bgr), cv2.COLOR_BGR2RGB)
        return background_colour(smooth(np.asarray(working_rgb, np.uint8)))


# One for all frames of a size: what a method prepares for a camera, it need not prepare again.
_nominal = lru_cache(maxsize=4)(CameraModel.nominal)


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
