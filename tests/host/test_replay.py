"""``chromadock replay``: the same again, and with other settings."""

from __future__ import annotations

import importlib.util
import json
import math
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from filmed_approach import CAMERA, CAMERA_YAML, detected, frames
from simulation import chromadock

from chromadock import Detector, DockGeometry
from chromadock.output.recording import Recording
from chromadock.output.run_setup import RunSetup
from chromadock.replay.compared import compared
from chromadock.replay.pairs import Pair, attitude_difference_deg, place_difference_m
from chromadock.replay.recorded import read_recorded
from chromadock.replay.results import MOST_WAITING, Result
from chromadock.results.detection import Background, Detection, Marker
from chromadock.results.pose import Pose
from chromadock.results.track import Track, TrackedPose
from chromadock.sources import open_source
from chromadock.vehicle.keys import CameraKeys, VehicleFile

COUNT = 14
Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def dive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An approach of a camera, recorded from its third second on."""
    folder = tmp_path_factory.mktemp("replay")
    (folder / "cam.yaml").write_text(CAMERA_YAML)
    settings = VehicleFile(camera=CameraKeys(calibration=str(folder / "cam.yaml")))
    pictures = frames(COUNT, start_s=3.0)
    with Recording(folder / "dive.mcap", RunSetup(settings, CAMERA)) as recording:
        for frame, detection in zip(pictures, detected(pictures), strict=True):
            recording.write(frame, detection, 0.03)
    (folder / "cam.yaml").unlink()  # the recording has it
    return folder / "dive.mcap"


def test_the_same_settings_say_the_same_but_for_what_the_jpeg_lost(
    dive: Path, capsys: Capture
) -> None:
    done = chromadock(capsys, "replay", dive, "--json")
    assert done.status == 0, done.err
    told = json.loads(done.out)
    assert (told["frames"], told["not_recorded"], told["state_differs"]) == (COUNT, 0, 0)
    assert told["old"]["found"] == told["new"]["found"] == COUNT
    assert told["old"]["locked"] == told["new"]["locked"] == COUNT - 2
    assert told["old"]["first_locked_s"] == told["new"]["first_locked_s"] == 3.1
    assert told["place_m"]["frames"] == COUNT - 2
    assert 0 < told["place_m"]["largest"] < 0.002  # 0.1 % of 2 m
    # What JPEG loses moves the tops of lamps, and with that by how much each of them counts.
    assert 0 < told["attitude_deg"]["largest"] < 0.5


def test_a_replay_is_what_the_detector_says_of_the_recorded_frames_at_their_times(
    dive: Path, tmp_path: Path, capsys: Capture
) -> None:
    """To the last digit, and twice the same: nothing but the frames and settings counts."""
    folders = [tmp_path / "a", tmp_path / "b"]
    for folder in folders:
        assert chromadock(capsys, "replay", dive, "--out", folder).status == 0
    lines = [
        [json.loads(line) | {"timing_ms": {}} for line in (f / "frames.jsonl").open()]
        for f in folders
    ]
    assert lines[0] == lines[1]
    detector = Detector(CAMERA, DockGeometry.default())
    with open_source(str(dive)) as source:
        for frame, line in zip(source, lines[0], strict=True):
            assert frame.time_s == pytest.approx(3.0 + frame.index / 20, abs=1e-9)
            said = detector.process(frame.image, frame.time_s).to_dict() | {"timing_ms": {}}
            assert said == {key: line[key] for key in said}


def test_another_setting_holds_and_its_effect_is_told(dive: Path, capsys: Capture) -> None:
    """The paper's method has no track, so nothing is locked."""
    done = chromadock(capsys, "replay", dive, "--set", "detector.method=paper", "--json")
    told = json.loads(done.out)
    assert told["new"]["locked"] == 0 and told["only_old_locked"] == COUNT - 2
    assert told["new"]["first_locked_s"] is None
    assert told["place_m"]["largest"] > 0.002
    recorded = read_recorded(dive, {"dock.mapping": "contrast", "mounting.pitch_deg": -3.0})
    assert recorded.settings.dock.mapping == "contrast"
    assert recorded.settings.mounting is not None and recorded.settings.mounting.pitch_deg == -3.0
    assert recorded.camera is not None and recorded.camera.matrix[0, 0] == 512


