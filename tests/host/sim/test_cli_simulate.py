"""``chromadock simulate`` as a user runs it."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np
import pytest
from patience import PATIENCE_S
from simulation import chromadock
from small_scene import small_camera

from chromadock import CameraModel
from chromadock.sim.scene import load_scene
from chromadock.sim.simulation import Simulation

FRAMES = 4


@pytest.fixture(scope="module")
def camera(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The option that makes frames small."""
    return f"vehicle_camera.model={small_camera(tmp_path_factory.mktemp('camera'))}"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory, camera: str) -> Path:
    """The folder of a usual run, with one process."""
    out = tmp_path_factory.mktemp("run") / "frames"
    subprocess.run(
        command("pool", "--out", out, "--frames", FRAMES, "--workers", 1, "--set", camera),
        check=True,
    )
    return out


def command(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "chromadock", "simulate", *map(str, arguments)]


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_a_run_leaves_pictures_truth_and_camera(run: Path) -> None:
    pictures = [f"{i:06d}.jpg" for i in range(FRAMES)]
    assert sorted(contents(run)) == [*pictures, "camera.yaml", "truth.jsonl"]
    assert [path.name for path in run.parent.iterdir()] == ["frames"]
    lines = [json.loads(line) for line in (run / "truth.jsonl").read_text().splitlines()]
    assert [line["frame"] for line in lines] == list(range(FRAMES))
    assert lines[2]["time_s"] == pytest.approx(2 / 15, abs=1e-5)
    image = cv2.imread(str(run / pictures[0]))
    model = CameraModel.from_yaml(run / "camera.yaml")
    model.check_size(image.shape)
    assert model.matrix[0, 0] == 128
    assert model.distortion[0] == -0.08


def test_pictures_on_the_disk_are_the_frames(run: Path, camera: str) -> None:
    key, _, path = camera.partition("=")
    simulation = Simulation(load_scene("pool", {key: path}))
    steps = list(simulation.steps(i / 15 for i in range(FRAMES)))
    for step in steps:
        written = cv2.imread(str(run / f"{step.index:06d}.jpg")).astype(int)
        difference = np.abs(written - simulation.frame(step).image_bgr)
        assert difference.mean() < 0.5  # the same JPEG tables a second time


def test_a_camera_that_does_not_compress_leaves_png(tmp_path: Path, capsys) -> None:
    text = Path(small_camera(tmp_path)).read_text()
    (tmp_path / "raw.toml").write_text(text.replace("jpeg_quality = 90", ""))
    raw = f"vehicle_camera.model={tmp_path / 'raw.toml'}"
    done = chromadock(capsys, "simulate", "pool", "--out", tmp_path / "frames", "--frames", 1,
                      "--workers", 1, "--set", raw)  # fmt: skip
    assert done.status == 0
    assert cv2.imread(str(tmp_path / "frames" / "000000.png")).shape == (120, 160, 3)


def test_any_number_of_processes_makes_the_same_bytes(run: Path, tmp_path: Path, camera) -> None:
    out = tmp_path / "frames"
    subprocess.run(
        command("pool", "--out", out, "--frames", FRAMES, "--jobs", 2, "--set", camera),
        check=True,
    )
    assert contents(out) == contents(run)


def test_a_video_has_its_truth_and_camera_beside_it(tmp_path: Path, camera: str, capsys) -> None:
    out = tmp_path / "run.mp4"
    done = chromadock(capsys, "simulate", "pool", "--out", out, "--seconds", 0.4, "--fps", 10,
                      "--workers", 1, "--set", camera, "--set", "vehicle.distance_m=1",
                      "--seed", 5, "--mapping", "complement")  # fmt: skip
    assert (done.status, done.err) == (0, "")
    assert done.out == f"wrote 4 frames to {out}\n"
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["run.mp4", "run.mp4.camera.yaml", "run.mp4.truth.jsonl"]
    video = cv2.VideoCapture(str(out))
    assert video.get(cv2.CAP_PROP_FRAME_COUNT) == 4
    assert video.get(cv2.CAP_PROP_FPS) == 10
    line = json.loads((tmp_path / "run.mp4.truth.jsonl").read_text().splitlines()[0])
    assert np.linalg.norm(line["T_camera_dock"]["t"]) == pytest.approx(1, abs=0.3)


def test_photographs_are_put_behind_the_dock(tmp_path: Path, camera: str, capsys) -> None:
    pictures = tmp_path / "photographs"
    pictures.mkdir()
    cv2.imwrite(str(pictures / "teal.png"), np.full((60, 80, 3), (150, 160, 60), np.uint8))
    out = tmp_path / "frames"
    done = chromadock(capsys, "simulate", "pool", "--out", out, "--frames", 1, "--workers", 1,
                      "--set", camera, "--background", pictures)  # fmt: skip
    assert done.status == 0
    line = json.loads((out / "truth.jsonl").read_text())
    assert line["water"]["photograph"] == "teal.png"
    blue, green, red = cv2.imread(str(out / "000000.jpg"))[5, 5].astype(int)
    assert green > blue > red + 40


