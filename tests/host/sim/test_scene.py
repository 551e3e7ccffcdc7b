"""Scenes' files: what may stand in them, and the one line for what may not."""

from __future__ import annotations

import pickle
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_scene import STILL

from chromadock.errors import ChromadockError
from chromadock.sim.flat_shapes import Box, Panel
from chromadock.sim.round_shapes import Sphere, Tube
from chromadock.sim.scene import SHIPPED, load_scene
from chromadock.sim.water import Water
from chromadock.track.attitude import expected

POOL = (resources.files("chromadock.sim") / "scenes" / "pool.toml").read_text("utf-8")


def refusal(name_or_path: object, overrides: dict[str, Any] | None = None) -> str:
    with pytest.raises(ChromadockError) as error:
        load_scene(str(name_or_path), overrides)
    words = str(error.value)
    assert "\n" not in words
    return words


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_scenes_can_be_read_and_sent_to_other_processes(name: str) -> None:
    scene = load_scene(name)
    again = pickle.loads(pickle.dumps(scene))
    assert scene.name == again.name == name
    np.testing.assert_array_equal(scene.ambient.water.a, again.ambient.water.a)
    one, other = (s.motion.T_camera_dock(3.3) for s in (scene, again))
    np.testing.assert_array_equal(one.t, other.t)


def test_the_example_shows_every_key() -> None:
    from chromadock.sim import scene_models

    comments_and_all = POOL
    for model in vars(scene_models).values():
        if isinstance(model, type) and hasattr(model, "model_fields"):
            for key in model.model_fields:
                assert key in comments_and_all, f"{model.__name__}.{key}"


def test_the_papers_dock_has_struts_orange_buoys_and_printed_parts() -> None:
    kinds = [type(body.shape) for body in load_scene("pool").bodies]
    assert kinds.count(Sphere) == 2
    assert kinds.count(Tube) >= 8  # four of the frame
    assert kinds.count(Box) >= 3


@pytest.mark.parametrize(
    ("section", "like"),
    [
        ({"kind": "pool", "scattering_per_m": 0.4}, Water.pool(0.4)),
        ({"kind": "pool"}, Water.pool()),
        ({"kind": "lake", "visibility_m": 3.0}, Water.lake(3.0)),
        ({"kind": "jerlov", "type": "9C"}, Water.jerlov_type("9C")),
        (
            {"kind": "mixed", "part": [{"kind": "jerlov", "type": "II", "share": 0.25},
                                       {"kind": "pool", "share": 0.75}]},
            Water.mixed([(Water.jerlov_type("II"), 0.25), (Water.pool(), 0.75)]),
        ),
        (
            {"kind": "measured", "wavelengths_nm": [390.0, 710.0],
             "a_per_m": [0.1, 0.4], "b_per_m": [0.5, 0.3]},
            Water.measured([390.0, 710.0], [0.1, 0.4], [0.5, 0.3]),
        ),
    ],
)  # fmt: skip
def test_waters_of_every_kind(section: dict[str, Any], like: Water) -> None:
    water = load_scene("pool", {"water": section}).ambient.water
    np.testing.assert_allclose(water.a, like.a)
    np.testing.assert_allclose(water.b, like.b)


def test_overrides_reach_every_table(tmp_path: Path) -> None:
    scene = load_scene(
        "pool",
        {
            "seed": 7,
            "vehicle.distance_m": 4.5,
            "vehicle.approach.to_m": 1.5,
            "vehicle.approach.duration_s": 10.0,
            "body.0.radius_m": 0.2,
            "body.0.centre_m.2": 0.3,
            "dock.markers_out": ["top_left"],
            "dock_camera.white_balance": "auto",
            "vehicle_camera.ev": -1.0,
            "light.cloud": [{"start_s": 1.0, "fade_s": 2.0, "transmittance": 0.3}],
        },
    )
    assert scene.seed == 7
    assert [scene.motion.course.distance_m(t) for t in (0, 5, 10)] == [4.5, 3.0, 1.5]
    ball = scene.bodies[4].shape
    assert isinstance(ball, Sphere)
    assert (ball.radius_m, ball.centre[2]) == (0.2, 0.3)
    assert dict(zip(scene.dock.names, scene.works(0.0), strict=True))["top_left"] == np.False_
    assert scene.works(0.0).sum() == 3
    assert scene.dock_camera.control.white_balance == "auto"
    assert scene.vehicle_camera.control.ev == -1.0
    assert scene.ambient.clouds[0].illuminance_share(50.0) == pytest.approx(0.3)
    assert load_scene("pool").seed == 1  # not remembered


def test_what_a_detector_is_told_follows_from_the_scene() -> None:
    assert load_scene("pool").mounting is None
    scene = load_scene("pool", {"vehicle.camera_roll_deg": 90.0, **STILL})
    R = scene.mounting.R_body_camera
    # On its side, its right side low: its x is the body's down, its y the body's left.
    np.testing.assert_allclose(R, [[0, 0, 1], [0, -1, 0], [1, 0, 0]], atol=1e-12)
    R_camera_dock, _ = expected(None, scene.mounting)
    np.testing.assert_allclose(R_camera_dock, scene.motion.T_camera_dock(0.0).R, atol=1e-12)