def test_a_result_is_found_by_its_frame_though_others_have_none(
    tmp_path: Path,
) -> None:
    """Of frames that cannot be read results are left over, ever so many."""
    many = tmp_path / "many.mcap"
    frame = frames(1)[0]
    detection = detected([frame])[0]
    with Recording(many, RunSetup(VehicleFile(), CAMERA)) as recording:
        for k in range(3 * MOST_WAITING):
            small = np.zeros((8, 8, 3), np.uint8)
            evidence = replace(detection, evidence=float(k))
            recording.write(replace(frame, image=small, index=k, time_s=k / 8), evidence, None)
    results = read_recorded(many, {}).results
    for k in (0, 1, 2 * MOST_WAITING, 2 * MOST_WAITING + 1, 3 * MOST_WAITING - 1):
        assert results.at(k / 8 - 0.01) is None
        found = results.at(k / 8)
        assert found is not None and found.detection.evidence == k
        assert len(results._waiting) <= MOST_WAITING
    assert results.at(3 * MOST_WAITING / 8) is None


def test_the_table_has_both_runs_and_the_folder_figures_frames_and_a_picture(
    dive: Path, tmp_path: Path, capsys: Capture
) -> None:
    out = tmp_path / "compared"
    done = chromadock(capsys, "replay", dive, "--out", out)
    rows = [line.split() for line in done.out.splitlines()]
    assert ["│", "found", "│", str(COUNT), "│", str(COUNT), "│", "+0", "│"] in rows
    assert sorted(p.name for p in out.iterdir()) == [
        "comparison.json", "comparison.svg", "frames.jsonl"
    ]  # fmt: skip
    assert json.loads((out / "comparison.json").read_text())["frames"] == COUNT
    texts = {e.text for e in ElementTree.parse(out / "comparison.svg").iter() if e.text}
    assert {"recorded", "replayed", "range, m", "difference of place, mm"} <= texts
    assert {"not found", "found", "locked", "of attitude, degrees", "latency, ms"} <= texts


def test_the_latency_is_the_runs_with_the_new_time_of_the_frame(
    dive: Path, capsys: Capture
) -> None:
    """Of the recording 30 ms each."""
    told = json.loads(chromadock(capsys, "replay", dive, "--json").out)
    old, new = told["old"], told["new"]
    assert old["latency_ms"] == old["latency_99_ms"] == 30.0
    assert new["latency_99_ms"] >= new["latency_ms"] is not None
    first = read_recorded(dive, {}).results.at(3.0)
    assert first is not None and first.age_s == 0.03
    before, faster, slower = (
        replace(first.detection, timing_ms={"total": spent_ms}) for spent_ms in (20.0, 1.0, 27.0)
    )
    result = Result(before, 0.03)
    assert compared(3.0, result, slower).new.latency_ms == pytest.approx(37.0)
    assert compared(3.0, result, faster).new.latency_ms == pytest.approx(11.0)
    assert compared(3.0, replace(result, age_s=None), faster).new.latency_ms is None
    rows = chromadock(capsys, "replay", dive).out.splitlines()
    assert any(row.split()[1:5] == ["latency,", "ms", "│", "30.0"] for row in rows)


