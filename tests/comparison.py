"""C, numpy and golden vectors side by side, every intermediate value."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from chromadock.colour.background import BackgroundColour, background_colour
from chromadock.colour.marker import marker_hue
from chromadock.colour.working_image import (
    RGB565_SCALE,
    RGB888_SCALE,
    smooth,
    unpack_rgb565,
    working_image,
)
from chromadock_firmware import decide


def numpy_decision(data: bytes, width: int, height: int, fmt: str, mapping: str) -> dict[str, Any]:
    """Every intermediate value by the host's numpy code."""
    if fmt == "rgb565":
        pixels, scale = unpack_rgb565(data, width, height), RGB565_SCALE
    else:
        pixels = np.frombuffer(data, np.uint8).reshape(height, width, 3)
        scale = RGB888_SCALE
    working = working_image(pixels, scale)
    smoothed = smooth(working)
    background = background_colour(smoothed)
    values = asdict(background)
    values["bin_counts"] = list(values["bin_counts"])
    return {
        "working": working,
        "smoothed": smoothed,
        **values,
        "marker_hue": marker_hue(background, mapping),
    }


def of_hue(hue: int, meaningful: bool = True) -> BackgroundColour:
    """Water of one hue all over."""
    return BackgroundColour(
        bin_counts=(0, 0, 4800, 0, 0),
        bin=2,
        hue_x=0,
        hue_y=0,
        chroma_sum=4800 * 80,
        saturation_sum=4800 * 160,
        value_sum=4800 * 128,
        hue=hue,
        saturation=160,
        value=128,
        resultant=255,
        share=255,
        confidence=255,
        meaningful=meaningful,
    )


def c_decision(data: bytes, width: int, height: int, fmt: str, mapping: str) -> dict[str, Any]:
    """Every intermediate value by dockcore."""
    decision = decide(data, width, height, fmt, mapping)
    return {
        "working": decision.working,
        "smoothed": decision.smoothed,
        **decision.background,
        "marker_hue": decision.marker_hue,
    }


def assert_same(a: dict[str, Any], b: dict[str, Any], where: str) -> None:
    """Name the first value that differs."""
    assert a.keys() == b.keys(), where
    for name in a:
        same = np.array_equal(a[name], b[name])
        assert same, f"{where}: {name}: {a[name]!r} against {b[name]!r}"
