"""The colour decision stage by stage, for comparison with other versions of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock_firmware._dockcore import ffi, lib
from chromadock_firmware.dock import MAPPINGS
from chromadock_firmware.frames import c_frame

_SHAPE = (lib.METHOD_WORKING_HEIGHT, lib.METHOD_WORKING_WIDTH)


@dataclass(frozen=True, slots=True)
class Decision:
    """Every intermediate value of one frame.

    ``working`` and ``smoothed`` are (60, 80, 3) uint8 RGB; ``background`` holds
    the fields of ``background_t`` with ``hue_sum`` as ``hue_x`` and ``hue_y``.
    """

    working: NDArray[np.uint8]
    smoothed: NDArray[np.uint8]
    background: dict[str, Any]
    marker_hue: int


def decide(data: bytes, width: int, height: int, fmt: str, mapping: str = "ternary") -> Decision:
    """Run the C stages over one frame; ValueError where the core refuses it."""
    frame = c_frame(data, width, height, fmt)
    if not lib.frame_is_valid(frame):
        raise ValueError(f"the core refuses {len(data)} bytes as {width}x{height} {fmt}")
    image = ffi.new("whole_image_t *")
    lib.whole_image_working(image, frame)
    working = _rgb(image)
    lib.whole_image_smoothed(image, frame)
    smoothed = _rgb(image)
    c = ffi.new("background_t *")
    lib.whole_image_background(c, image, 0)
    background: dict[str, Any] = {
        "bin_counts": list(c.bin_counts),
        "hue_x": c.hue_sum.x,
        "hue_y": c.hue_sum.y,
    }
    for name, _ in ffi.typeof("background_t").fields:
        if name not in ("bin_counts", "hue_sum"):
            background[name] = getattr(c, name)
    return Decision(
        working,
        smoothed,
        background,
        lib.marker_hue(c, MAPPINGS[mapping], lib.METHOD_FALLBACK_HUE),
    )


def hsv_from_rgb(
    rgb: NDArray[np.uint8], hue_range: int = lib.METHOD_HUE_RANGE
) -> tuple[NDArray[np.uint16], NDArray[np.uint8], NDArray[np.uint8]]:
    """Hue, saturation and value of (N, 3) uint8 RGB; hue_range 1536, 180 or 256."""
    rgb = np.ascontiguousarray(rgb)
    n = len(rgb)
    hue = np.empty(n, np.uint16)
    saturation, value = np.empty(n, np.uint8), np.empty(n, np.uint8)
    lib.hsv_convert(
        ffi.from_buffer("uint8_t[]", rgb),
        n,
        hue_range,
        ffi.from_buffer("uint16_t[]", hue),
        ffi.from_buffer("uint8_t[]", saturation),
        ffi.from_buffer("uint8_t[]", value),
    )
    return hue, saturation, value


def _rgb(image: Any) -> NDArray[np.uint8]:
    """The packed pixels of a ``whole_image_t`` as (60, 80, 3) uint8."""
    words = np.frombuffer(ffi.buffer(image), dtype=np.uint32).reshape(_SHAPE)
    channels = (words >> lib.PIXEL_RED_SHIFT, words >> lib.PIXEL_GREEN_SHIFT, words)
    return np.stack([c & 0xFF for c in channels], axis=-1).astype(np.uint8)
