"""No secret of an address is shown anywhere; and the order of pictures."""

import json
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import pytest
from simulation import chromadock
from video_clips import cut, write_clip

from chromadock.errors import ChromadockError
from chromadock.sources import open_source
from chromadock.sources.address import without_secrets
from chromadock.sources.order import natural_key

SECRETS = [
    ("rtsp://user:secret@10.0.0.2:554/live", "rtsp://...@10.0.0.2:554/live"),
    ("rtsp://user:p@secret@10.0.0.2/live", "rtsp://...@10.0.0.2/live"),
    ("rtsp://user:p/secret@10.0.0.2/live", "rtsp://...@10.0.0.2/live"),
    ("rtsp://user:p?secret@10.0.0.2/live", "rtsp://...@10.0.0.2/live"),
    ("rtsp://secret@10.0.0.2/live", "rtsp://...@10.0.0.2/live"),
    ("http://cam/v.mjpg?pwd=secret&user=a", "http://cam/v.mjpg..."),
    ("http://cam/v.mjpg?secret", "http://cam/v.mjpg..."),
    ("http://cam/v.mjpg#token=secret", "http://cam/v.mjpg..."),
    ("http://cam/a/user=admin&password=secret&channel=1", "http://cam/a/..."),
    ("http://cam/a;password=secret", "http://cam/a..."),
    ("http://cam/v?mail=secret@home", "http://...@home"),
    ("rtsp:/user:secret@cam/live", "rtsp://...@cam/live"),
    ("user:secret@cam/live", "...@cam/live"),
]


@pytest.mark.parametrize(("address", "shown"), SECRETS)
def test_an_address_is_shown_without_its_secrets(address, shown):
    assert without_secrets(address) == shown
    assert "secret" not in shown


@pytest.mark.parametrize(
    "text", ["clip@10:11:12.mp4", "2026-05-01T10:11:12.mp4", "a b?.png", "rtsp://cam:554/live/1"]
)
def test_what_has_no_secret_is_shown_as_it_is(text):
    assert without_secrets(text) == text


@pytest.mark.parametrize(
    "address",
    [
        "rtsp://user:p@secret@127.0.0.1:9/live",
        "http://127.0.0.1:9/v.mjpg?pwd=secret",
        "http://127.0.0.1:9/v.mp4?token=secret",
        "http:/127.0.0.1:9/v.mp4?token=secret",
        "user:secret@127.0.0.1/live",
        "rtspsrc location=rtsp://a:secret@127.0.0.1/x user-pw=secret ! appsink",
    ],
)
def test_an_address_that_does_not_answer_is_told_without_its_secrets(address):
    with pytest.raises(ChromadockError) as raised:
        open_source(address)
    assert "secret" not in str(raised.value)
    assert "\n" not in str(raised.value)


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_arguments):
        pass


@pytest.fixture
def server(tmp_path):
    """A web server with a whole video and one that was cut short."""
    write_clip(tmp_path / "clip.avi", numbers=range(5))
    cut(write_clip(tmp_path / "cut.mp4", "mpeg4", muxer={"movflags": "faststart"}), 0.5)
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=tmp_path)) as web:
        threading.Thread(target=web.serve_forever, daemon=True).start()
        yield f"127.0.0.1:{web.server_port}"
        web.shutdown()


def test_frames_of_a_video_behind_an_address_are_named_without_its_secrets(server, capsys):
    address = f"http://user:p@secret@{server}/clip.avi?token=secret"
    done = chromadock(capsys, "detect", address, "--json", "--method", "paper")
    assert done.status == 0, done.err
    records = [json.loads(line) for line in done.out.splitlines()]
    assert [r["file"] for r in records] == [f"http://...@{server}/clip.avi..."] * 5
    assert [r["time_s"] for r in records] == pytest.approx([0, 0.05, 0.1, 0.15, 0.2])
    assert "secret" not in done.out + done.err


def test_faults_of_a_video_behind_an_address_are_told_without_its_secrets(server):
    lines = []
    with open_source(f"http://{server}/cut.mp4?token=secret", on_fault=lines.append) as source:
        assert 5 < len(list(source)) < 30
    assert lines
    assert not any("secret" in line for line in lines)
    assert source.errors or source.cut_short


@pytest.mark.parametrize(
    "names",
    [
        ["1", "2", "10"],
        ["img2", "img10"],
        ["IMG_9", "img_10"],
        ["0.25", "0.5", "1", "1.05", "1.5", "10"],
        ["t1714558272.040", "t1714558272.2", "t1714558273.1"],
        ["2026.05.02", "2026.05.10", "2026.11.1"],
        ["2026-05-01T10_11_09.5", "2026-05-01T10_11_10"],
        ["a", "B", "c"],
        ["left/2", "left/10", "right/1"],
    ],
)
def test_names_go_in_the_order_in_which_people_count(names):
    files = [f"{name}.png" for name in names]
    assert sorted(reversed(files), key=natural_key) == files


def test_names_that_differ_in_their_letters_case_alone_have_one_order():
    for names in (["A.png", "a.png"], ["a.png", "A.png"]):
        assert sorted(names, key=natural_key) == ["A.png", "a.png"]