def test_a_dock_may_have_a_colour_of_its_own(tmp_path: Path) -> None:
    assert load_scene("pool").dock.colour is None
    assert load_scene("pool", {"dock.colour": "white"}).dock.colour == "white"
    words = refusal("pool", {"dock.colour": "mauve"})
    assert "pool.toml: dock.colour is 'mauve'" in words and "#RRGGBB" in words


def test_a_lamp_may_fail_on_the_way() -> None:
    failure = [{"marker": "top_right", "at_s": 20.0}]
    scene = load_scene("pool", {"dock.failure": failure, "dock.markers_out": ["top_left"]})
    working = {t: [n for n, w in zip(scene.dock.names, scene.works(t), strict=True) if w]
               for t in (0.0, 19.9, 20.0)}  # fmt: skip
    assert working[0.0] == working[19.9] == ["top_right", "bottom_left", "bottom_right"]
    assert working[20.0] == ["bottom_left", "bottom_right"]
    with pytest.raises(ChromadockError, match=r"failure is of 'left'.* top_left"):
        load_scene("pool", {"dock.failure": [{"marker": "left", "at_s": 1.0}]})


def test_a_body_can_be_added_to_those_of_the_scene() -> None:
    ball = {"shape": "sphere", "rgb": [1.0, 0.0, 0.0], "centre_m": [0.0, 0.0, -1.0]}
    ball |= {"radius_m": 0.1, "present_s": [2.0, 2.5]}
    before, after = load_scene("pool").bodies, load_scene("pool", {"body.+": ball}).bodies
    assert len(after) == len(before) + 1
    assert [after[-1].there(t) for t in (1.99, 2.0, 2.49, 2.5)] == [False, True, True, False]
    assert after[0].there(1e9)
    with pytest.raises(ChromadockError, match=r"present_s is \[2, 1\]"):
        load_scene("pool", {"body.+": {**ball, "present_s": [2.0, 1.0]}})


def test_of_several_changes_the_later_are_applied_to_the_earlier() -> None:
    ball = {"shape": "sphere", "rgb": [1.0, 0.0, 0.0], "centre_m": [0.0, 0.0, 0.0]}
    added = {"body.+": {**ball, "radius_m": 0.1}}
    scene = load_scene("pool", [{"seed": 3, **added}, {"seed": 4, **added}])
    assert scene.seed == 4
    assert len(scene.bodies) == len(load_scene("pool").bodies) + 2


def test_a_copy_builds_on_the_original_or_on_another_copy(tmp_path: Path) -> None:
    (tmp_path / "deep.toml").write_text('base = "pool"\n[water]\nkind = "jerlov"\ntype = "IB"\n')
    (tmp_path / "dark.toml").write_text('base = "deep.toml"\nseed = 9\n')
    scene = load_scene(tmp_path / "dark.toml")
    assert (scene.name, scene.seed) == ("dark", 9)
    np.testing.assert_array_equal(scene.ambient.water.a, Water.jerlov_type("IB").a)
    assert len(scene.bodies) == len(load_scene("pool").bodies)


def test_files_are_looked_for_beside_the_scene_that_names_them(tmp_path: Path) -> None:
    cameras = resources.files("chromadock.sim") / "cameras"
    camera = (
        (cameras / "vehicle.toml").read_text("utf-8").replace("f_number = 2.0", "f_number = 4.0")
    )
    (tmp_path / "mine.toml").write_text(camera)
    points = [("a", -0.5, 0), ("b", 0.5, 0), ("c", 0, 0.4)]
    markers = "".join(
        f'[[marker]]\nname = "{n}"\nposition = [{x}, {y}, 0.0]\n' for n, x, y in points
    )
    (tmp_path / "dock.toml").write_text(markers.replace("0.0, 0.4", "0.0, 0.4"))
    (tmp_path / "scene.toml").write_text(
        POOL.replace('model = "vehicle"', 'model = "mine.toml"').replace(
            "markers_out = []", 'markers_out = ["b"]\ngeometry = "dock.toml"'
        )
    )
    scene = load_scene(tmp_path / "scene.toml")
    assert scene.vehicle_camera.sensor.f_number == 4.0
    assert scene.dock.names == ("a", "b", "c")
    assert scene.works(0.0).tolist() == [True, False, True]


