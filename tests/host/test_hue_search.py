from __future__ import annotations

import numpy as np
import pytest
from lit import to_linear
from robust_composites import CAMERA, CROSSTALK, DOCK, LED_RADIANCE, Water, add_lamp, photographed

from chromadock import Detector
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.hue_search import HOLD_LOOKS, OFFSET_STEP, HueSearch
from chromadock.method import HUE_RANGE

WATER_RGB = np.array([40.0, 140.0, 190.0])
EXPECTED_HUE = 1365  # of a marker in this water, ternary


def test_every_second_look_is_at_the_expected_hue_and_all_others_get_their_turn() -> None:
    search, looks = HueSearch(), []
    for _ in range(20):
        looks.append(search.offset)
        search.looked(found=False, locked=False)
    assert set(looks[::2]) == {0}
    reached = {offset % HUE_RANGE for offset in looks}
    assert reached == {k * OFFSET_STEP for k in range(6)}


def test_what_found_something_is_kept_until_it_finds_no_more() -> None:
    search = HueSearch()
    while search.offset != 2 * OFFSET_STEP:
        search.looked(found=False, locked=False)
    search.looked(found=True, locked=False)
    for _ in range(HOLD_LOOKS - 1):
        assert search.offset == 2 * OFFSET_STEP
        search.looked(found=False, locked=False)
    search.looked(found=False, locked=False)
    assert search.offset != 2 * OFFSET_STEP


def test_a_lock_makes_its_hue_the_one_that_is_tried_first() -> None:
    search = HueSearch()
    while search.offset != -OFFSET_STEP:
        search.looked(found=False, locked=False)
    search.looked(found=True, locked=True)
    looks = []
    for _ in range(HOLD_LOOKS + 8):
        search.looked(found=False, locked=False)
        looks.append(search.offset)
    after = looks[HOLD_LOOKS - 1 :]
    assert after[1::2] == [-OFFSET_STEP] * len(after[1::2])
    assert 0 in after


@pytest.mark.parametrize("off_deg", [0, 40, 110, 180, -120])
def test_a_dock_of_another_hue_is_locked_and_its_hue_told(off_deg: int) -> None:
    pure = to_linear(
        np.array(rgb_from_hsv((EXPECTED_HUE + off_deg * 1536 // 360) % 1536, 255, 255))
    )
    lamp = CROSSTALK @ pure
    shone = Water(np.full(3, 0.3), to_linear(WATER_RGB), LED_RADIANCE * lamp / lamp.max())
    detector = Detector(CAMERA, DOCK)
    for frame in range(40):
        rng = np.random.default_rng([off_deg % 360, frame])
        noise = rng.normal(0, 2, (480, 640, 3))
        light = to_linear(np.clip(WATER_RGB + noise, 0, 255))
        for point in DOCK.points + np.array([0.1 + 0.002 * frame, 0.05, 2.5]):
            add_lamp(light, shone, CAMERA.project(point)[0], float(np.linalg.norm(point)))
        detection = detector.process(photographed(light, rng), frame / 15)
        assert detection.track is not None
        if detection.track.state == "tracking":
            break
    assert detection.track.state == "tracking", "not within 40 frames"
    assert detection.marker.hue_deg == pytest.approx(EXPECTED_HUE * 360 / 1536, abs=6)
    assert detection.marker.received_deg is not None
    apart = abs(detection.marker.received_deg - detection.marker.hue_deg - off_deg) % 360
    assert min(apart, 360 - apart) <= 45
