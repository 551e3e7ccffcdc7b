"""One file for the vehicle: written, checked, shown and run."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import configuration
import cv2
import numpy as np
import pytest
from patience import PATIENCE_S

from chromadock.errors import ChromadockError
from chromadock.vehicle.building import camera_settings_of, mounting_of
from chromadock.vehicle.keys import MountingKeys, VehicleFile
from chromadock.vehicle.manual import as_toml, effective, page, shipped_file
from chromadock.vehicle.reading import read_vehicle, tables

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def chromadock(*arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "chromadock", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=PATIENCE_S)


def written(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def test_the_shipped_file_has_every_key_at_its_default() -> None:
    """Its keys that are comments, too."""
    content = tomllib.loads(shipped_file())
    assert VehicleFile.model_validate(content) == VehicleFile()
    told = tomllib.loads(shipped_file().replace("# [", "[").replace("_deg = 0.0", "_deg = 1.0"))
    for name, model in tables().items():
        if name != "mounting":
            assert set(told[name]) == set(model.model_fields)
    for key in MountingKeys.model_fields:
        assert f"# {key} = 0.0" in shipped_file()


def test_the_page_of_the_documentation_is_of_these_keys() -> None:
    assert configuration.PAGE.read_text(encoding="utf-8") == page(), "run `make generate`"


def test_what_is_left_out_has_its_default_and_what_is_set_goes_first(tmp_path: Path) -> None:
    path = written(tmp_path / "v.toml", '[camera]\nsource = "a.mp4"\n[mounting]\npitch_deg = -90\n')
    vehicle = read_vehicle(path, {"camera.source": 1, "dock.fallback_hue_deg": 20.0})
    assert vehicle.camera.source == "1"
    assert vehicle.mounting is not None and vehicle.mounting.pitch_deg == -90
    changed = {key: value for key, value, other in effective(vehicle) if other}
    assert changed == {
        "camera.source": '"1"', "mounting.pitch_deg": "-90.0", "dock.fallback_hue_deg": "20.0"
    }  # fmt: skip


def test_a_cameras_settings_are_numbers_or_words(tmp_path: Path) -> None:
    path = written(tmp_path / "v.toml", '[camera]\nexposure = 8\ngain = "lock"\nfocus = ""\n')
    vehicle = read_vehicle(path, {"camera.white_balance": "auto"})
    assert camera_settings_of(vehicle).wishes == {
        "exposure": 8.0, "gain": "lock", "white_balance": "auto"
    }  # fmt: skip
    assert camera_settings_of(VehicleFile()).wishes == {}
    assert read_vehicle(written(tmp_path / "again.toml", as_toml(vehicle))) == vehicle


def test_files_that_are_named_are_sought_beside_the_file(tmp_path: Path) -> None:
    path = written(
        tmp_path / "v.toml", '[camera]\ncalibration = "cam.yaml"\n[dock]\nfile = "d.toml"'
    )
    vehicle = read_vehicle(path)
    assert vehicle.camera.calibration == str(tmp_path / "cam.yaml")
    assert vehicle.dock.file == str(tmp_path / "d.toml")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[camera]\nsource = 0", "camera.source is 0: it must be a text in quotes"),
        ("[camera]\nsorce = '0'", "unknown key camera.sorce"),
        ("[camera]\ndelay_s = -1", "camera.delay_s is -1: it must be 0 to 10 s"),
        ("[camera]\ndelay_s = true", "camera.delay_s is True: it must be 0 to 10 s"),
        ("[camera]\nexposure = 'manual'", 'it must be "", "auto", "lock" or 0.1 to 1000 ms'),
        ("[camera]\nexposure = 0", "camera.exposure is 0: it must be"),
        ("[camera]\nwhite_balance = true", "camera.white_balance is True: it must be"),
        ("[camera]\nfocus = nan", "camera.focus is nan: it must be"),
        ("[dock]\nmapping = 'octal'", "dock.mapping is 'octal': it must be one of ternary"),
        ("[mounting]\nyaw_deg = 270", "mounting.yaw_deg is 270: it must be -180 to 180 degrees"),
        ("[outputs]\nresults = 'json:a'", "outputs.results is 'json:a': it must be a list"),
        ("camera = 3", "camera is 3: it must be a table of keys"),
        ("[boat]", "unknown key boat"),
        ("[camera", "not valid TOML"),
    ],
)
def test_a_fault_is_one_line_with_the_key_and_what_may_be(
    tmp_path: Path, text: str, said: str
) -> None:
    with pytest.raises(ChromadockError) as refused:
        read_vehicle(written(tmp_path / "v.toml", text))
    assert said in str(refused.value) and "\n" not in str(refused.value)
    assert "v.toml" in str(refused.value)


@pytest.mark.parametrize("key", ["camera", "boat.name", "camera.a.b", "camera.sorce"])
def test_a_key_that_is_not_there_cannot_be_set(tmp_path: Path, key: str) -> None:
    with pytest.raises(ChromadockError, match=r"no such key|unknown key"):
        read_vehicle(written(tmp_path / "v.toml", ""), {key: 1})


@pytest.mark.parametrize(
    ("angles", "looks", "right"),
    [
        ({}, (1, 0, 0), (0, 1, 0)),
        ({"pitch_deg": -90.0}, (0, 0, 1), (0, 1, 0)),
        ({"yaw_deg": 90.0}, (0, 1, 0), (-1, 0, 0)),
        ({"roll_deg": 90.0}, (1, 0, 0), (0, 0, 1)),
        ({"yaw_deg": 180.0, "pitch_deg": 30.0}, (-0.866, 0, -0.5), (0, -1, 0)),
    ],
)
def test_angles_are_of_aircraft(
    angles: dict[str, float], looks: tuple[float, ...], right: tuple[float, ...]
) -> None:
    """The camera's z and x in the body's axes, forward, right and down."""
    mounting = mounting_of(MountingKeys(**angles))
    assert mounting is not None
    assert mounting.R_body_camera[:, 2] == pytest.approx(looks, abs=1e-3)
    assert mounting.R_body_camera[:, 0] == pytest.approx(right, abs=1e-3)


def test_nobody_has_told_the_mounting() -> None:
    assert mounting_of(VehicleFile().mounting) is None


# --- the commands ---


def test_a_new_file_is_written_checked_and_shown_and_never_overwritten(tmp_path: Path) -> None:
    done = chromadock("config", "init", "v.toml", cwd=tmp_path)
    assert done.returncode == 0 and done.stdout.startswith("wrote v.toml")
    assert (
        chromadock("config", "check", "v.toml", cwd=tmp_path).stdout
        == "v.toml: all keys are well\n"
    )
    shown = chromadock("config", "show", "v.toml", cwd=tmp_path).stdout.splitlines()
    assert '  camera.source = "0"' in shown and not [line for line in shown if line[0] == "*"]
    again = chromadock("config", "init", "v.toml", cwd=tmp_path)
    assert again.returncode == 2 and "is there already" in again.stderr


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[camera]\ncalibration = 'none.yaml'", "none.yaml: cannot read the camera file"),
        ("[dock]\nfile = 'none.toml'", "none.toml: cannot be read"),
        ("[dock]\ncolour = 'blue-ish'", "dock.colour"),
        ("[camera]\nmanager = '192.168.2.2'", "camera.manager is '192.168.2.2': write http://"),
        ("[outputs]\nresults = ['pigeon:home']", "no such output"),
    ],
)
def test_check_looks_into_what_the_file_names(tmp_path: Path, text: str, said: str) -> None:
    written(tmp_path / "v.toml", text)
    done = chromadock("config", "check", "v.toml", cwd=tmp_path)
    assert done.returncode == 2 and said in done.stderr and "Traceback" not in done.stderr


def test_run_does_what_the_file_says(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    for k in range(3):
        cv2.imwrite(str(tmp_path / f"in/{k}.png"), np.full((96, 128, 3), (150, 120, 30), np.uint8))
    written(
        tmp_path / "v.toml",
        "[camera]\nsource = 'in'\n[dock]\nmapping = 'complement'\n[detector]\nindependent = true\n"
        "[outputs]\nresults = ['json:log.jsonl']\noverlay = 'seen'\n",
    )
    done = chromadock("run", "v.toml", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(lines) == 3 and all(line["track"] is None for line in lines)
    assert len((tmp_path / "log.jsonl").read_text().splitlines()) == 3
    assert len(list((tmp_path / "seen").iterdir())) == 3
    other = chromadock("run", "v.toml", "--json", "--set", "dock.mapping=ternary", cwd=tmp_path)
    hues = [
        json.loads(text.splitlines()[0])["marker"]["hue_deg"]
        for text in (done.stdout, other.stdout)
    ]
    assert abs(hues[0] - hues[1]) > 30
    bad = chromadock("run", "v.toml", "--set", "mapping", cwd=tmp_path)
    assert bad.returncode == 2 and "write key=value" in bad.stderr
