"""A picture shows what its truth says."""

from __future__ import annotations

import time

import cv2
import numpy as np
import pytest

from chromadock.variety import Backdrops, Half, Scene, draw, picture, render
from chromadock.variety.lamps import Lamp, add_lamp

CLEAR: dict[str, str | float] = {
    "backdrop": "procedural", "attenuation": 0.25, "daylight": "night", "exposure": "locked",
    "white_balance": "locked", "radiance": 8, "shake_px": 0, "distance": "3", "build": "lamps",
    "colour": "white", "jpeg_quality": 95, "halo_rad": 0.006, "exposure_gain": 1, "unlikeness": 0,
    "buoys": "none", "posts": "none", "boxes": "none", "single_lamp": "none", "diver": "none",
    "own_colour": "none", "other_dock": "none",
}  # fmt: skip


def test_the_same_scene_gives_the_same_picture() -> None:
    scene = draw(2, 1, Backdrops(), camera="vga")
    (frame, _), (again, _) = render(scene), render(scene)
    assert np.array_equal(frame, again)
    assert not np.array_equal(frame, render(draw(3, 1, Backdrops(), camera="vga"))[0])


@pytest.mark.parametrize("camera", ["vga", "wide", "tele", "interlaced"])
@pytest.mark.parametrize("dock", ["rectangle", "ring"])
def test_lamps_are_where_the_truth_says(camera: str, dock: str) -> None:
    scene = draw(1, 1, Backdrops(), camera=camera, dock=dock, **CLEAR)
    frame, truth = render(scene)
    assert truth.in_view.all()
    grey = frame.astype(np.float64).sum(axis=2)
    y, x = np.mgrid[: grey.shape[0], : grey.shape[1]]
    for pixel in truth.pixels:
        near = np.hypot(x - pixel[0], y - pixel[1]) < 9
        weight = np.clip(grey[near] - 150, 0, None)
        assert weight.max() > 300
        centre = np.array([x[near] @ weight, y[near] @ weight]) / weight.sum()
        assert np.hypot(*(centre - pixel)) < 0.7


def test_the_truth_is_the_projection_of_the_dock() -> None:
    scene = draw(4, 1, Backdrops())
    _, truth = render(scene)
    assert truth.dock is not None
    again = truth.camera.project(truth.dock.points @ truth.R.T + truth.t)
    assert np.allclose(again, truth.pixels)
    assert len(truth.pixels) == len(truth.dock.names) == len(scene.lamp_gains)


def test_a_picture_without_a_dock_has_lamps_only_where_things_shine() -> None:
    fixed = CLEAR | {"single_lamp": "some", "dock": "none", "camera": "vga"}
    scene = draw(2, 1, Backdrops(), **fixed)
    frame, truth = render(scene)
    assert truth.dock is None and not len(truth.pixels) and np.isnan(truth.t).all()
    places = np.array([thing.place for thing in scene.things]) @ scene.R.T + scene.t
    bright = np.argwhere(frame.max(axis=2) > 200)[:, ::-1]
    assert len(bright)
    apart = np.linalg.norm(bright[:, None] - truth.camera.project(places), axis=2).min(axis=1)
    assert apart.max() < 40


def test_a_near_lamp_is_a_disc_of_its_true_size_and_does_not_grow_with_its_light() -> None:
    sizes = []
    for radiance in (3.0, 30.0):
        light = np.zeros((121, 121, 3), np.float32)
        lamp = Lamp(np.array([60.0, 60.0]), 20.0, 0.5, np.full(3, radiance))
        add_lamp(light, lamp, np.zeros(3), 0.5, 6.0, 1.0)
        sizes.append(np.sqrt((light[..., 0] > 1).sum() / np.pi))
    assert sizes[0] == pytest.approx(20, abs=0.7)
    assert sizes[1] == pytest.approx(sizes[0], abs=1.2)


@pytest.mark.parametrize("profile", ["disc", "dome", "bulb"])
@pytest.mark.parametrize("radius_px", [0.4, 3.0, 12.0])
def test_a_lamps_light_is_that_of_its_face(profile: str, radius_px: float) -> None:
    light = np.zeros((301, 301, 3), np.float32)
    lamp = Lamp(np.array([150.3, 149.8]), radius_px, 2.0, np.array([5.0, 2.0, 1.0]), profile)
    add_lamp(light, lamp, np.full(3, 0.6), 0.5, 5.0, 1.0)
    straight_and_scattered = np.exp(-0.5 * 0.6 * 2.0)
    expected = np.pi * radius_px**2 * lamp.light * straight_and_scattered
    assert light.sum(axis=(0, 1)) == pytest.approx(expected, rel=0.04)


def test_jpeg_comes_last(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = draw(2, 1, Backdrops(), camera="vga", jpeg_quality=62, subsampling="4:2:0")
    frame, _ = render(scene)
    made = []
    monkeypatch.setattr(
        picture, "through_jpeg", lambda p, quality, sub: made.append((p, quality, sub)) or p
    )
    raw, _ = render(scene)
    assert made[0][1:] == (62, "4:2:0")
    data = cv2.imencode(".jpg", raw, [cv2.IMWRITE_JPEG_QUALITY, 62])[1]
    assert np.array_equal(cv2.imdecode(data, cv2.IMREAD_COLOR), frame)
    assert not np.array_equal(raw, frame)


def test_night_is_darker_and_an_automatic_exposure_makes_up_for_dusk() -> None:
    def mean(**fixed: str) -> float:
        scene = draw(6, 1, Backdrops(), camera="small", dock="none", waters="turquoise", **fixed)
        return float(render(scene)[0].mean())

    day = mean(daylight="day", exposure="locked")
    assert mean(daylight="night", exposure="locked") < 0.6 * day
    assert mean(daylight="dusk", exposure="automatic") > 1.2 * mean(
        daylight="dusk", exposure="locked", exposure_gain="1"
    )


def test_an_automatic_white_balance_makes_the_water_greyer() -> None:
    def chroma(balance: str) -> float:
        scene = draw(
            6, 1, Backdrops(), camera="small", waters="blue", daylight="day", white_balance=balance
        )
        b, g, r = cv2.mean(render(scene)[0])[:3]
        return max(r, g, b) - min(r, g, b)

    assert chroma("automatic") < 0.7 * chroma("locked")


def test_a_frame_is_made_in_time() -> None:
    scenes: list[Scene] = [draw(i, 1, Backdrops(), camera="vga") for i in range(6)]
    render(scenes[0])
    took = []
    for scene in scenes:
        start = time.process_time()
        render(scene)
        took.append(time.process_time() - start)
    assert min(took) < 0.2


def test_both_halves_can_be_rendered() -> None:
    for half in Half:
        frame, _ = render(draw(0, half.seed(1), Backdrops().half(half), camera="small"))
        assert frame.shape == (240, 320, 3) and frame.dtype == np.uint8
