"""``chromadock replay`` of many recordings: by the processes of a Dask cluster."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from distributed import LocalCluster
from filmed_approach import CAMERA, CAMERA_YAML, detected, frames
from patience import PATIENCE_S
from simulation import chromadock

from chromadock.output.recording import Recording
from chromadock.output.run_setup import RunSetup
from chromadock.replay.recordings import jobs_of, recordings
from chromadock.replay.run import replayed
from chromadock.vehicle.keys import CameraKeys, VehicleFile

Capture = pytest.CaptureFixture[str]
COUNTS = {"monday/dive.mcap": 14, "tuesday/dive.mcap": 8}


@pytest.fixture(scope="module")
def dives(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two recordings of one name, one that breaks off in its middle, and a file
    that is none."""
    folder = tmp_path_factory.mktemp("many") / "dives"
    for name, count in COUNTS.items():
        (folder / name).parent.mkdir(parents=True)
        record(folder / name, count)
    whole = (folder / "monday/dive.mcap").read_bytes()
    (folder / "cut.mcap").write_bytes(whole[:-3000])
    (folder / "spoilt.mcap").write_bytes(whole[:1500])
    return folder


def record(path: Path, count: int, age_s: float | None = 0.03) -> None:
    """The first frames of an approach, as of a camera."""
    calibration = path.parent / "cam.yaml"
    calibration.write_text(CAMERA_YAML)
    settings = VehicleFile(camera=CameraKeys(calibration=str(calibration)))
    pictures = frames(count)
    with Recording(path, RunSetup(settings, CAMERA)) as recording:
        for frame, detection in zip(pictures, detected(pictures), strict=True):
            recording.write(frame, detection, age_s)


