"""``--record``: what a vehicle did, to be looked at and run again."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import cv2
import pytest
from filmed_approach import CAMERA_YAML, frames
from simulation import chromadock

from chromadock.ros.mcap_bag import McapBag, head
from chromadock.ros.topics import RECORD, TOPICS
from chromadock.vehicle.reading import read_vehicle


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Eight pictures of an approach, and the camera's calibration."""
    folder = tmp_path_factory.mktemp("dive")
    (folder / "pictures").mkdir()
    for frame in frames(8):
        cv2.imwrite(str(folder / "pictures" / frame.name), frame.image)
    (folder / "cam.yaml").write_text(CAMERA_YAML)
    return folder


def kept(path: Path, scratch: Path) -> dict[str, str]:
    """What is not at its default in the settings of a recording."""
    from chromadock.vehicle.manual import effective

    scratch.mkdir()
    for name, content in head(path)[0].items():
        (scratch / name).write_bytes(content)
    settings = read_vehicle(scratch / "vehicle.toml")
    return {key: value for key, value, changed in effective(settings) if changed}


def test_detect_records_frames_results_and_settings(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    dive = tmp_path / "dive.mcap"
    done = chromadock(
        capsys, "detect", folder / "pictures", "--camera", folder / "cam.yaml", "--fps", 20,
        "--mapping", "contrast", "--fallback-hue", 40, "--record", dive,
    )  # fmt: skip
    assert done.status == 0, done.err
    bag = McapBag(dive)
    assert {topic.name: topic.kind for topic in bag.topics} == TOPICS
    assert len(list(bag.messages(RECORD))) == 8 and bag.cut_short is None
    settings = kept(dive, tmp_path / "kept")
    assert settings["dock.mapping"] == '"contrast"'
    assert settings["dock.fallback_hue_deg"] == "40.0"
    assert settings["camera.calibration"] == f'"{tmp_path / "kept" / "camera.yaml"}"'
    assert (tmp_path / "kept" / "camera.yaml").read_text() == CAMERA_YAML


def test_run_records_where_its_file_or_its_option_says(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, second = tmp_path / "first.mcap", tmp_path / "second.mcap"
    vehicle = tmp_path / "vehicle.toml"
    vehicle.write_text(
        f'[camera]\nsource = "{folder / "pictures"}"\n[mounting]\npitch_deg = -5.0\n'
        f'[outputs]\nrecord = "{first}"\n'
    )
    assert chromadock(capsys, "run", vehicle).status == 0
    assert first.exists() and not second.exists()
    assert chromadock(capsys, "run", vehicle, "--record", second).status == 0
    assert kept(second, tmp_path / "kept")["mounting.pitch_deg"] == "-5.0"
    done = chromadock(capsys, "run", vehicle)
    assert "first.mcap is there already: recording into" in done.err
    assert (tmp_path / "first-2.mcap").exists()


def test_a_place_that_is_none_is_told_before_the_dive(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    vehicle = tmp_path / "vehicle.toml"
    vehicle.write_text('[outputs]\nrecord = "no/such/folder/dive.mcap"\n')
    done = chromadock(capsys, "detect", folder / "pictures", "--record", "no/such/dive.mcap")
    assert (done.status, done.out) == (2, "")
    assert "no such folder: create it first" in done.err
    done = chromadock(capsys, "config", "check", vehicle)
    assert done.status == 2 and "no such folder: create it first" in done.err


def test_a_full_disk_is_told_and_the_detection_goes_on(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    done = chromadock(capsys, "detect", folder / "pictures", "--record", "/dev/full")
    assert done.status == 0 and "8 frames, 8 found" in done.out
    assert "/dev/full: cannot be written (No space left on device)" in done.err
    assert "Traceback" not in done.err


@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT])
def test_a_run_that_is_stopped_leaves_a_whole_recording(
    folder: Path, tmp_path: Path, stop: signal.Signals
) -> None:
    many = tmp_path / "many"
    many.mkdir()
    for k in range(400):
        os.link(folder / "pictures" / "0.png", many / f"{k}.png")
    dive = tmp_path / "dive.mcap"
    command = [sys.executable, "-m", "chromadock", "detect", str(many), "--record", str(dive)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        for _ in range(6):
            run.stdout.readline()
        run.send_signal(stop)
        seen = 5 + sum(line.rstrip().endswith(".png") for line in run.stdout)
        assert run.wait() == 128 + stop
    bag = McapBag(dive)
    assert seen <= len(list(bag.messages(RECORD))) <= seen + 1
    assert bag.cut_short is None
    assert time.time() - dive.stat().st_mtime < 60
