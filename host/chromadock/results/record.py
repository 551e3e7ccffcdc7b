"""A detection as a JSON object, and back.

One place for both ways, so that a field is written and read alike.  Numbers are rounded to what
they are good for.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from chromadock.errors import ChromadockError

if TYPE_CHECKING:
    from pydantic import TypeAdapter

    from chromadock.results.detection import Detection
    from chromadock.results.pose import Pose
    from chromadock.results.track import Track, TrackedPose

SCHEMA = 1
"""Of the JSON object.  One more whenever a key that was there goes or comes to mean another
thing; a further key does not change it."""


def of_detection(detection: Detection) -> dict[str, Any]:
    """See ``Detection.to_dict``."""
    background, marker, misfit = detection.background, detection.marker, detection.misfit
    return {
        "schema": SCHEMA,
        "state": detection.state,
        "found": detection.found,
        "background": {
            "rgb": list(background.rgb),
            "hue_deg": _rounded(background.hue_deg, 2),
            "confidence": _rounded(background.confidence, 3),
        },
        "marker": {
            "rgb": None if marker.rgb is None else list(marker.rgb),
            "hue_deg": _rounded(marker.hue_deg, 2),
            "received_deg": _rounded(marker.received_deg, 2),
            "given": marker.given,
        },
        "observed": {"rgb": None if detection.observed is None else list(detection.observed)},
        "passed_fraction": _rounded(detection.passed_fraction, 6),
        "blobs": [
            [_rounded(b.x, 2), _rounded(b.y, 2), _rounded(b.radius, 2), b.accepted]
            for b in detection.blobs
        ],
        "markers": None
        if detection.markers is None
        else {name: [_rounded(x, 2), _rounded(y, 2)] for name, (x, y) in detection.markers.items()},
        "pose": None if detection.pose is None else _of_pose(detection.pose),
        "evidence": _rounded(detection.evidence, 2),
        "clipped": _rounded(detection.clipped, 3),
        "stops_over": _rounded(detection.stops_over, 1),
        "misfit": None
        if misfit is None
        else {"evidence": _rounded(misfit.evidence, 2), "error_px": _rounded(misfit.error_px, 2)},
        "track": None if detection.track is None else _of_track(detection.track),
        "timing_ms": {stage: _rounded(ms, 2) for stage, ms in detection.timing_ms.items()},
    }


def to_detection(content: Mapping[str, Any]) -> Detection:
    """See ``Detection.from_dict``."""
    from pydantic import ValidationError

    from chromadock.validation import explain

    told = content.get("schema")
    if told != SCHEMA:
        raise ChromadockError(
            f"a detection of schema {told!r}, but this chromadock reads {SCHEMA}: "
            "read it with the version that wrote it"
        )
    try:
        return _adapter().validate_python(_fields(content))
    except KeyError as error:
        raise ChromadockError(
            f"a detection without {error.args[0]}: it is not whole, or no detection"
        ) from None
    except ValidationError as error:
        raise ChromadockError(f"a detection that is none: {explain(error)}") from None
    except (TypeError, AttributeError, ValueError):
        raise ChromadockError("a detection that is none: a key has another form") from None


@cache
def _adapter() -> TypeAdapter[Detection]:
    """Made once: it takes a thousand times as long as a line."""
    from pydantic import TypeAdapter

    from chromadock.results.detection import Detection

    return TypeAdapter(Detection)


_RENAMED = {"velocity_m_s": "velocity", "turn_rate_rad_s": "turn_rate"}
_AS_THEY_ARE = (
    *("state", "background", "marker", "passed_fraction", "markers"),
    *("evidence", "clipped", "stops_over", "misfit", "timing_ms"),
)


def _fields(content: Mapping[str, Any]) -> dict[str, Any]:
    """As the dataclasses have them."""
    track = content["track"]
    return {
        **{key: content[key] for key in _AS_THEY_ARE},
        "observed": content["observed"]["rgb"],
        "blobs": [
            {"x": x, "y": y, "radius": radius, "accepted": accepted}
            for x, y, radius, accepted in content["blobs"]
        ],
        "pose": _pose_fields(content["pose"]),
        "track": None
        if track is None
        else {_RENAMED.get(key, key): value for key, value in track.items()}
        | {key: _pose_fields(track[key]) for key in ("pose", "alternative")},
    }


def _pose_fields(pose: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """Of a frame's pose or of the track's."""
    if pose is None:
        return None
    fields = dict(pose)
    if fields["covariance"] is not None:  # JSON has no NaN
        fields["covariance"] = [math.nan if v is None else v for v in fields["covariance"]]
    if fields.get("alternative") is not None:
        fields["alternative"] = _pose_fields(fields["alternative"])
    return fields


def _of_pose(pose: Pose) -> dict[str, Any]:
    return {
        "t": [_rounded(v, 4) for v in pose.t],
        "q_wxyz": [_rounded(v, 6) for v in pose.q_wxyz],
        "reprojection_px": _rounded(pose.reprojection_px, 3),
        "covariance": None
        if pose.covariance is None
        else [_significant(v, 4) for v in pose.covariance],
        "alternative": None if pose.alternative is None else _of_pose(pose.alternative),
    }


def _of_track(track: Track) -> dict[str, Any]:
    velocity, turn_rate = track.velocity, track.turn_rate
    return {
        "state": track.state,
        "time_s": _rounded(track.time_s, 6),
        "pose": None if track.pose is None else _of_tracked(track.pose),
        "alternative": None if track.alternative is None else _of_tracked(track.alternative),
        "velocity_m_s": None if velocity is None else [_rounded(v, 4) for v in velocity],
        "turn_rate_rad_s": None if turn_rate is None else [_rounded(v, 4) for v in turn_rate],
        "age_s": _rounded(track.age_s, 4),
    }


def _of_tracked(pose: TrackedPose) -> dict[str, Any]:
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
