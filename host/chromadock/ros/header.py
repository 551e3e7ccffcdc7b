"""Stamps and frames, which all messages of one picture share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from chromadock.ros.fields import Fields

CAMERA_FRAME = "camera_optical_frame"
"""By REP 103: x right, y down, z forward, as OpenCV and Chromadock have it."""

DOCK_FRAME = "dock"
"""The dock's own axes, see ``dock``: z points away from the vehicle that comes."""

VEHICLE_FRAME = "base_link"
"""The vehicle's body by REP 103 and REP 105: x forward, y left, z up."""

_NS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class FrameIds:
    """What the camera's optical frame and the dock's frame are called in the messages."""

    camera: str = CAMERA_FRAME
    dock: str = DOCK_FRAME


FRAME_IDS = FrameIds()
"""The names where nobody has chosen others."""


def header(stamp_ns: int, frame_id: str = CAMERA_FRAME) -> Fields:
    """``std_msgs/Header`` of what a picture of that time, Unix nanoseconds, shows."""
    return {"stamp": time(stamp_ns), "frame_id": frame_id}


def time(stamp_ns: int) -> Fields:
    """``builtin_interfaces/Time`` of Unix nanoseconds."""
    return {"sec": stamp_ns // _NS, "nanosec": stamp_ns % _NS}


def stamp_ns_of(message: Any) -> int:
    """Unix nanoseconds of a message's header; 0 where nobody set it."""
    stamp = message.header.stamp
    return int(stamp.sec) * _NS + int(stamp.nanosec)
