"""What ``chromadock detect`` tells."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from detect_command import CAMERA, WATER, detect, listed, water
from PIL import Image
from video_clips import write_clip

from chromadock.camera import CameraModel
from chromadock.detector import Detector
from chromadock.dock import DockGeometry

PHOTOS = Path(__file__).resolve().parents[3].parent / "shared" / "data" / "transdec"


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


@pytest.mark.parametrize("overlay", ["10:11:12.mp4", "out"])
def test_names_with_a_colon_are_names(folder, detect_here, overlay):
    """FFmpeg takes what stands before a colon for a protocol."""
    write_clip(folder / "2026-05-01T10:11:12.avi", numbers=range(3))
    done = detect_here("2026-05-01T10:11:12.avi", "--json", "--overlay", overlay)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 3
    assert (folder / overlay).exists()
