"""Docks whose lamps do not show before bright water, but whose black holders do."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from lit import to_encoded

from chromadock import CameraModel, Detection, Detector, DockGeometry
from chromadock.geometry.pose import projected
from chromadock.robust.frame.peaks import find_peaks
from chromadock.robust.frame.refine import refined
from chromadock.robust.frame.response import respond
from chromadock.robust.weigh.acceptance import doubt_of_size

CAMERA, DOCK = CameraModel.nominal(640, 480), DockGeometry.default()
WATER, LAMP = np.array([0.35, 0.25, 0.03]), np.array([0.4, 0.1, 0.05])
"""Linear BGR."""


def places(t: tuple[float, float, float]) -> np.ndarray:
    """(4, 2) pixels of the default dock's markers, at ``t`` metres and facing the camera."""
    seen = projected(DOCK.points, np.eye(3), np.array(t), CAMERA)
    assert seen is not None
    return np.asarray(seen[0])


def picture(xy: np.ndarray, radius_px: float, lamp: float = 0.0, seed: int = 1) -> np.ndarray:
    """Bright water with black discs at (n, 2) pixels, each with a lamp in its middle."""
    y, x = np.mgrid[0:480, 0:640].astype(np.float32)
    light = np.tile(WATER, (480, 640, 1)) * (1 + 0.3 * (y[..., None] / 480 - 0.5))
    for px, py in xy:
        away = np.hypot(x - px, y - py)
        inside = np.clip(radius_px + 0.5 - away, 0, 1)[..., None]
        light = light * (1 - 0.8 * inside)
        light += lamp * np.exp(-0.5 * (away / (0.35 * radius_px)) ** 2)[..., None] * LAMP
    light = cv2.GaussianBlur(light, (0, 0), 0.8)
    grain = np.random.default_rng(seed).normal(0, 2, light.shape)
    encoded = to_encoded(np.asarray(light, np.float32))
    return np.asarray(np.clip(np.rint(encoded + grain), 0, 255), np.uint8)


def detected(frame: np.ndarray) -> Detection:
    return Detector(CAMERA, DOCK, mapping="ternary", independent=True).process(frame, 0.0)


@pytest.mark.parametrize("lamp", [0.0, 0.3, 0.6])
@pytest.mark.parametrize(("range_m", "radius_px"), [(1.5, 9.0), (2.5, 6.0), (4.0, 4.0)])
def test_a_dock_is_found_by_its_holders(range_m: float, radius_px: float, lamp: float) -> None:
    t = (0.1, 0.2, range_m)
    told = detected(picture(places(t), radius_px, lamp))
    assert told.markers is not None
    found = np.array([told.markers[name] for name in DOCK.names])
    assert np.abs(found - places(t)).max() < 1.0
    # Nothing shines whose hue could be told.
    assert told.marker.received_deg is None
    if told.pose is not None:
        assert np.linalg.norm(np.array(told.pose.t) - t) < 0.05 * range_m
    assert told.found or range_m > 3


def test_holders_that_stand_otherwise_are_no_dock() -> None:
    xy = places((0.1, 0.2, 2.0))
    xy[1] += (0, 60)
    xy[2] -= (90, 0)
    assert detected(picture(xy, 7.0)).markers is None


@pytest.mark.parametrize("halo_px", [6.0, 12.0, 25.0])
def test_nothing_is_dark_beside_a_bright_light(halo_px: float) -> None:
    """Its light makes the surround of what is beside it bright, and so this seem dark."""
    y, x = np.mgrid[0:480, 0:640].astype(np.float32)
    away = np.hypot(x - 320, y - 240)
    shine = 3.0 * (away < 6) + np.exp(-away / halo_px)
    light = 0.3 * WATER + shine[..., None] * np.array([0.05, 0.2, 1.0])
    grain = np.random.default_rng(2).normal(0, 2, light.shape)
    frame = np.clip(to_encoded(light.astype(np.float32)) + grain, 0, 255).astype(np.uint8)
    response = respond(frame, 300, 512.0)
    assert response.dark is not None
    for peaks in find_peaks(response.dark).values():
        assert len(peaks.snr) == 0
    # It does seem so to the filters.
    assert response.dark.snr[response.layout.inside(1)].max() > 10


def test_the_least_dark_middle_of_a_holder_draws_no_place_aside() -> None:
    xy = places((0.0, 0.0, 2.5)) + 0.3
    for seed in range(5):
        frame = picture(xy, 7.0, 0.6, seed=seed)
        dark = respond(frame, 300, 512.0).dark
        assert dark is not None
        tops = refined(frame, xy + 1.5, 4, dark, np.full(4, 1.0))
        assert tops is not None
        assert np.abs(np.array([top.xy[0] for top in tops]) - xy).max() < 0.6


def test_lamps_are_looked_for_first() -> None:
    told = detected(picture(places((0.1, 0.2, 2.0)), 7.0, 4.0))
    assert told.found
    assert told.marker.received_deg is not None


@pytest.mark.parametrize(("smaller", "doubt"), [(0.0, 0.0), (0.025, 0.0455), (0.05, 0.3173)])
def test_a_size_that_may_be_off_makes_a_range_doubtful(smaller: float, doubt: float) -> None:
    assert doubt_of_size(smaller) == pytest.approx(doubt, abs=1e-4)


@pytest.mark.parametrize(("bars", "state"), [(False, "found"), (True, "uncertain")])
def test_dark_bars_which_draw_all_holders_together_leave_no_pose(bars: bool, state: str) -> None:
    xy = places((0.1, 0.1, 3.0))
    frame = picture(xy, 5.0)
    if bars:
        barred = frame.copy()
        for ends in (xy[:2], xy[2:]):
            (left, right) = np.rint(16 * ends).astype(int).tolist()
            cv2.line(barred, left, right, (0, 0, 0), 5, cv2.LINE_AA, 4)
        frame = cv2.addWeighted(frame, 0.2, barred, 0.8, 0)
    told = detected(frame)
    assert told.state == state
    assert (told.pose is None) == bars
