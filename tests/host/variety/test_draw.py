"""Scenes are a pure function of their seed, and all that can differ does."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from chromadock.errors import ChromadockError
from chromadock.variety import Backdrops, Half, Scene, draw
from chromadock.variety.factors import variety
from chromadock.variety.poses import MARGIN, rotation

MANY = 250


@pytest.fixture(scope="module")
def backdrops(tmp_path_factory: pytest.TempPathFactory) -> Backdrops:
    folder = tmp_path_factory.mktemp("photographs")
    for i in range(12):
        cv2.imwrite(str(folder / f"{i}.png"), np.full((48, 64, 3), (150, 120, 30 + i), np.uint8))
    return Backdrops.of_folders(folder)


@pytest.fixture(scope="module")
def scenes(backdrops: Backdrops) -> list[Scene]:
    return [draw(i, 1, backdrops) for i in range(MANY)]


def test_a_folder_that_is_named_and_holds_no_pictures_is_refused(tmp_path: Path) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    cv2.imwrite(str(inner / "1.png"), np.zeros((48, 64, 3), np.uint8))
    assert Backdrops.of_folders(None, [inner]).other == (inner / "1.png",)
    with pytest.raises(ChromadockError, match="no pictures there: name the folder"):
        Backdrops.of_folders(None, [inner, tmp_path])


def test_the_same_seed_draws_the_same_scene(backdrops: Backdrops) -> None:
    first, again, other = (draw(5, seed, backdrops) for seed in (1, 1, 2))
    assert first.factors() == again.factors()
    assert first.things == again.things
    assert np.array_equal(first.R, again.R) and np.array_equal(first.t, again.t)
    assert first.factors() != other.factors()


@pytest.mark.parametrize("name", ["dock", "build", "colour", "mapping", "lamp_profile", "camera"])
def test_every_choice_is_drawn(name: str, scenes: list[Scene]) -> None:
    assert {getattr(s, name) for s in scenes} == set(variety().shares[name])


@pytest.mark.parametrize("name", ["daylight", "exposure", "white_balance", "subsampling", "waters"])
def test_every_light_and_camera_setting_is_drawn(name: str, scenes: list[Scene]) -> None:
    assert {getattr(s, name) for s in scenes} == set(variety().shares[name])


def test_every_kind_of_clutter_is_drawn(scenes: list[Scene]) -> None:
    seen = {kind for s in scenes for kind in s.clutter.split()}
    assert seen == {
        "none", "buoys", "posts", "boxes", "single_lamp", "diver", "own_colour", "other_dock",
    }  # fmt: skip
    assert {t.kind for s in scenes for t in s.things} == {"disc", "box", "post", "lamp"}


@pytest.mark.parametrize("name", ["yaw_deg", "shake_px", "radiance", "jpeg_quality", "halo_rad"])
def test_numbers_fill_their_range_and_stay_in_it(name: str, scenes: list[Scene]) -> None:
    low, high = (variety().uniform | variety().logarithmic)[name]
    values = np.array([getattr(s, name) for s in scenes])
    assert low <= values.min() < low + 0.1 * (high - low)
    assert high - 0.1 * (high - low) < values.max() <= high


def test_all_markers_are_in_the_frame_and_in_front(scenes: list[Scene]) -> None:
    for scene in scenes:
        assert scene.dock_geometry is not None
        camera = scene.camera_model
        pixels = camera.project(scene.dock_geometry.points @ scene.R.T + scene.t)
        margin = MARGIN * camera.width
        assert (pixels > margin).all()
        assert (pixels < np.array([camera.width, camera.height]) - margin).all()


def test_docks_look_as_large_as_the_original_at_their_distance(scenes: list[Scene]) -> None:
    for scene in scenes:
        assert scene.range_m / scene.width_m == pytest.approx(scene.distance_m / 0.89)
        assert scene.t[2] == pytest.approx(scene.range_m)
    assert {s.width_m for s in scenes if s.dock == "rectangle"} == {0.89}


def test_the_pose_is_the_angles_that_are_told(scenes: list[Scene]) -> None:
    for scene in scenes[:50]:
        told = rotation(scene.pitch_deg, scene.yaw_deg, scene.roll_deg)
        assert np.allclose(scene.R, told)
        # A dock turned by so much about the upright has its right end that much nearer.
        assert rotation(0, scene.yaw_deg, 0)[2, 0] == pytest.approx(
            -np.sin(np.radians(scene.yaw_deg))
        )


def test_a_camera_on_its_side_sees_the_dock_on_its_side(backdrops: Backdrops) -> None:
    scene = draw(3, 1, backdrops, mounting="side", distance="4", dock="rectangle")
    along = scene.R @ (1.0, 0.0, 0.0)
    assert abs(along[1]) > abs(along[0])


def test_a_fixed_factor_leaves_the_others_as_they_are(backdrops: Backdrops) -> None:
    free, fixed = draw(7, 1, backdrops), draw(7, 1, backdrops, jpeg_quality=77, build="lamps")
    assert fixed.jpeg_quality == 77 and fixed.build == "lamps"
    changed = {k for k, v in free.factors().items() if fixed.factors()[k] != v}
    assert changed <= {"jpeg_quality", "build"}
    assert changed


@pytest.mark.parametrize(
    ("fixed", "words"),
    [
        ({"colours": "blue"}, "colours: no such factor"),
        ({"camera": "webcam"}, "camera = webcam: it must be one of vga, wide"),
        ({"gamma": "steep"}, "gamma = steep: it must be a number"),
    ],
)
def test_a_wrong_factor_is_refused_in_one_line(
    fixed: dict[str, str], words: str, backdrops: Backdrops
) -> None:
    with pytest.raises(ChromadockError, match=words):
        draw(0, 1, backdrops, **fixed)


def test_the_halves_share_neither_seeds_nor_photographs(backdrops: Backdrops) -> None:
    develop, report = Half.DEVELOP, Half.REPORT
    assert not {develop.seed(n) for n in range(50)} & {report.seed(n) for n in range(50)}
    mine, yours = set(backdrops.half(develop).plain), set(backdrops.half(report).plain)
    assert mine and yours and not mine & yours
    assert mine | yours == set(backdrops.plain)


def test_a_photograph_stays_in_its_half_on_any_machine() -> None:
    # The last bits of their CRC-32, by another program.
    last_bits = {"1.jpg": 1, "12.jpg": 1, "40.jpg": 0, "74.jpg": 0}
    for name, bit in last_bits.items():
        assert Half.REPORT.has(Path("anywhere") / name) == bool(bit)
        assert Half.DEVELOP.has(Path("elsewhere") / name) != bool(bit)


def test_without_photographs_the_water_is_rendered() -> None:
    assert {draw(i, 1, Backdrops()).backdrop for i in range(10)} == {"procedural"}


def test_no_dock_means_no_markers_but_at_least_one_lamp(backdrops: Backdrops) -> None:
    for i in range(60):
        scene = draw(i, 1, backdrops, dock="none")
        assert scene.dock_geometry is None and not scene.lamp_gains and not scene.bars
        assert any(thing.kind == "lamp" for thing in scene.things)
