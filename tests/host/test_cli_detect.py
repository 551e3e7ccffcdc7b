"""``chromadock detect`` as the user runs it.

In a process of its own where OpenCV or FFmpeg might complain too, where it is stopped, or where it
writes to a terminal; in the tests' process, which is far quicker, where it is our line that counts.
"""

import fcntl
import json
import os
import pty
import signal
import struct
import subprocess
import sys
import termios
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image
from simulation import chromadock
from video_clips import cut, overwrite, patch, write_clip

from chromadock.camera import CameraModel
from chromadock.detector import Detector
from chromadock.dock import DockGeometry

COMMAND = [sys.executable, "-m", "chromadock", "detect"]
PHOTOS = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "transdec"

CAMERA = """\
image_width: {width}
image_height: {height}
camera_matrix: {{rows: 3, cols: 3, data: [{f}, 0, 320, 0, {f}, 240, 0, 0, 1]}}
distortion_model: plumb_bob
distortion_coefficients: {{rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}}
"""

WATER = (200, 160, 40)  # BGR


def detect(*arguments, cwd):
    return subprocess.run(
        [*COMMAND, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=60
    )


def listed(folder):
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*"))


def refused(done, *says):
    """Exit status 2, and one line that names the thing and the mend."""
    assert done.returncode == 2, done.stderr
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("chromadock: error: ")
    assert "Traceback" not in done.stderr
    for words in says:
        assert words in lines[0]


def water(width=640, height=480):
    """A plain blue frame, BGR."""
    return np.full((height, width, 3), WATER, np.uint8)


def dock_frame(away=1.5):
    """The default dock straight ahead at ``away`` metres, for the nominal camera, its
    markers of the colour that this water makes of them."""
    frame = water()
    dock = DockGeometry.default()
    marker = Detector(None, dock, independent=True).process(frame, 0).observed[::-1]
    points = dock.points + np.array([0, 0, away])
    for x, y in CameraModel.nominal(640, 480).project(points):
        place = (round(x * 16), round(y * 16))
        cv2.circle(frame, place, 5 * 16, marker, -1, cv2.LINE_AA, 4)
    return frame


def save_video(path, frames):
    height, width = frames[0].shape[:2]
    writer = cv2.VideoWriter(
        str(path), cv2.CAP_FFMPEG, cv2.VideoWriter_fourcc(*"MJPG"), 20.0, (width, height)
    )
    for frame in frames:
        writer.write(frame)
    writer.release()
    return path


@pytest.fixture
def folder(tmp_path):
    """A working folder with three good pictures in ``in``."""
    (tmp_path / "in").mkdir()
    for name in ("1.png", "2.png", "10.png"):
        cv2.imwrite(str(tmp_path / "in" / name), water())
    return tmp_path


@pytest.fixture
def detect_here(folder, capsys, monkeypatch):
    """Runs the command in this process, in ``folder``."""
    monkeypatch.chdir(folder)

    def run(*arguments):
        done = chromadock(capsys, "detect", *arguments)
        return subprocess.CompletedProcess(arguments, done.status, done.out, done.err)

    return run


# --- what it tells ---


def test_json_is_one_object_a_frame_and_nothing_else_on_standard_output(folder):
    done = detect("in", "--json", "--independent", "--fps", 10, cwd=folder)
    assert done.returncode == 0, done.stderr
    records = [json.loads(line) for line in done.stdout.splitlines()]
    assert [r["file"] for r in records] == ["1.png", "2.png", "10.png"]
    assert [r["frame"] for r in records] == [0, 1, 2]
    assert [r["time_s"] for r in records] == [0, 0.1, 0.2]
    assert set(records[0]) == {
        "file", "frame", "time_s", "schema", "state", "found", "background", "marker", "observed",
        "passed_fraction", "blobs", "markers", "pose", "evidence", "clipped",
        "stops_over", "misfit", "track", "timing_ms",
    }  # fmt: skip
    assert records[0]["track"] is None
    assert records[0]["background"]["rgb"] == pytest.approx(WATER[::-1], abs=4)
    assert done.stderr.splitlines() == ["3 frames, 0 found, 0 skipped"]


def test_without_json_it_is_a_table_and_a_summary(folder):
    done = detect("in", cwd=folder)
    assert done.returncode == 0
    assert done.stderr == ""
    head, *rows, summary = done.stdout.splitlines()
    assert head.split()[:2] == ["frame", "time"]
    assert [row.split()[-1] for row in rows] == ["1.png", "2.png", "10.png"]
    assert all("not found" in row and "never seen" in row for row in rows)
    assert summary == "3 frames, 0 found, 0 skipped"


def test_a_colour_that_is_given_is_looked_for_and_told(folder, detect_here):
    (folder / "ring.toml").write_text(
        'colour = "white"\n'
        + "".join(f'[[marker]]\nname = "m{n}"\nposition = [{n}, {n * n}, 0]\n' for n in (0, 1, 2))
    )
    of_file = detect_here("in", "--json", "--dock", "ring.toml")
    assert json.loads(of_file.stdout.splitlines()[0])["marker"]["given"] == "white"
    assert of_file.stderr.splitlines()[0] == (
        "chromadock: looking for markers of colour white, whatever the water is"
    )
    flag = detect_here("in", "--dock", "ring.toml", "--marker-colour", "#0000ff")
    assert flag.stderr.splitlines() == [
        "chromadock: looking for markers of colour #0000FF, hue 240 degrees, whatever the water is"
    ]


def test_the_fallback_hue_can_be_set(folder, detect_here):
    cv2.imwrite(str(folder / "grey.png"), np.full((480, 640, 3), 120, np.uint8))
    marker = [
        json.loads(detect_here("grey.png", "--json", *options).stdout)["marker"]
        for options in ((), ("--fallback-hue", "300"))
    ]
    assert [m["hue_deg"] for m in marker] == [120.0, 300.0]


def test_the_dock_is_found_with_and_without_a_calibration(folder, detect_here):
    cv2.imwrite(str(folder / "dock.png"), dock_frame())
    (folder / "cam.yaml").write_text(CAMERA.format(width=640, height=480, f=1024))
    rough = detect("dock.png", "--json", cwd=folder)
    record = json.loads(rough.stdout)
    assert record["found"] is True
    assert record["pose"]["t"] == pytest.approx([0, 0, 1.5], abs=0.03)
    assert set(record["markers"]) == set(DockGeometry.default().names)
    assert rough.stderr.count("warning: no --camera") == 1
    exact = detect_here("dock.png", "--json", "--camera", "cam.yaml")
    # Twice the focal length: the same picture is twice as far away.
    assert json.loads(exact.stdout)["pose"]["t"][2] == pytest.approx(3.0, abs=0.06)
    assert "warning" not in exact.stderr


def test_a_video_is_read_with_its_own_times_and_drawn_as_a_video(folder):
    save_video(folder / "clip.avi", [water(160, 120)] * 5)
    done = detect("clip.avi", "--json", "--overlay", "out.mp4", cwd=folder)
    assert done.returncode == 0, done.stderr
    records = [json.loads(line) for line in done.stdout.splitlines()]
    assert [r["time_s"] for r in records] == pytest.approx([0, 0.05, 0.1, 0.15, 0.2])
    assert {r["file"] for r in records} == {"clip.avi"}
    video = cv2.VideoCapture(str(folder / "out.mp4"))
    assert video.get(cv2.CAP_PROP_FRAME_COUNT) == 5


def test_an_overlay_folder_has_a_picture_for_each(folder):
    done = detect("in", "--overlay", "out", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert listed(folder / "out") == ["1.png", "10.png", "2.png"]
    assert cv2.imread(str(folder / "out" / "1.png")).shape[1] > 2 * 640


def frames_that_are_odd():
    yield "one pixel", Image.new("RGB", (1, 1), (40, 160, 200))
    yield "one row", Image.new("RGB", (640, 1), (40, 160, 200))
    yield "one column", Image.new("RGB", (1, 480), (40, 160, 200))
    yield "black", Image.new("RGB", (640, 480))
    yield "white", Image.new("RGB", (640, 480), (255, 255, 255))
    for name, rgb in (("red", (255, 0, 0)), ("grey", (128, 128, 128)), ("dull", (90, 92, 91))):
        yield f"all {name}", Image.new("RGB", (640, 480), rgb)
    yield "odd size", Image.new("RGB", (333, 77), (40, 160, 200))
    ramp = np.add.outer(np.arange(120), np.arange(160))
    yield "greyscale", Image.fromarray((ramp % 256).astype(np.uint8))
    yield "16 bit", Image.fromarray((ramp * 200).astype(np.uint16))
    yield "alpha", Image.new("RGBA", (160, 120), (40, 160, 200, 0))
    yield "palette", Image.new("RGB", (160, 120), (40, 160, 200)).quantize(2)


def test_odd_frames_are_handled_and_found_to_be_no_dock(tmp_path):
    (tmp_path / "in").mkdir()
    names = []
    for name, image in frames_that_are_odd():
        image.save(tmp_path / "in" / f"{name}.png")
        names.append(f"{name}.png")
    done = detect("in", "--json", "--independent", "--overlay", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    records = {r["file"]: r for r in map(json.loads, done.stdout.splitlines())}
    assert sorted(records) == sorted(names)
    assert not any(record["found"] for record in records.values())
    assert records["16 bit.png"]["background"]["hue_deg"] is None
    assert listed(tmp_path / "out") == sorted(names)


def test_odd_frames_do_not_disturb_the_rolling_mean(tmp_path):
    (tmp_path / "in").mkdir()
    for name, image in frames_that_are_odd():
        image.save(tmp_path / "in" / f"{name}.png")
    done = detect("in", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("what", ["distractors", "backgrounds"])
def test_real_photographs_run_through(tmp_path, what):
    photos = PHOTOS / what
    if not photos.is_dir():
        pytest.skip(f"the photographs are missing: {photos}")
    expected = len(list(photos.glob("*.jpg")))
    done = detect(photos, "--method", "paper", "--independent", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    records = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(records) == expected
    assert all(0 <= r["passed_fraction"] <= 1 for r in records)


# --- bad input ---


def test_a_corrupt_picture_is_reported_skipped_and_counted(folder):
    whole = (folder / "in" / "2.png").read_bytes()
    (folder / "in" / "2.png").write_bytes(whole[: len(whole) // 2])
    done = detect("in", "--json", "--overlay", "out", cwd=folder)
    assert done.returncode == 1
    assert [json.loads(line)["frame"] for line in done.stdout.splitlines()] == [0, 2]
    report, summary = done.stderr.splitlines()
    assert report.startswith("chromadock: error: in/2.png: not a whole picture")
    assert "(skipped)" in report
    assert summary == "2 frames, 0 found, 1 skipped"
    assert listed(folder / "out") == ["1.png", "10.png"]


@pytest.mark.parametrize(
    ("source", "says"),
    [
        ("none", "none: no such file or folder: give"),
        ("none.mp4", "none.mp4: no such file or folder: give"),
        ("in/*.tif", "in/*.tif: no picture matches: check"),
        ("empty", "empty: no pictures in this folder: it needs"),
        ("empty.mp4", "empty.mp4: the file is empty: copy it again"),
        ("notes.txt", "notes.txt: cannot be read as a video or picture: check"),
        ("broken.png", "broken.png: not a whole picture"),
        ("97", "camera 97: does not open: check"),
    ],
)
def test_a_bad_source_is_refused_in_one_line_that_tells_the_mend(folder, source, says):
    (folder / "empty").mkdir()
    (folder / "empty.mp4").touch()
    (folder / "notes.txt").write_text("the water was green today\n")
    (folder / "broken.png").write_bytes((folder / "in" / "1.png").read_bytes()[:300])
    before = listed(folder)
    done = detect(source, "--json", "--overlay", "out", cwd=folder)
    refused(done, says)
    assert done.stdout == ""
    assert listed(folder) == before


def test_a_dock_in_centimetres_is_refused_unless_confirmed(folder, detect_here):
    places = {"a": (-44.5, -6), "b": (44.5, -6), "c": (0, 20)}
    markers = [
        f"[[marker]]\nname = '{n}'\nposition = [{x}, {y}, 0]" for n, (x, y) in places.items()
    ]
    (folder / "cm.toml").write_text("\n".join(markers))
    refused(detect_here("in", "--dock", "cm.toml"), "centimetres, divide all by 100", "--yes")
    assert detect_here("in", "--dock", "cm.toml", "--yes").returncode == 0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["in", "--mapping", "rainbow"], "'rainbow': choose one of ternary, complement, contrast"),
        (["in", "--marker-colour", "bleu"], "--marker-colour is 'bleu': give \"#RRGGBB\""),
        (["in", "--dock", "navy.toml"], "navy.toml: colour is 'navy': give \"#RRGGBB\""),
        (["in", "--marker-colour", "any", "--method", "paper"], "method paper cannot look for"),
        (["in", "--fallback-hue", "360"], "fallback hue is 360: give degrees, 0 .. 359.77"),
        (["in", "--fallback-hue", "green"], "--fallback-hue"),
        (["in", "--method", "magic"], "'magic': choose one of robust, paper"),
        (["in", "--fps", "0"], "--fps is 0: it must be a positive number"),
        (["in", "--fps", "many"], "--fps"),
        (["in", "--camera", "none.yaml"], "none.yaml: cannot read"),
        (["in", "--camera", "keys.yaml"], "keys.yaml: camera_matrix is missing: give"),
        (["in", "--camera", "singular.yaml"], "singular.yaml: camera_matrix is singular: it must"),
        (["in", "--camera", "small.yaml"], "small.yaml: calibrated for 320x240 pixels, but the"),
        (["in", "--dock", "none.toml"], "none.toml: cannot be read"),
        (["in", "--dock", "two.toml"], "two.toml: 2 markers: a pose needs at least 3"),
        (["in", "--dock", "twice.toml"], "twice.toml: the name a is used 2 times: give"),
        (["in", "--dock", "nan.toml"], "nan.toml: marker c has a position that is not finite"),
        (["in", "--overlay", "out.gif"], "out.gif: cannot write such an overlay: give"),
        (["in", "--overlay", "out.png"], "out.png: one picture cannot hold 3 frames: give"),
        (["in", "--overlay", "in"], "--overlay in would overwrite the source: choose"),
        (["in", "--overlay", "no/out.mp4"], "no/out.mp4: the folder"),
        ([], "SOURCE"),
        (["in", "--colour"], "--colour"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_bad_option_is_refused_in_one_line_that_tells_the_mend(
    folder, detect_here, arguments, says
):
    camera = CAMERA.format(width=640, height=480, f=500)
    (folder / "keys.yaml").write_text(camera.replace("camera_matrix", "K"))
    (folder / "singular.yaml").write_text(CAMERA.format(width=640, height=480, f=0))
    small = CAMERA.format(width=320, height=240, f=500).replace(" 320, ", " 160, ")
    (folder / "small.yaml").write_text(small.replace(" 240, ", " 120, "))
    marker = '[[marker]]\nname = "{}"\nposition = [{}, {}, 0]\n'
    two = marker.format("a", 0, 0) + marker.format("b", 1, 0)
    (folder / "two.toml").write_text(two)
    (folder / "navy.toml").write_text('colour = "navy"\n' + two + marker.format("c", 0, 1))
    (folder / "twice.toml").write_text(two + marker.format("a", 0, 1))
    (folder / "nan.toml").write_text(two + marker.format("c", 0, "nan"))
    before = listed(folder)
    if "--overlay" not in arguments:
        arguments = [*arguments, "--overlay", "out"]
    done = detect_here(*arguments, "--json")
    refused(done, says)
    assert done.stdout == ""
    assert listed(folder) == before


def test_a_video_that_ends_mid_frame_is_used_up_to_there(folder):
    cut(write_clip(folder / "clip.avi", numbers=range(8)), 2 / 3)
    done = detect("clip.avi", "--json", "--overlay", "out.mp4", cwd=folder)
    assert done.returncode == 1
    told = [json.loads(line)["frame"] for line in done.stdout.splitlines()]
    assert told == list(range(len(told)))
    assert 1 < len(told) < 8
    report, summary = done.stderr.splitlines()
    assert report.startswith("chromadock: error: clip.avi: the video is cut short after 0.")
    assert summary == f"{len(told)} frames, 0 found, 0 skipped"
    video = cv2.VideoCapture(str(folder / "out.mp4"))
    assert video.get(cv2.CAP_PROP_FRAME_COUNT) == len(told)


def test_a_video_that_lost_its_end_and_index_is_refused_without_an_overlay(folder):
    cut(write_clip(folder / "clip.mp4", "mpeg4", numbers=range(8)), 2 / 3)
    before = listed(folder)
    done = detect("clip.mp4", "--json", "--overlay", "out.mp4", cwd=folder)
    refused(done, "clip.mp4: the video is cut short", "copy it again")
    assert done.stdout == ""
    assert listed(folder) == before


def test_a_bad_frame_of_a_video_is_reported_skipped_and_counted(folder, detect_here):
    overwrite(write_clip(folder / "clip.avi", numbers=range(8)), 3)
    done = detect_here("clip.avi", "--json", "--overlay", "out")
    assert done.returncode == 1
    kept = [0, 1, 2, 4, 5, 6, 7]
    assert [json.loads(line)["frame"] for line in done.stdout.splitlines()] == kept
    report, summary = done.stderr.splitlines()
    assert report.startswith("chromadock: error: clip.avi: frame 3 at 0.150 s cannot be decoded: ")
    assert report.endswith("(skipped)")
    assert summary == "7 frames, 0 found, 1 skipped"
    assert listed(folder / "out") == [f"{index:06d}.png" for index in kept]


def test_a_video_of_more_frames_than_it_says_does_not_fit_into_a_picture(folder, detect_here):
    # The header counts one frame, and the index that would count them is of another kind.
    clip = write_clip(folder / "clip.avi", numbers=range(3))
    patch(clip, b"strh", 4 + 32, (1).to_bytes(4, "little"))
    patch(clip, b"idx1", -4, b"JUNK")
    done = detect_here("clip.avi", "--json", "--overlay", "out.png")
    refused(done, "out.png: one picture cannot hold many frames: give a folder or a .mp4")
    assert not (folder / "out.png").exists()


@pytest.mark.parametrize("overlay", ["10:11:12.mp4", "out"])
def test_names_with_a_colon_are_names(folder, detect_here, overlay):
    """FFmpeg takes what stands before a colon for a protocol."""
    write_clip(folder / "2026-05-01T10:11:12.avi", numbers=range(3))
    done = detect_here("2026-05-01T10:11:12.avi", "--json", "--overlay", overlay)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 3
    assert (folder / overlay).exists()


def test_a_frame_of_another_size_halfway_leaves_no_overlay(folder):
    cv2.imwrite(str(folder / "in" / "2.png"), water(320, 240))
    (folder / "cam.yaml").write_text(CAMERA.format(width=640, height=480, f=500))
    before = listed(folder)
    done = detect("in", "--camera", "cam.yaml", "--json", "--overlay", "out.mp4", cwd=folder)
    refused(done, "2.png: cam.yaml: calibrated for 640x480 pixels, but the frames are 320x240")
    assert len(done.stdout.splitlines()) == 1
    assert listed(folder) == before


# --- how it ends ---


@pytest.fixture
def long_folder(tmp_path):
    """Far more pictures than are done in a second."""
    (tmp_path / "in").mkdir()
    cv2.imwrite(str(tmp_path / "picture.png"), water())
    for index in range(2000):
        (tmp_path / "in" / f"{index}.png").symlink_to(tmp_path / "picture.png")
    return tmp_path


@pytest.mark.parametrize(("signal_", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("overlay", ["out", "out.mp4"])
def test_a_run_that_is_stopped_is_quiet_and_leaves_nothing(long_folder, signal_, status, overlay):
    before = listed(long_folder)
    run = subprocess.Popen(
        [*COMMAND, "in", "--json", "--overlay", overlay],
        cwd=long_folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    run.stdout.readline()
    run.stdout.readline()
    run.send_signal(signal_)
    _, complaints = run.communicate(timeout=30)
    assert run.returncode == status
    assert complaints == ""
    assert listed(long_folder) == before


def test_a_reader_that_goes_away_is_no_fault_to_talk_about(long_folder):
    before = listed(long_folder)
    run = subprocess.Popen(
        [*COMMAND, "in", "--json", "--overlay", "out"],
        cwd=long_folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    run.stdout.readline()
    run.stdout.close()
    complaints = run.stderr.read()
    run.stderr.close()
    assert run.wait(timeout=30) == 141
    assert complaints == ""
    assert listed(long_folder) == before


def test_a_long_source_shows_its_progress_on_a_terminal_only(folder):
    for index in range(100, 130):
        (folder / "in" / f"{index}.png").symlink_to(folder / "in" / "1.png")
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 100, 0, 0))
    with (folder / "out.jsonl").open("w") as out:
        run = subprocess.Popen(
            [*COMMAND, "in", "--json"], cwd=folder, stdout=out, stderr=theirs,
            env={**os.environ, "TERM": "xterm"},
        )  # fmt: skip
    os.close(theirs)
    shown = b""
    try:
        while part := os.read(ours, 4096):
            shown += part
    except OSError:  # how a terminal says that nobody is there any more
        pass
    os.close(ours)
    assert run.wait(timeout=30) == 0
    assert b"detecting" in shown
    assert b"/33" in shown
    assert b"33 frames, 0 found, 0 skipped" in shown
    lines = (folder / "out.jsonl").read_text().splitlines()
    assert len([json.loads(line) for line in lines]) == 33
    assert b"detecting" not in detect("in", "--json", cwd=folder).stderr.encode()


def test_usage_is_told_without_a_traceback(tmp_path):
    for arguments in ([], ["nonsense"], ["--nonsense"]):
        done = subprocess.run(
            [*COMMAND[:3], *arguments], cwd=tmp_path, capture_output=True, text=True, timeout=60
        )
        refused(done, "chromadock --help")
    done = subprocess.run(
        [*COMMAND[:3], "--help"], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0
    assert "detect" in done.stdout


def test_a_hue_beyond_the_last_one_is_a_line_and_the_last_one_is_none(folder):
    """The largest that --help and messages name is accepted, a hair more is not a traceback."""
    assert detect("in", "--fallback-hue", "359.77", cwd=folder).returncode == 0
    done = detect("in", "--fallback-hue", "359.8", cwd=folder)
    assert done.returncode == 2
    assert done.stderr.splitlines() == [
        "chromadock: error: an option: dock.fallback_hue_deg is 359.8: "
        "it must be 0 to 359.77 degrees"
    ]
