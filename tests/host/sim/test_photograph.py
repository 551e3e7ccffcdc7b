"""Photographs of water behind the simulated dock."""

from __future__ import annotations

import colorsys
from pathlib import Path

import cv2
import numpy as np
import pytest
from small_scene import PLAIN, small_camera, small_scene

from chromadock.errors import ChromadockError
from chromadock.sim.camera_spec import load_camera
from chromadock.sim.photograph import HOLD_S, Photographs
from chromadock.sim.renderer import Renderer
from chromadock.sim.simulation import Simulation

COLOURS = {"a.png": (40, 150, 190), "b.jpg": (70, 170, 110), "c10.png": (90, 120, 200)}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Even pictures of the sizes that cameras have."""
    pictures = tmp_path / "photographs"
    pictures.mkdir()
    for name, rgb in COLOURS.items():
        cv2.imwrite(str(pictures / name), np.full((48, 64, 3), rgb[::-1], np.uint8))
    (pictures / "notes.txt").write_text("where these were taken")
    return pictures


def hue(rgb: np.ndarray) -> float:
    return 360 * colorsys.rgb_to_hsv(*(np.asarray(rgb) / 255))[0]


def test_pictures_follow_each_other_by_name_and_come_again(folder: Path) -> None:
    photographs = Photographs(folder)
    times = [0.0, HOLD_S - 0.01, HOLD_S, 2 * HOLD_S, 3 * HOLD_S]
    shown = [photographs.path(time).name for time in times]
    assert shown == ["a.png", "a.png", "b.jpg", "c10.png", "a.png"]


@pytest.mark.parametrize("which", ["vehicle", "dock"])
def test_the_picture_keeps_the_photographs_colours(folder: Path, tmp_path: Path, which) -> None:
    scene = small_scene("pool", tmp_path, PLAIN)
    photographs = Photographs(folder)
    renderer = Renderer(scene, which, photographs)
    camera = scene.vehicle_camera if which == "vehicle" else scene.dock_camera
    for i, rgb in enumerate(COLOURS.values()):
        time_s = i * HOLD_S
        settings = camera.auto_control().settle(renderer.meter(time_s, (0, 0, 0)))
        image = renderer.frame(time_s, (0, 0, 0), settings, 0).image_bgr
        mean = image.reshape(-1, 3).mean(axis=0)[::-1]
        assert hue(mean) == pytest.approx(hue(np.array(rgb)), abs=2.0)
        # As bright as exposed, but in the same proportions of linear light, as far as tone
        # curves are alike.
        linear = [(np.asarray(v) / 255) ** 2.2 for v in (mean, rgb)]
        share, wanted = (v / v.sum() for v in linear)
        np.testing.assert_allclose(share, wanted, atol=0.04)


def test_a_photograph_is_as_bright_as_the_water_that_it_stands_for(folder, tmp_path) -> None:
    scene = small_scene("pool", tmp_path, PLAIN)
    rendered = Renderer(scene, "vehicle").light(0.0, (0, 0, 0))
    shown = Renderer(scene, "vehicle", Photographs(folder)).light(0.0, (0, 0, 0))
    assert shown.mean() == pytest.approx(rendered.mean(), rel=0.1)


def test_lamps_shine_on_photographs_as_in_water(folder: Path, tmp_path: Path) -> None:
    scene = small_scene("pool", tmp_path, {**PLAIN, "vehicle.distance_m": 1.5})
    of_water, of_photograph = (
        Renderer(scene, "vehicle", p).light(0.0, (1, 0, 1)) -
        Renderer(scene, "vehicle", p).light(0.0, (0, 0, 0))
        for p in (None, Photographs(folder))
    )  # fmt: skip
    assert of_water.max() > 100
    np.testing.assert_allclose(of_photograph, of_water, atol=0.02 * of_water.max())


def test_both_cameras_see_the_same_photograph(
    folder: Path, tmp_path: Path, record_property
) -> None:
    simulation = Simulation(small_scene("pool", tmp_path, PLAIN), photographs=Photographs(folder))
    for step in simulation.steps(np.arange(0, 3 * HOLD_S, 1.0)):
        frame = simulation.frame(step)
        assert frame.truth.photograph == list(COLOURS)[int(step.time_s // HOLD_S)]
        if step.time_s % HOLD_S > 0:
            apart = hue(np.array(step.dock_background)) - hue(np.array(frame.truth.water_rgb))
            assert apart == pytest.approx(0, abs=4.0)


def test_wide_and_narrow_photographs_are_cut_not_squeezed(tmp_path: Path) -> None:
    sensor = load_camera(small_camera(tmp_path)).sensor
    for shape in ((90, 300), (300, 90)):
        folder = tmp_path / str(shape)
        folder.mkdir()
        picture = np.full((*shape, 3), 40, np.uint8)
        y, x = (np.arange(n) - (n - 1) / 2 for n in shape)
        picture[np.hypot(y[:, None], x) < 20] = 200
        cv2.imwrite(str(folder / "disc.png"), picture)
        light = Photographs(folder).linear(0.0, sensor)[..., 1]
        ys, xs = np.nonzero(light > light.mean())
        assert light.shape == (120, 160)
        assert np.ptp(xs) == pytest.approx(np.ptp(ys), abs=2)
        assert (xs.mean(), ys.mean()) == pytest.approx((79.5, 59.5), abs=1)


def test_folders_without_readable_pictures_are_refused(tmp_path: Path) -> None:
    def refusal(folder: Path) -> str:
        with pytest.raises(ChromadockError) as error:
            Photographs(folder)
        return str(error.value)

    assert "nowhere: cannot be read" in refusal(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    assert "empty: no pictures in it" in refusal(tmp_path / "empty")
    broken = tmp_path / "broken"
    broken.mkdir()
    (broken / "half.jpg").write_bytes(b"\xff\xd8\xff\xe0")
    assert "half.jpg: not a whole picture" in refusal(broken)
    (tmp_path / "file").write_text("x")
    assert "file: cannot be read" in refusal(tmp_path / "file")
