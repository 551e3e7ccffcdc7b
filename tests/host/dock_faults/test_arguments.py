"""Slips in what the user typed, and in the files that it names; flashing."""

import subprocess
import sys

import pytest
from simulation import chromadock

from chromadock.cli import dock_flash
from chromadock.link import Connection, DockClient


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("params", "get", "LED_LIMITS"), "did you mean LED_LIMIT?"),
        (("params", "get", "qqq"), "params list"),
        (("params", "set", "MAPPING", "sepia"), "ternary | complement"),
        (("params", "set", "MAPPING", "3"), "ternary | complement | contrast"),
        (("params", "set", "LED_GAMMA", "2"), "1.0 | 1.8 | 2.2 | 2.8"),
        (("params", "set", "WINDOW_MS", "50"), "100 .. 2000 ms"),
        (("params", "set", "WINDOW_MS", "500.5"), "a whole number 100 .. 2000 ms"),
        (("params", "set", "WINDOW_MS", "nan"), "100 .. 2000 ms"),
        (("params", "set", "LED_M_RR", "8"), "-8 .. 7.99976"),
        (("params", "set", "LED_LIMIT", "much"), "0 .. 255"),
        (("params", "load", "missing.toml"), "missing.toml: cannot be read"),
        (("led", "red"), "0..255"),
        (("led", "1", "2"), "0..255"),
        (("led", "1", "2", "256"), "0..255"),
        (("led", "1", "2", "inf"), "0..255"),
        (("led", "-1"), "0..360"),
        (("led", "361"), "0..360"),
        (("snapshot", "out.jpg"), ".png"),
        (("snapshot", "missing/out.png"), "no folder missing"),
        (("inject", "missing.png"), "missing.png: no such file"),
        (("simulate", "missing.mp4"), "missing.mp4: no such file"),
        (("simulate", "--fps", "0"), "--fps"),
        (("simulate", "--fps", "nan"), "--fps"),
        (("simulate", "--fault", "flood"), "--fault flood"),
        (("simulate", "--tcp", "0.0.0.0:1"), "only localhost"),
        (("simulate", "--settings", "."), "--settings"),
        (("frobnicate",), "see chromadock --help"),
        (("params", "set", "MAPPING"), "see chromadock --help"),
    ],
)
def test_a_slip_in_the_arguments(refused, arguments, says, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    refused(*arguments, says=says)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("LED_LIMIT = 7\nLED_LIMITS = 1\n", ["dock.toml", "LED_LIMITS", "did you mean LED_LIMIT?"]),
        ("LED_LIMIT = 7\nWINDOW_MS = 3000\n", ["dock.toml", "WINDOW_MS is 3000", "100 .. 2000 ms"]),
        ("LED_LIMIT = true\n", ["dock.toml", "LED_LIMIT must be a number"]),
        ("LED_LIMIT = [7]\n", ["dock.toml", "LED_LIMIT must be a number"]),
        ("LED_LIMIT = \n", ["dock.toml", "not valid TOML"]),
        ("", ["dock.toml", "sets nothing"]),
    ],
)
def test_a_file_of_parameters_with_a_fault_sets_none(refused, url, tmp_path, text, says):
    file = tmp_path / "dock.toml"
    file.write_text(text)
    refused("params", "load", file, port=url, says=says)
    with DockClient(Connection(url)) as client:
        assert client.parameter("LED_LIMIT") == 255


def test_a_file_of_parameters_that_is_no_text(refused, tmp_path):
    file = tmp_path / "dock.toml"
    file.write_bytes(b"\xff\xfe\x00")
    refused("params", "load", file, says=["dock.toml", "not a text file"])


def test_a_snapshot_that_cannot_be_written_leaves_nothing(refused, url, tmp_path):
    out = tmp_path / "out.png"
    out.mkdir()
    refused("snapshot", out, port=url, says=["out.png", "cannot be written"])
    assert list(tmp_path.iterdir()) == [out]


# Flashing


@pytest.fixture
def project(tmp_path, monkeypatch):
    (tmp_path / "platformio.ini").write_text("[env:esp32cam]\n")
    inside = tmp_path / "docs"
    inside.mkdir()
    monkeypatch.chdir(inside)
    return tmp_path


def test_flash_without_platformio(refused, project, monkeypatch):
    monkeypatch.setattr(sys, "executable", str(project / "python"))
    monkeypatch.setenv("PATH", str(project))
    refused("flash", says=["PlatformIO is not installed", "pip install platformio"])


def test_flash_outside_the_project(refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    refused("flash", says=["no platformio.ini", "--project"])


def test_flash_calls_platformio_with_project_and_port(project, monkeypatch, capsys):
    called = []
    pio = project / "pio"
    pio.write_text("#!/bin/sh\n")
    pio.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(project / "python"))
    monkeypatch.setattr(
        dock_flash.subprocess,
        "run",
        lambda command, check: called.append(command) or subprocess.CompletedProcess(command, 0),
    )
    assert chromadock(capsys, "dock", "flash", "--port", "/dev/null").status == 0
    words = f"{pio} run --project-dir {project} -e esp32cam -t upload --upload-port /dev/null"
    assert called == [words.split()]


def test_flash_that_fails(refused, project, monkeypatch):
    pio = project / "pio"
    pio.write_text("#!/bin/sh\nexit 3\n")
    pio.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(project / "python"))
    refused("flash", says=["status 3", "IO0"])


def test_flash_needs_a_serial_port(refused, project):
    refused("flash", port="socket://localhost:1", says="serial port only")
    refused("flash", port="/dev/ttyUSB77", says="no such port")
