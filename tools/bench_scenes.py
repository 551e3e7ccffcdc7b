"""The frames that `make bench` measures on."""

from __future__ import annotations

import sys

import cv2
import numpy as np
from step import ROOT

sys.path.insert(0, str(ROOT / "tests"))
from robust_composites import compose, read

PHOTOGRAPHS = ROOT.parent / "shared" / "data" / "transdec"

VGA = (640, 480)
LARGER = ((1280, 720), (1920, 1080))
# Of the composited docks, metres: all markers bright, and about the limit of one frame.
DOCK_RANGES_M = (2.0, 5.0)


def plain_water(size: tuple[int, int] = VGA) -> np.ndarray:
    """A frame of blue-green water, darker downwards, with a camera's noise.

    ``size``: width, height.  Returns (height, width, 3) uint8 BGR.
    """
    light = np.linspace(1.15, 0.85, size[1])[:, None, None]
    colour = np.array([190.0, 140.0, 40.0])  # blue, green, red
    noise = np.random.default_rng(0).normal(0.0, 3.0, (size[1], size[0], 3))
    return np.clip(colour * light + noise, 0, 255).astype(np.uint8)


def photographs() -> dict[str, np.ndarray]:
    """All photographs of the test data at VGA, by folder and name; those of others are scaled."""
    files = sorted(PHOTOGRAPHS.glob("*/*.jpg"))
    return {f"{path.parent.name}-{path.stem}": read(path) for path in files}


def docks(photograph_bgr: np.ndarray) -> dict[str, np.ndarray]:
    """A dock composited on a photograph at DOCK_RANGES_M, by the scene's name."""
    scenes = {}
    for range_m in DOCK_RANGES_M:
        rng = np.random.default_rng([1, round(1000 * range_m)])
        scenes[f"dock at {range_m:g} m"] = compose(photograph_bgr, range_m, rng).frame_bgr
    return scenes


def enlarged(photograph_bgr: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """A photograph's middle of the same shape as ``size`` (width, height), scaled to it."""
    height, width = photograph_bgr.shape[:2]
    kept = round(width * size[1] / size[0])
    top = (height - kept) // 2
    return cv2.resize(photograph_bgr[top : top + kept], size, interpolation=cv2.INTER_CUBIC)
