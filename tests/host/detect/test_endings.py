"""How ``chromadock detect`` ends, and what it shows on a terminal until then."""

import fcntl
import json
import os
import pty
import signal
import struct
import subprocess
import termios

import cv2
import pytest
from detect_command import COMMAND, detect, listed, water


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
