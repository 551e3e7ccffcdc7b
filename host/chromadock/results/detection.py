"""What the detector says of one frame, and how that reads as JSON."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from chromadock.results.pose import Pose
from chromadock.results.track import Track, TrackedPose

RGB = tuple[int, int, int]
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Background:
    """The water's colour: ``rgb`` 0..255, ``hue_deg`` 0..360 (None where the hue
    means nothing: grey water, night), ``confidence`` 0..1."""

    rgb: RGB
    hue_deg: float | None
    confidence: float


@dataclass(frozen=True, slots=True)
class Marker:
    """The colour that is looked for: a pure colour, which the dock's LEDs should show now.

    ``rgb`` 0..255 and ``hue_deg`` 0..360 are None where there is none to prefer; white has
    no hue.  ``given``: ``#RRGGBB``, ``white`` or ``any`` where the colour was given beforehand;
    None where it is worked out from the water's.  ``received_deg``: the hue of the light that
    markers were found to add, None without, or where all of it clips; it differs by some tens of
    degrees where both sides agree, and by more where they do not.
    """

    rgb: RGB | None
    hue_deg: float | None
    received_deg: float | None = None
    given: str | None = None


@dataclass(frozen=True, slots=True)
class Blob:
    """A round spot in the image: centre ``x, y`` and ``radius``, in pixels.

    ``accepted`` is False where the spatial filter threw it out.
    """

    x: float
    y: float
    radius: float
    accepted: bool


@dataclass(frozen=True, slots=True)
class Misfit:
    """Something that stands like a dock but is none as the dock's file has it.

    ``evidence``: decades by which the places, strengths and colours speak for a dock;
    ``error_px``: root mean square distance of its markers from those of the rigid dock.
    """

    evidence: float
    error_px: float


@dataclass(frozen=True, slots=True)
class Detection:
    """Everything one frame told.  Fields that do not apply are None.

    ``state`` and ``evidence``: see ``look.Found``; ``passed_fraction`` the
    share of pixels that stand out in the markers' colour, 0..1; ``observed`` the RGB, 0..255,
    that the camera should see of a marker, None where that may be any; ``markers`` maps the
    dock's marker names to their pixel; ``track`` what all frames so far tell, at this one's time
    (None where frames are treated alone); ``clipped`` the share of the markers, 0..1, whose core
    is overexposed, and ``stops_over`` by how many stops the exposure should be shorter for the
    median of those (see ``overexposure.stops_over``); ``timing_ms`` milliseconds by stage, with
    ``total``.
    """

    state: str
    background: Background
    marker: Marker
    observed: RGB | None
    passed_fraction: float
    blobs: tuple[Blob, ...] = ()
    markers: dict[str, Point] | None = None
    pose: Pose | None = None
    evidence: float | None = None
    track: Track | None = None
    clipped: float | None = None
    stops_over: float | None = None
    misfit: Misfit | None = None
    timing_ms: dict[str, float] = field(default_factory=dict)

    @property
    def found(self) -> bool:
        """True only when a full, consistent constellation was accepted."""
        return self.state == "found"

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of ``chromadock detect --json``, without file and frame."""
        return {
            "state": self.state,
            "found": self.found,
            "background": {
                "rgb": list(self.background.rgb),
                "hue_deg": _rounded(self.background.hue_deg, 2),
                "confidence": _rounded(self.background.confidence, 3),
            },
            "marker": {
                "rgb": None if self.marker.rgb is None else list(self.marker.rgb),
                "hue_deg": _rounded(self.marker.hue_deg, 2),
                "received_deg": _rounded(self.marker.received_deg, 2),
                "given": self.marker.given,
            },
            "observed": {"rgb": None if self.observed is None else list(self.observed)},
            "passed_fraction": _rounded(self.passed_fraction, 6),
            "blobs": [
                [_rounded(b.x, 2), _rounded(b.y, 2), _rounded(b.radius, 2)] for b in self.blobs
            ],
            "markers": None
            if self.markers is None
            else {name: [_rounded(x, 2), _rounded(y, 2)] for name, (x, y) in self.markers.items()},
            "pose": None if self.pose is None else _pose_dict(self.pose),
            "evidence": _rounded(self.evidence, 2),
            "clipped": _rounded(self.clipped, 3),
            "stops_over": _rounded(self.stops_over, 1),
            "misfit": None
            if self.misfit is None
            else {
                "evidence": _rounded(self.misfit.evidence, 2),
                "error_px": _rounded(self.misfit.error_px, 2),
            },
            "track": None if self.track is None else _track_dict(self.track),
            "timing_ms": {stage: _rounded(ms, 2) for stage, ms in self.timing_ms.items()},
        }


def _pose_dict(pose: Pose) -> dict[str, Any]:
    return {
        "t": [_rounded(v, 4) for v in pose.t],
        "q_wxyz": [_rounded(v, 6) for v in pose.q_wxyz],
        "reprojection_px": _rounded(pose.reprojection_px, 3),
        "covariance": None
        if pose.covariance is None
        else [_significant(v, 4) for v in pose.covariance],
        "alternative": None if pose.alternative is None else _pose_dict(pose.alternative),
    }


def _track_dict(track: Track) -> dict[str, Any]:
    velocity, turn_rate = track.velocity, track.turn_rate
    return {
        "state": track.state,
        "pose": None if track.pose is None else _tracked_dict(track.pose),
        "alternative": None if track.alternative is None else _tracked_dict(track.alternative),
        "velocity_m_s": None if velocity is None else [_rounded(v, 4) for v in velocity],
        "turn_rate_rad_s": None if turn_rate is None else [_rounded(v, 4) for v in turn_rate],
        "age_s": _rounded(track.age_s, 4),
    }


def _tracked_dict(pose: TrackedPose) -> dict[str, Any]:
    return {
        "t": [_rounded(v, 4) for v in pose.t],
        "q_wxyz": [_rounded(v, 6) for v in pose.q_wxyz],
        "covariance": [_significant(v, 4) for v in pose.covariance],
        "weight": _rounded(pose.weight, 4),
    }


def _rounded(value: float | None, digits: int) -> float | None:
    """JSON has no NaN or infinity: both become null, like None."""
    if value is None or not math.isfinite(value):
        return None
    return round(value, digits)


def _significant(value: float, digits: int) -> float | None:
    """The same for numbers of any size."""
    return float(f"{value:.{digits}g}") if math.isfinite(value) else None