BAD = {
    "vehicle.distance_m": (-1.0, "0.2 to 100 m"),
    "vehicle.heading_deg": (1000.0, "-360 to 360"),
    "place.depth_m": ("deep", "0.05 to 200 m"),
    "place.depth_mm": (1000.0, "unknown key place.depth_mm"),
    "place.floor_rgb": ([255, 255, 255], "each 0 to 1"),
    "light.surface_illuminance_lux": (-5.0, "0 to 200000 lux"),
    "light.diffuse_share": (float("nan"), "0 to 1"),
    "dock.lamp.red.peak_nm": (350.0, "400 to 700 nm"),
    "dock.lamp.white": ({}, "unknown key dock.lamp.white"),
    "dock.markers_out": (["left"], "top_left, top_right, bottom_left, bottom_right"),
    "water.kind": ("milk", '"pool", "lake", "jerlov", "measured" or "mixed"'),
    "water.visibility_m": (2.0, 'does not go with kind = "pool", which takes scattering_per_m'),
    "water": ({"kind": "jerlov", "type": "6C"}, "I, IA, IB"),
    "water.part": ([], "part"),
    "body.3.radius_m": (0.0, "0.0005 to 50 m"),
    "body.0.shape": ("tube", "centre_m does not go with"),
    "body.99.rgb": ([0, 0, 0], "numbers 0 to"),
    "seed.x": (1, "seed is not a table"),
    "seed": (-1, "0 to 2147483647"),
    "vehicle_camera.model": ("nikon", "vehicle_camera.model: nikon: cannot be read"),
    "vehicle_camera.evs": (1.0, "unknown key evs"),
    "vehicle_camera.tint": ([9.0, 1.0, 1.0], "0.25 to 4"),
    "vehicle.approach": ({"to_m": 0.0, "duration_s": 1.0}, "0.2 to 100 m"),
    "vehicle.offset_down_m": (-5.0, "place.depth_m + vehicle.offset_down_m"),
    "particles.diameter_m": (1.0, "1e-05 to 0.01 m"),
    "base": (3, "base"),
}


@pytest.mark.parametrize("key", BAD)
def test_a_bad_value_is_refused_in_one_line_with_file_key_and_range(key: str) -> None:
    value, wanted = BAD[key]
    words = refusal("pool", {key: value})
    assert words.startswith("pool.toml: "), words
    assert wanted in words, words


MEASURED = {"kind": "measured", "a_per_m": [0.1, 0.2], "b_per_m": [0.1, 0.2]}


@pytest.mark.parametrize(
    ("water", "wanted"),
    [
        ({**MEASURED, "wavelengths_nm": [450.0, 600.0]}, "from 400 or less to 700 nm or more"),
        ({**MEASURED, "wavelengths_nm": [400.0, 500.0, 700.0]}, "give one for each"),
        ({"kind": "lake", "visibility_m": 90.0, "cdom_per_m": 9.0}, "visibility_m"),
        ({"kind": "mixed", "part": [{"kind": "pool", "share": 0.4}]}, "their sum 1"),
        ({"kind": "mixed", "part": [{"kind": "mixed", "share": 1.0}]}, "water.part 1: kind"),
        ({"kind": "lake"}, "visibility_m is missing"),
    ],
)
def test_impossible_waters_are_refused(water: dict[str, Any], wanted: str) -> None:
    words = refusal("lake", {"water": water})
    assert words.startswith("lake.toml: water") and wanted in words, words


def test_the_file_at_fault_is_named_not_the_one_that_builds_on_it(tmp_path: Path) -> None:
    (tmp_path / "base.toml").write_text(POOL.replace("depth_m = 1.1", "depth_m = -1.1"))
    (tmp_path / "top.toml").write_text('base = "base.toml"\nseed = 2\n')
    assert f"{tmp_path / 'base.toml'}: place.depth_m is -1.1" in refusal(tmp_path / "top.toml")


def test_files_that_are_no_scenes_are_refused(tmp_path: Path) -> None:
    assert "nowhere.toml: cannot be read" in refusal(tmp_path / "nowhere.toml")
    assert "pool, lake, sea" in refusal("ocean")
    (tmp_path / "broken.toml").write_text("[water\nkind=")
    assert "broken.toml: not valid TOML" in refusal(tmp_path / "broken.toml")
    (tmp_path / "empty.toml").write_text("")
    assert "is missing" in refusal(tmp_path / "empty.toml")
    (tmp_path / "loop.toml").write_text('base = "loop.toml"\n')
    assert "builds on this file" in refusal(tmp_path / "loop.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    assert "not a text file" in refusal(tmp_path / "binary.toml")


def test_shapes_without_extent_are_refused(tmp_path: Path) -> None:
    line = {"shape": "panel", "rgb": [0, 0, 0], "centre_m": [0, 0, 0],
            "half_across_m": [1, 0, 0], "half_down_m": [2, 0, 0]}  # fmt: skip
    point = {"shape": "tube", "rgb": [0, 0, 0], "from_m": [1, 0, 0], "to_m": [1, 0, 0],
             "radius_m": 0.1}  # fmt: skip
    assert "body 1: half_across_m and half_down_m" in refusal("pool", {"body": [line]})
    assert "body 2: from_m and to_m" in refusal(
        "pool", {"body": [{**line, "half_down_m": [0, 1, 0]}, point]}
    )
    panel = load_scene("pool", {"body": [{**line, "half_down_m": [0, 1, 0]}]}).bodies[-1]
    assert isinstance(panel.shape, Panel)
