"""Stamps and frames, which all messages of one picture share."""

from __future__ import annotations

from chromadock.ros.fields import Fields

CAMERA_FRAME = "camera_optical_frame"
"""By REP 103: x right, y down, z forward, as OpenCV and Chromadock have it."""

DOCK_FRAME = "dock"
"""The dock's own axes, see ``dock``: z points away from the vehicle that comes."""

VEHICLE_FRAME = "base_link"
"""The vehicle's body by REP 103 and REP 105: x forward, y left, z up."""

_NS = 1_000_000_000


def header(stamp_ns: int) -> Fields:
    """``std_msgs/Header`` of what a picture of that time, Unix nanoseconds, shows."""
    return {"stamp": time(stamp_ns), "frame_id": CAMERA_FRAME}


def time(stamp_ns: int) -> Fields:
    """``builtin_interfaces/Time`` of Unix nanoseconds."""
    return {"sec": stamp_ns // _NS, "nanosec": stamp_ns % _NS}
