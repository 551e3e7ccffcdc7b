"""How well it goes, for robot_monitor and Foxglove's diagnostics."""

from __future__ import annotations

from chromadock.results.detection import MOST_CLIPPED, Detection
from chromadock.ros.fields import Fields
from chromadock.ros.header import CAMERA_FRAME, header

NAME = "chromadock: dock"
OK, WARN, ERROR = 0, 1, 2

MOST_AGE_S = 0.5
"""A result that is out later helps no one to steer."""


def diagnostics(
    detection: Detection | None,
    age_s: float | None,
    dropped: int,
    stamp_ns: int,
    frame_id: str = CAMERA_FRAME,
    rate_hz: float | None = None,
    complaint: str | None = None,
) -> Fields:
    """``diagnostic_msgs/DiagnosticArray``: state, track, latency, rate, dropped, clipped.

    Parameters
    ----------
    detection : the newest result; None where there is none.
    age_s : the picture's when its result was out, seconds; None of a recording.
    dropped : frames of the source so far that no result was made of.
    rate_hz : results a second; None of a recording.
    complaint : why no results can be made, in one line; None while they can.

    The level is ERROR with a complaint, WARN where results come late or lamps are overexposed, and
    OK otherwise: a dock out of sight is no fault.
    """
    late = age_s is not None and age_s > MOST_AGE_S
    clipped = None if detection is None else detection.clipped
    bright = clipped is not None and clipped > MOST_CLIPPED
    frame = None if detection is None else detection.state
    track = None if detection is None or detection.track is None else detection.track.state
    total_ms = None if detection is None else detection.timing_ms.get("total")
    level = ERROR if complaint else WARN if late or bright else OK
    words = [complaint or track or frame or "no pictures yet"]
    words += ["results are late"] * late + ["lamps are overexposed"] * bright
    values = {
        "state": frame,
        "track": track,
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
                "message": ", ".join(words),
                "hardware_id": "chromadock",
                "values": [
                    {"key": key, "value": value}
                    for key, value in values.items()
                    if value is not None
                ],
            }
        ],
    }
