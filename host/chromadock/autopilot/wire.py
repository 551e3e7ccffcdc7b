"""Messages of MAVLink 2's common dialect, as pymavlink has them."""

from __future__ import annotations

from typing import Any

from pymavlink.dialects.v20 import common as mavlink

Message = Any
"""One of ``pymavlink.dialects.v20.common``."""

MAVLINK1_START = 0xFE
"""First byte of a message by MAVLink 1."""


def decoded(message: Message) -> Message:
    """The message as a receiver gets it: after it went over the wire, in 32-bit numbers."""
    sender = mavlink.MAVLink(None, 1, mavlink.MAV_COMP_ID_ONBOARD_COMPUTER)
    return mavlink.MAVLink(None).parse_char(message.pack(sender))
