"""An approach is one dock seen from a vehicle that moves as vehicles do."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice
from pathlib import Path

import cv2
import numpy as np
import pytest

from chromadock.track.attitude import R_BODY_CAMERA_FORWARD
from chromadock.variety import Backdrops, Moment, approach, draw
from chromadock.variety.approach import DURATION_S, RATE_HZ, draw_path
from chromadock.variety.backdrops import backdrop

FIXED = {"camera": "small", "dock": "rectangle", "backdrop": "procedural"}


@pytest.fixture(scope="module")
def moments() -> list[Moment]:
    return [moment for _, moment in islice(approach(1, 1, Backdrops(), **FIXED), 40)]


def test_it_leads_from_seven_metres_to_the_dock_in_steady_steps() -> None:
    for index in range(5):
        path = draw_path(draw(index, 1, Backdrops(), **FIXED))
        assert len(path.time_s) == DURATION_S * RATE_HZ
        assert path.t[0, 2] == pytest.approx(7.0) and path.t[-1, 2] == pytest.approx(0.7)
        assert (np.diff(path.t[:, 2]) < 0).all()
        # Half a metre a second, and a turn of 15 degrees a second at most.
        assert np.abs(np.diff(path.t[:, 2])).max() < 0.06
        assert np.degrees(np.abs(np.diff(path.angles_rad, axis=0))).max() < 1.5


def test_the_dock_moves_smoothly_through_the_picture(moments: list[Moment]) -> None:
    pixels = np.array([m.truth.pixels for m in moments])
    steps = np.linalg.norm(np.diff(pixels, axis=0), axis=2)
    assert 0 < steps.max() < 8
    assert np.linalg.norm(np.diff(pixels, 2, axis=0), axis=2).max() < 3


def test_the_attitude_is_that_of_the_camera_to_a_degree(moments: list[Moment]) -> None:
    for moment in moments:
        attitude = moment.attitude
        assert attitude.yaw_rad is not None
        angles = np.degrees([attitude.roll_rad, attitude.pitch_rad, attitude.yaw_rad])
        assert np.allclose(angles, np.rint(angles))
        # Down, which roll and pitch alone tell, is the y axis of a dock that is level.
        down = (attitude.R_world_body @ R_BODY_CAMERA_FORWARD).T @ (0.0, 0.0, 1.0)
        apart = np.degrees(np.arccos(down @ moment.truth.R[:, 1]))
        assert apart < 1.0
    turns = [m.attitude.yaw_rad for m in moments]
    headings = [np.arctan2(m.truth.R[0, 2], m.truth.R[2, 2]) for m in moments]
    assert np.degrees(np.ptp(headings)) > 3
    assert np.degrees(np.ptp(np.add(turns, headings))) < 1.1


def test_noise_is_fresh_in_each_frame_and_the_water_stays(moments: list[Moment]) -> None:
    first, second = moments[0].frame_bgr.astype(float), moments[1].frame_bgr.astype(float)
    assert not np.array_equal(first, second)
    assert np.abs(first.mean(axis=(0, 1)) - second.mean(axis=(0, 1))).max() < 3
    assert len({m.truth.lamp_rgb for m in moments}) == 1


def test_the_same_seed_makes_the_same_approach(moments: list[Moment]) -> None:
    again = [moment for _, moment in islice(approach(1, 1, Backdrops(), **FIXED), 3)]
    for one, other in zip(again, moments, strict=False):
        assert np.array_equal(one.frame_bgr, other.frame_bgr)
        assert np.array_equal(one.truth.t, other.truth.t)


def test_an_approach_to_no_dock_shows_lamps_and_knows_no_pose() -> None:
    fixed = {**FIXED, "dock": "none", "other_dock": "some", "daylight": "night"}
    scene, moment = next(approach(2, 1, Backdrops(), **fixed))
    assert moment.truth.dock is None and np.isnan(moment.truth.t).all()
    assert not len(moment.truth.in_view)
    assert sum(thing.kind == "lamp" for thing in scene.things) >= 3
    light = moment.frame_bgr.max(axis=2)
    assert light.max() > 3 * np.median(light)


def test_the_backdrop_is_never_mirrored_at_the_frames_edge(tmp_path: Path) -> None:
    """Of a photograph whose red grows to the right and green downwards, so does each frame's."""
    ramp = np.zeros((240, 320, 3), np.uint8)
    ramp[..., 2] = np.linspace(40, 215, 320)
    ramp[..., 1] = np.linspace(40, 215, 240)[:, None]
    file = tmp_path / "ramp.png"
    cv2.imwrite(str(file), ramp)
    scene = replace(draw(1, 1, Backdrops((file,)), **FIXED), photograph=file, mirrored=False)
    moves = [(-0.2, 0.1), (0.1, -0.15)]
    room = (tuple(np.min(moves, axis=0)), tuple(np.max(moves, axis=0)))
    for moved in moves:
        seen = backdrop(scene, (320, 240), moved, 1.15, room)
        assert (np.diff(seen[..., 0], axis=1)[:, 2:-2] > -1e-6).all()
        assert (np.diff(seen[..., 1], axis=0)[2:-2] > -1e-6).all()
    # Without the room it would be.
    assert (np.diff(backdrop(scene, (320, 240), moves[0])[..., 0], axis=1) < 0).any()
