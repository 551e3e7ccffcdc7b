"""How much too bright lamps are, against what shorter exposures of the same scene show."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from lit import to_encoded

from chromadock.robust.frame.overexposure import MOST_STOPS, clipped_at, stops_over
from chromadock.variety import Backdrops, Half, draw, render

PLACES = np.array([(60.0, 60.0), (140.0, 62.0)])
DRAWN, SCENES = 48, 8
"""So many scenes are drawn, of which so many at least are overexposed."""
LEAST_SHARE = 0.5


def lamps(stops: float, scale_px: float) -> np.ndarray:
    """Two lamps in dark water, in the middle so many stops over full scale."""
    y, x = np.mgrid[0:120, 0:200].astype(float)
    light = np.full((120, 200, 3), 0.03)
    for px, py in PLACES:
        away = np.hypot(x - px, y - py)
        light += 2**stops * np.exp(-away / scale_px)[..., None] * np.array([0.1, 0.2, 1.0])
    return to_encoded(light.astype(np.float32))


@pytest.mark.parametrize("scale_px", [2.0, 5.0, 8.0])
@pytest.mark.parametrize("stops", [1.0, 2.0, 3.0, 4.0])
def test_light_that_falls_exponentially_is_followed_to_its_middle(
    stops: float, scale_px: float
) -> None:
    assert stops_over(lamps(stops, scale_px), PLACES) == pytest.approx(stops, abs=0.7)


def test_lamps_that_do_not_clip_are_not_too_bright() -> None:
    assert stops_over(lamps(-0.5, 5.0), PLACES) == 0.0


@pytest.mark.parametrize("places", [PLACES[:1], np.array([(0.0, 0.0), (199.0, 119.0)])])
def test_one_lamp_and_lamps_in_the_corners_are_no_error(places: np.ndarray) -> None:
    white = np.full((120, 200, 3), 255, np.uint8)
    assert 0 <= stops_over(white, places) <= MOST_STOPS
    assert 0 <= stops_over(lamps(3.0, 5.0), places) <= MOST_STOPS


def needed(index: int) -> tuple[float, float] | None:
    """Stops that a drawn scene's exposure is too long by bisection, and as told; None where half
    of its lamps or less clip."""
    scene = draw(index, Half.REPORT.seed(11), Backdrops(), exposure="locked")
    frame, truth = render(scene)
    if clipped_at(frame, truth.pixels).mean() <= LEAST_SHARE:
        return None
    least, most = 0.0, MOST_STOPS
    for _ in range(4):
        middle = (least + most) / 2
        shorter, _ = render(replace(scene, exposure_gain=scene.exposure_gain * 2**-middle))
        clips = clipped_at(shorter, truth.pixels).mean() > LEAST_SHARE
        least, most = (middle, most) if clips else (least, middle)
    return (least + most) / 2, stops_over(frame, truth.pixels)


def test_drawn_scenes_need_about_as_many_stops_less(record_property: pytest.RecordProperty) -> None:
    # Beyond four stops it tells too little; a second look at a shorter exposure tells the rest.
    pairs = [pair for i in range(DRAWN) if (pair := needed(i)) is not None and pair[0] <= 4]
    assert len(pairs) >= SCENES
    off = np.array([told - true for true, told in pairs])
    record_property("median_error_stops", float(np.median(off)))
    assert abs(np.median(off)) < 1.0
    assert all(told > 0 for _, told in pairs)
