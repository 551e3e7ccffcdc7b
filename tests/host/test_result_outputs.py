"""Results go to files and the network, and what fails there never stops the detection."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import cv2
import numpy as np
import pytest

from chromadock import Detection
from chromadock.errors import ChromadockError
from chromadock.output import Guarded, ResultOutput, Surroundings
from chromadock.output import open_output as open_named
from chromadock.results.detection import Background, Marker
from chromadock.sources import Frame

FRAME = Frame(np.zeros((4, 4, 3), np.uint8), "camera 0", 7, 1.25)
RESULT = Detection(
    "not_found", Background((10, 100, 90), 170.0, 0.8), Marker(None, None), None, 0.0
)


def open_output(text: str) -> ResultOutput:
    return open_named(text, Surroundings(None, print))


class Moody(ResultOutput):
    """Fails as often as it is told to."""

    def __init__(self, failures: int) -> None:
        self.left = failures
        self.written = 0

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        if self.left:
            self.left -= 1
            raise ChromadockError("log.jsonl: cannot be written (No space left): check disk")
        self.written += 1


def test_an_output_that_fails_is_told_once_tried_again_ever_later_and_told_when_it_is_back() -> (
    None
):
    clock, lines, output = [0.0], list[str](), Moody(3)
    guarded = Guarded(output, lines.append, lambda: clock[0])
    tries = []
    for step in range(60):
        clock[0] = step / 10
        before = output.left
        guarded.write(FRAME, RESULT, None)
        if output.left != before:
            tries.append(clock[0])
    assert tries == [0.0, 0.5, 1.5]
    assert [line.split(":")[1] for line in lines] == [" log.jsonl"] * 2
    assert lines[0].endswith("the detection goes on, and it is tried again")
    assert "works again after 3.5 s, 35 results lost" in lines[1]
    assert output.written == 25


def test_a_file_gets_whole_lines_after_those_that_are_there(tmp_path: Path) -> None:
    path = tmp_path / "dive.jsonl"
    for _ in range(2):
        with open_output(f"json:{path}") as output:
            output.write(FRAME, RESULT, 0.0625)
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    assert len(lines) == 2
    assert lines[0] | {"timing_ms": {}} == lines[1] | {"timing_ms": {}}
    assert {key: lines[0][key] for key in ("file", "frame", "time_s", "age_s")} == {
        "file": "camera 0", "frame": 7, "time_s": 1.25, "age_s": 0.0625
    }  # fmt: skip
    assert Detection.from_dict(lines[0]).state == "not_found"


def test_a_full_disk_is_a_line_and_no_half_line(tmp_path: Path) -> None:
    said = pytest.raises(ChromadockError, match="/dev/full: cannot be written")
    with open_output("json:/dev/full") as output, said as refused:
        output.write(FRAME, RESULT, None)
    assert "\n" not in str(refused.value)


def test_a_limit_in_the_middle_of_a_line_leaves_the_lines_before(tmp_path: Path) -> None:
    """A file that may grow to 2000 bytes only takes what a full disk does: a part of a line."""
    path = tmp_path / "dive.jsonl"
    program = f"""
import resource, signal
from test_result_outputs import FRAME, RESULT, open_output
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
with open_output("json:{path}") as output:
    for _ in range(10):
        try:
            output.write(FRAME, RESULT, None)
        except Exception as error:
            print(error)
"""
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=Path(__file__).parent, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert "disk is full" in done.stdout
    lines = path.read_text().splitlines()
    assert len(lines) > 2 and all(json.loads(line)["frame"] == 7 for line in lines)
    assert path.read_text().endswith("\n")


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost"])
def test_each_result_is_a_datagram(host: str) -> None:
    family = socket.getaddrinfo(host, 0, type=socket.SOCK_DGRAM)[0][0]
    with socket.socket(family, socket.SOCK_DGRAM) as listener:
        listener.bind((host, 0))
        listener.settimeout(5)
        with open_output(f"udp:{host}:{listener.getsockname()[1]}") as output:
            output.write(FRAME, RESULT, None)
            output.write(FRAME, RESULT, None)
        told = [json.loads(listener.recv(65536)) for _ in range(2)]
    assert told[0]["frame"] == 7 and "age_s" not in told[0]


def test_nobody_who_listens_is_no_fault() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with open_output(f"udp:127.0.0.1:{port}") as output:
        for _ in range(3):
            output.write(FRAME, RESULT, None)
            time.sleep(0.01)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("found.jsonl", "no such output: give one of json:FILE"),
        ("json:", "no such output"),
        ("pigeon:home", "no such output"),
        ("json:no/such/folder.jsonl", "no such folder: create it first"),
        ("json:/", "cannot be written"),
        ("udp:9000", "give udp:HOST:PORT"),
        ("mavlink:udpin:0.0.0.0:14550", "no receiver: add ?receiver="),
        ("udp:host:99999", "give udp:HOST:PORT"),
        ("http:99999", "give http:PORT for this computer alone"),
        ("http:localhost", "give http:PORT for this computer alone"),
        ("http:no.such.host.invalid:8642", "cannot listen there"),
        ("udp:no.such.host.invalid:9000", "no such host"),
    ],
)
def test_what_is_no_output_is_refused_in_one_line(text: str, said: str) -> None:
    with pytest.raises(ChromadockError, match=re.escape(said)) as refused:
        open_output(text)
    assert "\n" not in str(refused.value)


@pytest.fixture
def pictures(tmp_path: Path) -> Path:
    folder = tmp_path / "pictures"
    folder.mkdir()
    for k in range(5):
        cv2.imwrite(str(folder / f"{k}.png"), np.full((120, 160, 3), (140, 110 + k, 30), np.uint8))
    return folder


def test_detect_feeds_several_outputs_and_goes_on_without_one(pictures: Path) -> None:
    log = pictures.parent / "log.jsonl"
    command = [
        *(sys.executable, "-m", "chromadock", "detect", str(pictures), "--json"),
        *("--out", f"json:{log}", "--out", "json:/dev/full"),
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 5
    timing = {"timing_ms": None}
    printed, logged = (
        [json.loads(line) | timing for line in text.splitlines()]
        for text in (done.stdout, log.read_text())
    )
    assert printed == logged
    assert done.stderr.count("/dev/full: cannot be written") == 1


def test_a_kill_leaves_whole_lines(pictures: Path) -> None:
    log = pictures.parent / "log.jsonl"
    command = [sys.executable, "-m", "chromadock", "detect", str(pictures / "*.png"), "--out"]
    for k in range(300):
        os.link(pictures / "0.png", pictures / f"more{k}.png")
    with subprocess.Popen([*command, f"json:{log}"], stdout=subprocess.DEVNULL) as run:
        while not log.exists() or log.stat().st_size < 20_000:
            assert run.poll() is None
            time.sleep(0.01)
        run.send_signal(signal.SIGKILL)
    lines = log.read_bytes().split(b"\n")
    assert lines[-1] == b"" and len(lines) > 10
    assert [json.loads(line)["frame"] for line in lines[:-1]] == list(range(len(lines) - 1))
