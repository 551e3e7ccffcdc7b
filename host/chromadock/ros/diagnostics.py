"""How well it goes, for robot_monitor and Foxglove's diagnostics."""

from __future__ import annotations

from chromadock.results.detection import MOST_CLIPPED, Detection
from chromadock.ros.fields import Fields
from chromadock.ros.header import header

NAME = "chromadock: dock"
OK, WARN = 0, 1

MOST_AGE_S = 0.5
"""A result that is out later helps no one to steer."""


def diagnostics(detection: Detection, age_s: float | None, dropped: int, stamp_ns: int) -> Fields:
    """``diagnostic_msgs/DiagnosticArray``: state, track, latency, dropped, clipped.

    Parameters
    ----------
    age_s : the picture's when its result was out, seconds; None of a recording.
    dropped : frames of the source so far that no result was made of.

    The level is OK, and WARN where results come late or lamps are overexposed: a dock out of
    sight is no fault.
    """
    late = age_s is not None and age_s > MOST_AGE_S
    bright = detection.clipped is not None and detection.clipped > MOST_CLIPPED
    state = detection.state if detection.track is None else detection.track.state
    words = [state, *["results are late"] * late, *["lamps are overexposed"] * bright]
    values = {
        "state": detection.state,
        "track": None if detection.track is None else detection.track.state,
        "latency_ms": None if age_s is None else f"{age_s * 1000:.1f}",
        "processing_ms": f"{detection.timing_ms['total']:.1f}"
        if "total" in detection.timing_ms
        else None,
        "dropped": str(dropped),
        "clipped": None if detection.clipped is None else f"{detection.clipped:.3f}",
    }
    return {
        "header": header(stamp_ns),
        "status": [
            {
                "level": WARN if late or bright else OK,
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
