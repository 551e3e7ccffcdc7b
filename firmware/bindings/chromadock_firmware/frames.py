"""Python bytes as the C core's ``frame_t``."""

from __future__ import annotations

import weakref
from typing import Any

from chromadock_firmware._dockcore import ffi, lib

FORMATS = {"rgb565": lib.FRAME_RGB565, "rgb888": lib.FRAME_RGB888}

_pixels_of: weakref.WeakKeyDictionary[Any, Any] = weakref.WeakKeyDictionary()


def c_frame(data: bytes, width: int, height: int, fmt: str, age_ms: int = 0) -> Any:
    """A ``frame_t *`` over a copy of ``data``, which lives as long as the frame.

    ``age_ms`` is the time since the first of its light was gathered; 0 for a picture of now.
    The length is whatever ``data`` has: the core, not this, refuses a wrong one.
    """
    pixels = ffi.new("uint8_t[]", data)
    frame = ffi.new("frame_t *", (pixels, len(data), width, height, FORMATS[fmt], age_ms))
    _pixels_of[frame] = pixels
    return frame
