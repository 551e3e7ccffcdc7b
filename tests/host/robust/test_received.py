"""The hue of the light that markers add, where it clips."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from lit import to_linear
from robust_composites import CAMERA, CROSSTALK, DOCK, Water, add_lamp, photographed

from chromadock.colour.hsv import degrees, rgb_from_hsv
from chromadock.robust.frame.received import received_hue
from chromadock.robust.frame.response import respond

GREEN_WATER = np.array([60.0, 140.0, 60.0])
PLACES = np.array([(120.0, 150.0), (520.0, 150.0), (120.0, 330.0), (520.0, 330.0)])


def received(frame_bgr: np.ndarray, pixels: np.ndarray) -> float | None:
    """Degrees, by a filter for green, which the water has."""
    hue = received_hue(respond(frame_bgr, 512, float(CAMERA.matrix[0, 0])), pixels)
    return None if hue is None else degrees(hue)


def lit_water(lamp: np.ndarray, range_m: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A frame (480, 640, 3) with the dock straight ahead, its lamps in linear RGB, and their
    pixels."""
    rng = np.random.default_rng(seed)
    rgb = np.clip(GREEN_WATER + rng.normal(0, 2, (480, 640, 3)), 0, 255)
    light = to_linear(rgb)
    water = Water(np.full(3, 0.2), to_linear(GREEN_WATER), lamp)
    pixels = CAMERA.project(DOCK.points + np.array([0, 0, range_m]))
    for pixel in pixels:
        add_lamp(light, water, pixel, range_m)
    return photographed(light, rng), pixels


@pytest.mark.parametrize("radiance", [12.0, 60.0, 300.0])
@pytest.mark.parametrize("hue_deg", [0, 60, 120, 180, 240, 300])
def test_lamps_that_clip_are_told_by_their_halo(hue_deg: int, radiance: float) -> None:
    pure = to_linear(np.array(rgb_from_hsv(hue_deg * 1536 // 360, 255, 255)))
    lamp = CROSSTALK @ pure
    frame, pixels = lit_water(radiance * lamp / lamp.max(), 0.9, hue_deg)
    told = received(frame, pixels)
    assert told is not None
    assert abs((told - hue_deg + 180) % 360 - 180) <= 45


def test_where_all_of_the_light_clips_nothing_is_said() -> None:
    """The sum of no cells had the first hue of all, red."""
    rng = np.random.default_rng(1)
    frame = np.clip(GREEN_WATER[::-1] + rng.normal(0, 2, (480, 640, 3)), 0, 255).astype(np.uint8)
    for x, y in PLACES.astype(int).tolist():
        cv2.circle(frame, (x, y), 85, (255, 255, 255), -1)
    assert received(frame, PLACES) is None
