"""A dock that shows another hue than the one which this camera's water says."""

from __future__ import annotations

import numpy as np
import pytest
from lit import to_linear
from robust_composites import CAMERA, CROSSTALK, DOCK, LED_RADIANCE, Water, add_lamp, photographed

from chromadock import Detector
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.track.candidate import LOCK_FRAMES

WATER_RGB = np.array([40.0, 140.0, 190.0])
EXPECTED_HUE = 1365  # of a marker in this water, ternary


@pytest.mark.parametrize("off_deg", [0, 40, 110, 180, -120])
def test_a_dock_of_another_hue_is_locked_as_soon_as_any_and_its_hue_told(off_deg: int) -> None:
    pure = to_linear(
        np.array(rgb_from_hsv((EXPECTED_HUE + off_deg * 1536 // 360) % 1536, 255, 255))
    )
    lamp = CROSSTALK @ pure
    shone = Water(np.full(3, 0.3), to_linear(WATER_RGB), LED_RADIANCE * lamp / lamp.max())
    detector = Detector(CAMERA, DOCK)
    for frame in range(1 + LOCK_FRAMES):
        rng = np.random.default_rng([off_deg % 360, frame])
        noise = rng.normal(0, 2, (480, 640, 3))
        light = to_linear(np.clip(WATER_RGB + noise, 0, 255))
        # The first frame is of water alone, after which nothing may be looked for elsewhere.
        for point in DOCK.points[: 4 * (frame > 0)] + np.array([0.1 + 0.002 * frame, 0.05, 2.5]):
            add_lamp(light, shone, CAMERA.project(point)[0], float(np.linalg.norm(point)))
        detection = detector.process(photographed(light, rng), frame / 15)
        assert detection.found == (frame > 0)
    assert detection.track is not None and detection.track.state == "tracking"
    assert detection.marker.hue_deg == pytest.approx(EXPECTED_HUE * 360 / 1536, abs=6)
    assert detection.marker.received_deg is not None
    apart = abs(detection.marker.received_deg - detection.marker.hue_deg - off_deg) % 360
    assert min(apart, 360 - apart) <= 45
