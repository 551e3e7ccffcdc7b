"""The vehicle's side in one object: a frame in, a ``Detection`` out."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from chromadock import method as contract
from chromadock.camera import CameraModel
from chromadock.choices import (
    DEFAULT_MAPPING,
    DEFAULT_METHOD,
    FALLBACK_HUE_DEG,
    HUE_MOST_DEG,
    MAPPINGS,
    METHODS,
)
from chromadock.colour.background import BackgroundColour
from chromadock.colour.hsv import degrees, nearest_hue
from chromadock.colour.marker import SteadyHue, marker_hue, observed_colour
from chromadock.colour.vehicle import vehicle_background
from chromadock.dock import DockGeometry
from chromadock.errors import ChromadockError
from chromadock.look import Look, Method
from chromadock.marker_colour import MarkerColour
from chromadock.mounting import Mounting, mounting_or_default
from chromadock.paper.method import PaperMethod
from chromadock.results.detection import Background, Detection, Marker
from chromadock.results.track import Track
from chromadock.robust.method import RobustMethod
from chromadock.stopwatch import Stopwatch
from chromadock.track.attitude import Attitude, expected_if_told
from chromadock.track.tracker import Tracker

_METHODS: dict[str, Callable[[DockGeometry], Method]] = {
    "robust": RobustMethod,
    "paper": PaperMethod,
}
_TRACKED = frozenset({"robust"})
"""Methods that weigh their evidence and tell how sure a pose is, which a track needs."""
_MASKED = frozenset({"paper"})
"""Methods that look at pixels of one colour only."""

__all__ = ["DEFAULT_METHOD", "FALLBACK_HUE_DEG", "MAPPINGS", "METHODS", "Detector"]


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
    marker_colour
        What the markers shine in, where the dock does not choose it by the water:
        ``#RRGGBB``, ``white`` or ``any``, or the same parsed.  None takes ``dock.colour``; where
        that is None too, the colour is worked out from the water's by ``mapping``.
    fallback_hue_deg
        Of the markers in grey water and at night, 0 .. 359.77; the dock's ``FALLBACK_HUE``
        must be the same.
    independent
        Treat each frame alone: no rolling mean of the marker colour, no track.
    mounting
        How the camera sits in the vehicle and how the dock hangs, for the search and the track;
        None for an upright camera that looks ahead and a level dock that faces the approach.

    Raises
    ------
    ChromadockError
        Where a name, a colour, a hue or the mounting is none, or the dock has a shape or
        colour that the method cannot find.
    """

    def __init__(
        self,
        camera: CameraModel | None,
        dock: DockGeometry,
        method: str = DEFAULT_METHOD,
        mapping: str = DEFAULT_MAPPING,
        independent: bool = False,
        mounting: Mounting | None = None,
        marker_colour: MarkerColour | str | None = None,
        fallback_hue_deg: float = FALLBACK_HUE_DEG,
    ) -> None:
        _check_name("method", method, METHODS)
        _check_name("mapping", mapping, MAPPINGS)
        self._camera = camera
        self._mapping = mapping
        given = dock.colour if marker_colour is None else marker_colour
        self._given = MarkerColour.parse(given) if isinstance(given, str) else given
        if method in _MASKED and self._given is not None and self._given.kind == "any":
            raise ChromadockError(
                f"method {method} cannot look for markers of any colour: "
                f"give their colour, or choose method {DEFAULT_METHOD}"
            )
        self._fallback_hue = _fallback_hue(fallback_hue_deg)
        self._steady = None if independent else SteadyHue()
        self._method = _METHODS[method](dock)
        mounting_or_default(mounting)  # refuses what is none
        self._mounting = mounting
        self._tracker = None
        if method in _TRACKED and not independent:
            self._tracker = Tracker(dock, mounting)

    @property
    def mask(self) -> NDArray[np.bool_]:
        """(H, W) bool: the pixels of the last frame that stand out in the markers' colour."""
        return self._method.mask.astype(np.bool_)

    def predicted(self, time_s: float) -> Track | None:
        """The track run on from the newest frame to a time after it, such as now.

        A frame is processed some time after it was taken; this takes the delay out.  Any thread
        may ask, also while another is in ``process``: the answer is by the frames processed so
        far.  None where nothing is tracked: ``independent``, or a method that cannot.
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
        attitude : the vehicle's when the frame was taken, where it is known: for the track, and
            so that the search knows how the dock is turned.

        Raises
        ------
        ChromadockError
            For another shape or type, a size that the camera is not calibrated for, a time that
            is not finite, or an attitude that is none.
        """
        _check_frame(frame_bgr)
        if attitude is not None and not isinstance(attitude, Attitude):
            raise ChromadockError(
                f"attitude is a {type(attitude).__name__}: give Attitude(roll_rad, pitch_rad, "
                "yaw_rad)"
            )
        if not math.isfinite(time_s):
            raise ChromadockError(f"time_s is {time_s}: give when the frame was taken, in seconds")
        camera = self._camera or _nominal(frame_bgr.shape[1], frame_bgr.shape[0])
        camera.check_size(frame_bgr.shape)
        watch = Stopwatch()

        background = vehicle_background(frame_bgr)
        hue = self._expected_hue(background, time_s)
        kind = "hue" if self._given is None else self._given.kind
        look = Look(frame_bgr, background, hue, camera, colour=kind)
        marker_rgb = look.marker_rgb
        watch.lap("colour")

        track = None
        if self._tracker is None:
            R_expected, R_covariance = expected_if_told(attitude, self._mounting)
            if R_expected is not None:
                look = replace(look, R_expected=R_expected, R_covariance=R_covariance)
            found = self._method.find(look, watch)
        else:
            plan = self._tracker.plan(time_s, attitude)
            look = replace(
                look,
                priors=plan.priors,
                everywhere=plan.everywhere,
                incomplete=plan.incomplete,
                R_expected=plan.R_expected,
                R_covariance=plan.R_covariance,
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
                degrees(hue) if kind == "hue" else None,
                None if found.hue is None else degrees(found.hue),
                None if self._given is None else self._given.text,
            ),
            observed=None if marker_rgb is None else observed_colour(background.rgb, marker_rgb),
            passed_fraction=found.passed_fraction,
            blobs=found.blobs,
            markers=found.markers,
            pose=found.pose,
            evidence=found.evidence,
            track=track,
            clipped=found.clipped,
            stops_over=found.stops_over,
            misfit=found.misfit,
            timing_ms=watch.stop(),
        )

    def _expected_hue(self, background: BackgroundColour, time_s: float) -> int:
        """Hue 0..1535 of the markers: as given, or as an adaptive dock shows it now."""
        if self._given is not None and self._given.hue is not None:
            return self._given.hue
        hue = marker_hue(background, self._mapping, self._fallback_hue)
        if self._steady is None:
            return hue
        return self._steady.add(background.meaningful, hue, round(time_s * 1000))


# One for all frames of a size: what a method prepares for a camera, it need not prepare again.
_nominal = lru_cache(maxsize=4)(CameraModel.nominal)


def _check_name(what: str, name: str, known: tuple[str, ...]) -> None:
    if name not in known:
        raise ChromadockError(f"unknown {what} '{name}': choose one of {', '.join(known)}")


def _fallback_hue(hue_deg: float) -> int:
    """Hue 0..1535 of what a user set."""
    try:
        return nearest_hue(hue_deg)
    except ValueError:
        raise ChromadockError(
            f"the fallback hue is {hue_deg:g}: give degrees, 0 .. {HUE_MOST_DEG:.2f}, "
            "the same as the dock's FALLBACK_HUE"
        ) from None


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