def test_each_is_a_row_with_pictures_and_a_damaged_one_stops_no_other(
    dives: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(dives.parent)
    out = tmp_path / "compared"
    done = chromadock(capsys, "replay", "dives", "--out", out, "--workers", 2, "--json")
    assert done.status == 1
    told = json.loads(done.out)
    rows = {row["recording"]: row for row in told["recordings"]}
    assert list(rows) == [
        "dives/cut.mcap", "dives/monday/dive.mcap", "dives/spoilt.mcap", "dives/tuesday/dive.mcap"
    ]  # fmt: skip
    assert rows["dives/spoilt.mcap"]["fault"].startswith("dives/spoilt.mcap: not recorded by")
    assert f"error: {rows['dives/spoilt.mcap']['fault']}" in done.err
    assert "dives/cut.mcap: the recording is cut short" in done.err
    assert not rows["dives/cut.mcap"]["whole"] and 0 < rows["dives/cut.mcap"]["frames"] <= 14
    # Each is what it is by itself, but for the times, and for sums in another number of threads.
    alone = {name: replayed(dives / name, {}, None, print).summary.to_dict() for name in COUNTS}
    for name, count in COUNTS.items():
        row = rows[f"dives/{name}"]
        assert row["whole"] and row["frames"] == count
        assert row["state_differs"] == alone[name]["state_differs"] == 0
        for key in ("place_m", "attitude_deg"):
            assert row[key] == pytest.approx(alone[name][key], rel=1e-2)
        folder = out / row["folder"]
        assert sorted(p.name for p in folder.iterdir()) == [
            "comparison.json", "comparison.svg", "frames.jsonl"
        ]  # fmt: skip
        assert len((folder / "frames.jsonl").read_text().splitlines()) == count
        assert json.loads((folder / "comparison.json").read_text())["frames"] == count
    assert {row.get("folder") for row in rows.values()} == {"cut", "dive", "spoilt", "dive-2"}
    assert json.loads((out / "comparison.json").read_text()) == told
    assert sorted(p.name for p in out.iterdir()) == ["comparison.json", "cut", "dive", "dive-2"]


def test_all_together_is_of_all_frames(dives: Path, capsys: Capture) -> None:
    paths = [dives / name for name in COUNTS]
    told = json.loads(chromadock(capsys, "replay", *paths, "--json").out)
    results = [replayed(path, {}, None, print) for path in paths]
    every = [frame for result in results for frame in result.frames]
    total = told["all"]
    assert total["frames"] == sum(COUNTS.values()) == len(every)
    assert total["new"]["locked"] == sum(frame.new.locked for frame in every)
    places = [frame.place_m for frame in every if frame.place_m is not None]
    assert total["place_m"]["median"] == pytest.approx(np.median(places), rel=1e-2)
    assert total["place_m"]["largest"] == pytest.approx(max(places), rel=1e-2)
    assert total["old"]["first_locked_s"] is None


def test_the_table_has_a_line_a_recording_and_the_settings_hold_for_all(
    dives: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    """Files among the settings are sought here, though the work is done elsewhere."""
    monkeypatch.chdir(dives / "monday")
    paths = [dives / name for name in COUNTS]
    changes = ("--set", "detector.method=paper", "--set", "camera.calibration=cam.yaml")
    done = chromadock(capsys, "replay", *paths, *changes)
    assert done.status == 0, done.err
    rows = {row.split()[0]: row.split() for row in done.out.splitlines() if row.strip()}
    assert rows[str(paths[0])][1:8] == ["14", "14", "/", "14", "12", "/", "0"]
    assert rows["all"][1:8] == ["22", "22", "/", "22", "18", "/", "0"]
    assert "latency, ms" in done.out and "place, mm" in done.out and "attitude, deg" in done.out


def test_a_scheduler_elsewhere_does_the_work(
    dives: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(dives)
    with LocalCluster(
        n_workers=1, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as elsewhere:
        address = elsewhere.scheduler_address
        done = chromadock(capsys, "replay", *COUNTS, "--scheduler", address, "--json")
    assert done.status == 0, done.err
    assert [row["frames"] for row in json.loads(done.out)["recordings"]] == list(COUNTS.values())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("no.mcap", "monday"), "no.mcap: no such file"),
        (("empty",), "empty: no .mcap file in it"),
        (("monday", "--set", "dock.mapping=octal"), "--set: dock.mapping is 'octal'"),
        (("monday", "--set", "camera.calibration=none.yaml"), "none.yaml: cannot read"),
        (("monday", "--set", "camera.source=0"), "--set camera.source: changes nothing"),
        (("monday/dive.mcap", "--workers", 2), "one recording is replayed in this process"),
        (("monday", "--workers", 2, "--scheduler", "tcp://a:1"), "--workers are this machine's"),
        (("monday", "--out", "cut.mcap"), "no folder can be made there"),
    ],
)
def test_a_slip_is_told_in_a_line_before_any_work(
    dives: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
    arguments: tuple[object, ...],
    said: str,
) -> None:
    monkeypatch.chdir(dives)
    Path("empty").mkdir(exist_ok=True)
    done = chromadock(capsys, "replay", *arguments)
    assert (done.status, done.out) == (2, "")
    assert said in done.err and done.err.count("\n") == 1


def test_a_recording_is_taken_once_however_it_is_named(
    dives: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(dives)
    found = recordings([Path("tuesday/dive.mcap"), Path("tuesday"), dives / "tuesday/dive.mcap"])
    assert found == [Path("tuesday/dive.mcap")]


def test_no_two_have_one_folder() -> None:
    """Not even where a file is called as the second of a name."""
    paths = [Path("a/dive.mcap"), Path("b/dive-2.mcap"), Path("c/dive.mcap"), Path("d/dive.mcap")]
    names = [job.out and job.out.name for job in jobs_of(paths, Path("out"))]
    assert names == ["dive", "dive-2", "dive-3", "dive-4"]


def test_ctrl_c_ends_it_without_a_word(dives: Path, tmp_path: Path) -> None:
    record(tmp_path / "long.mcap", 200, None)
    shutil.copy(tmp_path / "long.mcap", tmp_path / "long-2.mcap")
    command = [sys.executable, "-m", "chromadock", "replay", ".", "--out", "out", "--workers", "1"]
    process = subprocess.Popen(
        command,
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    end = time.monotonic() + 60
    while not any(tmp_path.glob("out/*/.*partial*")):
        assert time.monotonic() < end and process.poll() is None
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: the workers get it too
    out, err = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, out, err) == (130, "", "")
