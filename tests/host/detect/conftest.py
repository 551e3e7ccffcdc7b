"""Where the tests of ``chromadock detect`` run it."""

import subprocess

import cv2
import pytest
from detect_command import water
from simulation import chromadock


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
