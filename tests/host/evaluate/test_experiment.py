from __future__ import annotations

from pathlib import Path

import pytest

from chromadock.errors import ChromadockError
from chromadock.evaluate.experiment import read_experiment
from chromadock.evaluate.filters import FILTERS
from chromadock.evaluate.runs import Run, runs_of, runs_of_files

ROOT = Path(__file__).resolve().parents[3]
SHIPPED = sorted((ROOT / "experiments").glob("*.toml"))

CONTENT = """
name = "quay"
scene = "pool"
frames = 40
rate_hz = 5.0
seed = 7
mappings = ["ternary", "complement"]

[set]
"vehicle.offset_right_m" = 0.3

[vary]
"vehicle.distance_m" = [1, 2.5]
"vehicle.heading_deg" = [0, 90, 45]
light = [
    { label = "noon", "light.surface_illuminance_lux" = 100000, "light.sun_elevation_deg" = 60 },
    { label = "night", "light.surface_illuminance_lux" = 0 },
]
"""


def runs(tmp_path: Path, content: str = CONTENT, frames: int | None = None) -> list[Run]:
    path = tmp_path / "quay.toml"
    path.write_text(content)
    return runs_of(read_experiment(path), path, frames)


def test_every_combination_is_a_run_with_its_scene_set(tmp_path: Path) -> None:
    found = runs(tmp_path)
    assert len(found) == len({run.name for run in found}) == 2 * 3 * 2 * 2
    assert [run.name for run in found[:3]] == [
        "quay 1 m N ternary light noon",
        "quay 1 m N complement light noon",
        "quay 1 m N ternary light night",
    ]
    last = found[-1]
    assert last.name == "quay 2.5 m 45 complement light night"
    assert last.distance_m == 2.5
    assert last.heading == "45"
    assert last.varied["light"] == "night"
    assert last.filters == FILTERS
    assert last.scene.motion.heading_deg == 45
    assert last.scene.motion.offset_right_m == 0.3
    assert last.scene.ambient.surface_illuminance_lux == 0
    assert {run.scene.seed for run in found} == {7}
    assert last.time_s(20) == 4.0


def test_fewer_frames_are_a_quick_look_and_never_more(tmp_path: Path) -> None:
    assert {run.frames for run in runs(tmp_path, frames=6)} == {6}
    assert {run.frames for run in runs(tmp_path, frames=600)} == {40}


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("frames = 40", "frames = -1", "frames is -1: it must be 1 to 100000"),
        ("frames = 40", "frames = 0.5", "frames is 0.5"),
        ("frames = 40", "", "frames is missing"),
        ("frames = 40", "frames = 40\nframe_rate = 3", "unknown key frame_rate"),
        ("rate_hz = 5.0", "rate_hz = nan", "rate_hz is nan: it must be 0.01 to 120"),
        ("seed = 7", "seed = 990001", "seed is 990001: it must be 0 to 990000"),
        ('"quay"', '"a/b"', "name is 'a/b'"),
        ('["ternary", "complement"]', "[]", "mappings is (): it must be a list of at least 1"),
        ('["ternary", "complement"]', '["triad"]', 'unknown mapping "triad": choose from ternary'),
        ('["ternary", "complement"]', '["ternary", "ternary"]', "ternary stands there twice"),
        ("seed = 7", 'seed = 7\nfilters = ["static sea"]', 'unknown filter "static sea": choose'),
        ("seed = 7", "seed = 7\nfilters = []", "filters is (): it must be a list of at least 1"),
        ("[1, 2.5]", "[]", "vary.vehicle.distance_m is []: it must be a list of at least 1"),
        ("[1, 2.5]", "[1, 1]", "vehicle.distance_m: a value stands there twice"),
        ("[1, 2.5]", "[1, -2]", "distance_m is -2: it must be 0.2 to 100 m"),
        ('label = "noon", ', "", "light: each table needs a label and keys of the scene"),
        ("[0, 90, 45]", '[0, { label = "x", "a.b" = 1 }]', "give values or tables, not both"),
        ('"pool"', '"puddle"', "puddle"),
        ('"pool"', "3", "scene is 3: it must be the name of a scene"),
        ("offset_right_m", "offset_rihgt_m", "unknown key vehicle.offset_rihgt_m"),
        ("name =", "name", "not valid TOML"),
    ],
)
def test_a_slip_is_told_in_a_line_with_file_key_and_what_may_stand_there(
    tmp_path: Path, old: str, new: str, words: str
) -> None:
    assert old in CONTENT
    with pytest.raises(ChromadockError) as error:
        runs(tmp_path, CONTENT.replace(old, new))
    line = str(error.value)
    assert words in line
    assert "quay.toml" in line
    assert "\n" not in line


def test_a_scene_of_ones_own_and_photographs_are_looked_for_beside_the_experiment(
    tmp_path: Path,
) -> None:
    with pytest.raises(ChromadockError, match=str(tmp_path / "mine.toml")):
        runs(tmp_path, CONTENT.replace('"pool"', '"mine.toml"'))
    with_photographs = CONTENT.replace("seed = 7", 'seed = 7\nphotographs = "photos"')
    assert runs(tmp_path, with_photographs)[0].photographs == tmp_path / "photos"


def test_an_experiment_without_its_photographs_is_left_out_with_a_word(tmp_path: Path) -> None:
    path = tmp_path / "quay.toml"
    path.write_text(CONTENT.replace("seed = 7", 'seed = 7\nphotographs = "photos"'))
    told: list[str] = []
    assert runs_of_files([path], None, told.append) == []
    assert len(told) == 1
    assert str(tmp_path / "photos") in told[0]


def test_two_experiments_of_one_name_are_refused(tmp_path: Path) -> None:
    for name in ("a.toml", "b.toml"):
        (tmp_path / name).write_text(CONTENT)
    with pytest.raises(ChromadockError, match=r"b\.toml: its name .*a\.toml"):
        runs_of_files([tmp_path / "a.toml", tmp_path / "b.toml"], None, print)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda p: p.stem)
def test_a_shipped_experiment_is_sound_and_its_runs_differ(path: Path) -> None:
    found = runs_of(read_experiment(path), path)
    assert len({run.name for run in found}) == len(found)


def test_the_papers_runs_are_as_long_and_as_many_as_its() -> None:
    """Knutson 2024, section IV and caption of the box plot: n > 500 a lake run, > 1,500 a pool."""
    lake, pool = (ROOT / "experiments" / f"{name}.toml" for name in ("lake", "pool"))
    lake_runs, pool_runs = (runs_of(read_experiment(path), path) for path in (lake, pool))
    assert len(lake_runs) == 12
    assert {(run.distance_m, run.heading) for run in lake_runs} == {
        (d, h) for d in (1, 3, 5) for h in "NESW"
    }
    assert {run.mapping for run in lake_runs} == {"ternary"}
    assert min(run.frames for run in lake_runs) > 500
    assert {(run.distance_m, run.mapping) for run in pool_runs} == {
        (d, m) for d in (1, 3, 5) for m in ("ternary", "complement")
    }
    assert min(run.frames for run in pool_runs) > 1500
    for run in lake_runs + pool_runs:
        assert run.time_s(run.frames - 1) == pytest.approx(120, rel=0.01)
