"""What ``chromadock detect`` says of sources and options that are at fault."""

import json
import subprocess

import cv2
import pytest
from detect_command import CAMERA, COMMAND, detect, listed, refused, water
from patience import PATIENCE_S
from video_clips import cut, overwrite, patch, write_clip


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


def test_a_frame_of_another_size_halfway_leaves_no_overlay(folder):
    cv2.imwrite(str(folder / "in" / "2.png"), water(320, 240))
    (folder / "cam.yaml").write_text(CAMERA.format(width=640, height=480, f=500))
    before = listed(folder)
    done = detect("in", "--camera", "cam.yaml", "--json", "--overlay", "out.mp4", cwd=folder)
    refused(done, "2.png: cam.yaml: calibrated for 640x480 pixels, but the frames are 320x240")
    assert len(done.stdout.splitlines()) == 1
    assert listed(folder) == before


def test_usage_is_told_without_a_traceback(tmp_path):
    for arguments in ([], ["nonsense"], ["--nonsense"]):
        done = subprocess.run(
            [*COMMAND[:3], *arguments],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
        )
        refused(done, "chromadock --help")
    done = subprocess.run(
        [*COMMAND[:3], "--help"], cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE_S
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
