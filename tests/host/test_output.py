"""Outputs are whole or not there at all."""

import json
import math

import cv2
import numpy as np
import pytest

from chromadock.errors import ChromadockError
from chromadock.output import JsonLines, open_overlay


def picture(width=64, height=48, grey=100):
    return np.full((height, width, 3), grey, np.uint8)


def fill(path, pictures, count=None, fps=20.0):
    with open_overlay(path, count, fps) as output:
        for index, (name, image) in enumerate(pictures):
            output.write(image, name, index)


def listed(folder):
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*"))


@pytest.mark.parametrize("suffix", [".mp4", ".avi", ".mkv"])
def test_a_video_has_all_frames_and_their_rate(tmp_path, suffix):
    path = tmp_path / f"out{suffix}"
    fill(path, [("clip", picture(grey=20 * i)) for i in range(10)])
    assert listed(tmp_path) == [path.name]
    video = cv2.VideoCapture(str(path))
    assert video.get(cv2.CAP_PROP_FPS) == pytest.approx(20)
    greys = []
    while (read := video.read())[0]:
        greys.append(float(read[1].mean()))
    assert greys == pytest.approx([20 * i for i in range(10)], abs=4)


def test_pictures_of_other_sizes_are_fitted_into_the_video(tmp_path):
    sizes = [(64, 48), (128, 48), (31, 95), (7, 5)]
    fill(tmp_path / "out.avi", [("x", picture(*size)) for size in sizes])
    video = cv2.VideoCapture(str(tmp_path / "out.avi"))
    frames = [video.read()[1] for _ in sizes]
    assert all(frame.shape == (48, 64, 3) for frame in frames)
    assert frames[1][24, 32].mean() == pytest.approx(100, abs=5)
    assert frames[1][2, 32].mean() < 10  # a wide one has black above


def test_a_video_of_odd_size_keeps_its_last_row(tmp_path):
    fill(tmp_path / "out.avi", [("x", picture(33, 25))])
    ok, frame = cv2.VideoCapture(str(tmp_path / "out.avi")).read()
    assert ok
    assert frame.shape == (26, 34, 3)


def test_a_folder_has_a_picture_a_frame_named_like_it(tmp_path):
    names = ["1.jpg", "2.png", "sub/2.png", "2.jpg", "clip.mp4", "camera 0", "v1.2 take"]
    fill(tmp_path / "out", [(name, picture(grey=i)) for i, name in enumerate(names)])
    assert listed(tmp_path / "out") == sorted(
        ["1.png", "2.png", "sub_2.png", "2_000003.png", "000004.png", "000005.png", "000006.png"]
    )
    for name, grey in (("2.png", 1), ("2_000003.png", 3)):
        assert (cv2.imread(str(tmp_path / "out" / name)) == grey).all()


def test_a_folder_that_is_there_keeps_its_other_files(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "notes.txt").write_text("mine")
    cv2.imwrite(str(tmp_path / "out" / "1.png"), picture(grey=1))
    fill(tmp_path / "out", [("1.png", picture(grey=2)), ("2.png", picture())])
    assert listed(tmp_path) == ["out", "out/1.png", "out/2.png", "out/notes.txt"]
    assert (cv2.imread(str(tmp_path / "out" / "1.png")) == 2).all()


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
def test_one_frame_can_go_into_one_picture(tmp_path, suffix):
    fill(tmp_path / f"out{suffix}", [("1.jpg", picture())], count=1)
    assert listed(tmp_path) == [f"out{suffix}"]
    assert cv2.imread(str(tmp_path / f"out{suffix}")).shape == (48, 64, 3)


@pytest.mark.parametrize("name", ["out.mp4", "out.avi", "out.mkv", "out", "out.png"])
@pytest.mark.parametrize("error", [ChromadockError, KeyboardInterrupt, RuntimeError, SystemExit])
def test_an_error_leaves_nothing(tmp_path, name, error):
    def breaks():
        yield "1.png", picture()
        raise error

    with pytest.raises(error):
        fill(tmp_path / name, breaks(), count=1)
    assert listed(tmp_path) == []


def test_an_error_leaves_the_earlier_output_alone(tmp_path):
    fill(tmp_path / "out.avi", [("1.png", picture())])
    before = (tmp_path / "out.avi").read_bytes()

    def breaks():
        yield "1.png", picture(grey=7)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fill(tmp_path / "out.avi", breaks())
    assert (tmp_path / "out.avi").read_bytes() == before
    assert listed(tmp_path) == ["out.avi"]


@pytest.mark.parametrize("name", ["out.mp4", "out", "out.png"])
def test_no_frames_make_no_output(tmp_path, name):
    fill(tmp_path / name, [], count=1)
    assert listed(tmp_path) == []


@pytest.mark.parametrize(
    ("name", "count", "says"),
    [
        ("out.gif", 1, "cannot write such an overlay: give a folder or a name ending in"),
        ("out.png", 26, "one picture cannot hold 26 frames: give a folder or a .mp4"),
        ("out.png", None, "one picture cannot hold many frames"),
        ("none/out.mp4", 5, "does not exist: create it first"),
        ("file", 5, "cannot write such an overlay"),
    ],
)
def test_an_overlay_that_cannot_be_is_refused_before_any_work(tmp_path, name, count, says):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(ChromadockError) as raised:
        open_overlay(tmp_path / name, count, 30.0)
    assert says in str(raised.value)
    assert listed(tmp_path) == ["file"]


def test_a_full_disk_is_told(tmp_path, monkeypatch):
    output = open_overlay(tmp_path / "out.mp4", None, 30.0)
    output.write(picture(), "x", 0)
    monkeypatch.setattr(output, "_writer", type("Full", (), {"release": lambda self: None})())
    output._partial.write_bytes(b"only a beginning")
    with pytest.raises(ChromadockError, match="could not be finished"):
        output.keep()
    assert listed(tmp_path) == []


def test_json_lines_appear_when_done(tmp_path):
    path = tmp_path / "frames.jsonl"
    with JsonLines(path) as output:
        output.write({"frame": 0})
        assert not path.exists()
        output.write({"frame": 1, "file": "Fl\u00f6\u00dfe.png"})
    lines = path.read_text().splitlines()
    assert [json.loads(line) for line in lines] == [
        {"frame": 0},
        {"frame": 1, "file": "Fl\u00f6\u00dfe.png"},
    ]
    assert listed(tmp_path) == ["frames.jsonl"]


def test_json_lines_of_a_run_that_failed_are_dropped(tmp_path):
    with pytest.raises(ChromadockError), JsonLines(tmp_path / "frames.jsonl") as output:
        output.write({"frame": 0})
        raise ChromadockError("the video is cut short")
    assert listed(tmp_path) == []


def test_json_without_a_path_goes_to_standard_output_at_once(capsys):
    with JsonLines() as output:
        output.write({"frame": 0})
        assert capsys.readouterr().out == '{"frame": 0}\n'


def test_no_number_that_json_does_not_have_gets_through(tmp_path):
    with pytest.raises(ValueError, match="JSON"), JsonLines(tmp_path / "x.jsonl") as output:
        output.write({"t": math.nan})
    assert listed(tmp_path) == []


def test_a_place_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(ChromadockError, match="cannot be written"):
        JsonLines(tmp_path / "none" / "frames.jsonl")
