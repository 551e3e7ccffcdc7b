"""How well it goes, for robot_monitor and Foxglove's diagnostics."""

from __future__ import annotations

from typing import NamedTuple

from chromadock.results.detection import MOST_CLIPPED, Detection
from chromadock.ros.fields import Fields
from chromadock.ros.header import CAMERA_FRAME, header

NAME = "chromadock: dock"
OK, WARN, ERROR = 0, 1, 2

MOST_AGE_S = 0.5
"""A result that is out later helps no one to steer."""


class Summary(NamedTuple):
    """The level and the message of a ``diagnostic_msgs/DiagnosticStatus``."""

    level: int
    message: str


def summary(detection: Detection | None, age_s: float | None, complaint: str | None) -> Summary:
    """How well it goes, in a few words; parameters as those of ``diagnostics``.

    The level is ERROR with a complaint, WARN where results come late or lamps are overexposed, and
    OK otherwise: a dock out of sight is no fault.
    """
    late = age_s is not None and age_s > MOST_AGE_S
    clipped = None if detection is None else detection.clipped
    bright = clipped is not None and clipped > MOST_CLIPPED
    frame = None if detection is None else detection.state
    words = [complaint or _track_state(detection) or frame or "no pictures yet"]
    words += ["results are late"] * late + ["lamps are overexposed"] * bright
    return Summary(ERROR if complaint else WARN if late or bright else OK, ", ".join(words))


def diagnostics(
    detection: Detection | None,
    age_s: float | None,
    dropped: int,
    stamp_ns: int,
    frame_id: str = CAMERA_FRAME,
    rate_hz: float | None = None,
    complaint: str | None = None,
) -> Fields:
    """``diagnostic_msgs/DiagnosticArray``: ``summary``, and as values state, track, latency, rate,
    dropped, clipped.

    Parameters
    ----------
    detection : the newest result; None where there is none.
    age_s : the picture's when its result was out, seconds; None of a recording.
    dropped : frames of the source so far that no result was made of.
    rate_hz : results a second; None of a recording.
    complaint : why no results can be made, in one line; None while they can.
    """
    level, message = summary(detection, age_s, complaint)
    clipped = None if detection is None else detection.clipped
    total_ms = None if detection is None else detection.timing_ms.get("total")
    values = {
        "state": None if detection is None else detection.state,
        "track": _track_state(detection),
        "latency_ms": None if age_s is None else f"{age_s * 1000:.1f}",
        "processing_ms": None if total_ms is None else f"{total_ms:.1f}",
        "rate_hz": None if rate_hz is None else f"{rate_hz:.1f}",
        "dropped": str(dropped),
        "clipped": None if clipped is None else f"{clipped:.3f}",
    }
    return {
        "header": header(stamp_ns, frame_id),
        "status": [
            {
                "level": level,
                "name": NAME,
                "message": message,
                "hardware_id": "chromadock",
                "values": [
                    {"key": key, "value": value}
                    for key, value in values.items()
                    if value is not None
                ],
            }
        ],
    }


def _track_state(detection: Detection | None) -> str | None:
    return None if detection is None or detection.track is None else detection.track.state