BAD = {
    ("nowhere.toml",): "nowhere.toml: cannot be read",
    ("pool", "--set", "vehicle.distance_m=-3"): "vehicle.distance_m is -3: it must be 0.2 to 100 m",
    ("pool", "--set", "vehicle.distance_cm=300"): "unknown key vehicle.distance_cm",
    ("pool", "--set", "dock.lamp.red.peak_nm=350"): "350: it must be 400 to 700 nm",
    ("pool", "--set", "water.kind=milk"): "water.kind is 'milk'",
    ("pool", "--set", "distance"): "--set distance: write key=value",
    ("pool", "--seed", -4): "seed is -4: it must be 0 to 2147483647",
    ("pool", "--mapping", "blue"): "unknown mapping 'blue': choose one of ternary",
    ("pool", "--fps", 0): "--fps is 0",
    ("pool", "--frames", 0): "--frames is 0: give 1 to 1000000 frames",
    ("pool", "--seconds", -1): "--seconds is -1",
    ("pool", "--seconds", "nan"): "--seconds is nan",
    ("pool", "--frames", 3, "--seconds", 1): "give one of them",
    ("pool", "--workers", 0): "--workers is 0",
    ("pool", "--background", "nowhere"): "nowhere: cannot be read",
}


@pytest.mark.parametrize("arguments", BAD)
def test_bad_input_is_one_line_and_status_2(arguments, tmp_path: Path, capsys) -> None:
    done = chromadock(capsys, "simulate", *arguments, "--out", tmp_path / "frames")
    assert (done.status, done.out) == (2, "")
    assert done.err.startswith("chromadock: error: ")
    assert done.err.count("\n") == 1
    assert BAD[arguments] in done.err
    assert not list(tmp_path.iterdir())


def test_places_that_cannot_be_written_are_refused(tmp_path: Path, capsys) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine.txt").write_text("keep")
    kept = ["file", "full", "mine.txt", "new.mp4.truth.jsonl", "old.mp4"]
    for name in set(kept) - {"full", "mine.txt"}:
        (tmp_path / name).write_text("keep")
    for out, words in {
        "full": "there are files in it: give a new or an empty folder",
        "file": "give a folder, or a video's name",
        "frames.tar": "give a folder, or a video's name",
        "none/frames": "does not exist: create it first",
        "old.mp4": "old.mp4: it is there already: give a new name",
        "new.mp4": "new.mp4.truth.jsonl: it is there already: give a new name",
    }.items():
        done = chromadock(capsys, "simulate", "pool", "--frames", 1, "--out", tmp_path / out)
        assert done.status == 2
        assert words in done.err, done.err
    assert sorted(path.name for path in tmp_path.rglob("*")) == kept


def test_an_empty_folder_may_be_filled(tmp_path: Path, camera: str, capsys) -> None:
    out = tmp_path / "frames"
    out.mkdir()
    done = chromadock(capsys, "simulate", "pool", "--frames", 1, "--workers", 1, "--out", out,
                      "--set", camera)  # fmt: skip
    assert done.status == 0
    assert (out / "000000.jpg").is_file()


def test_a_full_disk_is_one_line_and_leaves_nothing(tmp_path: Path, camera: str) -> None:
    """A limit on files' size stands for it: the system refuses to write in the same way."""
    for out in ("frames", "run.mp4"):
        done = subprocess.run(
            command(
                "pool", "--frames", 3, "--workers", 1, "--out", tmp_path / out, "--set", camera
            ),
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)),
            capture_output=True,
            text=True,
        )
        assert done.returncode == 2, done.stderr
        assert done.stderr.count("\n") == 1, done.stderr
        assert f"{tmp_path / out}: " in done.stderr
        assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("out", "sign"), [("frames", signal.SIGKILL), ("run.mp4", signal.SIGKILL),
                                           ("frames", signal.SIGTERM)])  # fmt: skip
def test_a_killed_run_leaves_nothing_that_looks_whole(tmp_path, camera, out, sign) -> None:
    run = subprocess.Popen(
        command("pool", "--seconds", 600, "--workers", 2, "--out", tmp_path / out, "--set", camera),
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    try:
        deadline = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline and not written(tmp_path):
            time.sleep(0.05)
        assert written(tmp_path)
        run.send_signal(sign)
        run.wait(20)
        while time.monotonic() < deadline and in_session(run.pid):
            time.sleep(0.05)
        assert not in_session(run.pid), "processes of the killed run are left"
    finally:
        if in_session(run.pid):
            os.killpg(run.pid, signal.SIGKILL)
    left = [path.name for path in tmp_path.iterdir()]
    if sign == signal.SIGTERM:
        assert run.returncode == 143
        assert run.stderr is not None and run.stderr.read() == b""
        assert left == []
    assert all(name.startswith(".") and "partial" in name for name in left)


def written(folder: Path) -> bool:
    """Some lines of truth are on the disk already."""
    return any(path.is_file() and path.stat().st_size > 3000
               for path in folder.rglob("*truth*"))  # fmt: skip


def in_session(leader: int) -> list[int]:
    """Processes that are left of a session, but for those that have ended."""
    left = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            try:
                state, _, _, session = (entry / "stat").read_text().rpartition(")")[2].split()[:4]
            except OSError:
                continue
            if int(session) == leader and state != "Z":
                left.append(int(entry.name))
    return left