def test_without_matplotlib_there_is_all_but_the_picture(
    dive: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = importlib.util.find_spec
    monkeypatch.setattr(
        "chromadock.replay.run.find_spec",
        lambda name: None if name == "matplotlib" else found(name),
    )
    done = chromadock(capsys, "replay", dive, "--out", tmp_path)
    assert done.status == 0 and "no picture: matplotlib is not installed" in done.err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["comparison.json", "frames.jsonl"]


def test_an_unfinished_recording_is_replayed_as_far_as_it_goes(
    dive: Path, tmp_path: Path, capsys: Capture
) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(dive.read_bytes()[:-3000])
    done = chromadock(capsys, "replay", cut, "--json")
    assert done.status == 1 and "cut short (it was never finished" in done.err
    assert 0 < json.loads(done.out)["frames"] <= COUNT


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("dock.mapping=octal", "--set: dock.mapping is 'octal': it must be one"),
        ("detector.metod=paper", "unknown key detector.metod"),
        ("method", "--set method: write key=value, e.g. dock.mapping=contrast"),
        ("camera.source=0", "--set camera.source: changes nothing in a replay"),
        ("outputs.record=x", "--set outputs.record: changes nothing in a replay"),
        ("camera.calibration=none.yaml", "none.yaml: cannot read the camera file"),
    ],
)
def test_a_change_that_is_none_is_one_line(
    dive: Path, capsys: Capture, change: str, said: str
) -> None:
    done = chromadock(capsys, "replay", dive, "--set", change)
    assert (done.status, done.out) == (2, "")
    assert said in done.err and done.err.count("\n") == 1


def test_what_is_no_recording_is_one_line(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "a.mp4").write_bytes(b"\0" * 100)
    for name, said in (("a.mp4", "not recorded by chromadock"), ("b.mcap", "no such file")):
        done = chromadock(capsys, "replay", tmp_path / name)
        assert done.status == 2 and said in done.err and done.err.count("\n") == 1


def test_results_of_another_schema_are_one_line_that_names_the_recording(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    frame = frames(1)[0]
    with monkeypatch.context() as later:
        later.setattr("chromadock.results.record.SCHEMA", 2)
        with Recording(tmp_path / "new.mcap", RunSetup(VehicleFile(), CAMERA)) as recording:
            recording.write(frame, detected([frame])[0], None)
    done = chromadock(capsys, "replay", tmp_path / "new.mcap")
    assert done.status == 2 and done.err.count("\n") == 1
    assert "new.mcap: /chromadock/detection: a detection of schema 2" in done.err


def test_an_out_that_is_a_file_is_one_line(dive: Path, capsys: Capture) -> None:
    done = chromadock(capsys, "replay", dive, "--out", dive)
    assert done.status == 2 and "no folder can be made there (File exists)" in done.err


def result(t: tuple[float, float, float], turn_deg: float, track: str | None) -> Detection:
    """A detection at ``t``, turned about an axis that is none of the camera's."""
    half = math.radians(turn_deg) / 2
    axis = np.array([1, 2, 2]) / 3 * math.sin(half)
    q = (math.cos(half), *axis.tolist())
    told = None
    if track is not None:
        told = Track(track, 0.0, TrackedPose(t, q, (0.0,) * 36, 1.0))
    return Detection(
        "found", Background((0, 0, 0), None, 0.0), Marker(None, None), None, 0.0,
        pose=Pose(t, q, 0.1), track=told,
    )  # fmt: skip


@pytest.mark.parametrize("turn_deg", [1e-6, 0.5, 30.0, 179.0])
def test_differences_are_of_geometry(turn_deg: float) -> None:
    pair = Pair(result((0, 0, 2), 10, None), result((0.3, 0.4, 2), 10 + turn_deg, "tracking"))
    assert place_difference_m(pair) == pytest.approx(0.5)
    assert attitude_difference_deg(pair) == pytest.approx(turn_deg, rel=1e-6)


def test_a_track_that_has_lost_the_dock_has_no_pose_to_compare() -> None:
    lost = Pair(result((0, 0, 2), 0, "tracking"), result((0, 0, 2), 0, "recently_lost"))
    assert place_difference_m(lost) is None and attitude_difference_deg(lost) is None
