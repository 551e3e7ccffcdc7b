"""The systemd unit: read by systemd's own checker, and its commands run as they stand there."""

from __future__ import annotations

import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import av
import pytest
from systemd_unit import read_unit
from web_camera import web_camera

from chromadock.cli.exit_status import EXIT_TERMINATED
from chromadock.ros.mcap_bag import McapBag
from chromadock.ros.topics import RECORD

UNIT = Path(__file__).resolve().parents[3] / "deploy" / "systemd" / "chromadock.service"
INSTALLED = "/opt/chromadock/.venv/bin/"
NEWER = {"RestartSteps", "RestartMaxDelaySec"}
"""Keys that systemd knows from 254 on."""


@pytest.fixture(scope="module")
def camera() -> Iterator[str]:
    with web_camera() as url:
        yield url


def command(key: str, folder: Path) -> list[str]:
    """A command of the unit, with the folders of this test in place of the system's."""
    text = read_unit(UNIT)["Service"][key]
    assert text.startswith(INSTALLED)
    text = text.replace(INSTALLED, f"{Path(sys.executable).parent}/").replace("%E", str(folder))
    return shlex.split(text)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """With what ConfigurationDirectory and StateDirectory make."""
    service = read_unit(UNIT)["Service"]
    (tmp_path / service["ConfigurationDirectory"]).mkdir()
    assert service["WorkingDirectory"] == f"%S/{service['StateDirectory']}"
    (tmp_path / "state").mkdir()
    return tmp_path


def test_systemd_finds_no_fault_with_the_unit(tmp_path: Path) -> None:
    if not shutil.which("systemd-analyze"):
        pytest.skip("no systemd-analyze here (Debian: systemd)")
    text = UNIT.read_text().replace(INSTALLED, f"{Path(sys.executable).parent}/")
    copy = tmp_path / UNIT.name
    copy.write_text(text)
    done = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", str(copy)], capture_output=True, text=True
    )
    unknown = re.compile(r".*: Unknown key (?:name )?'(\w+)' in section .Service., ignoring\.")
    for line in done.stderr.splitlines():
        found = unknown.fullmatch(line)
        assert found is not None and found[1] in NEWER, line
    assert done.returncode == 0
    copy.write_text(text.replace("Restart=on-failure", "Restart=on-fail"))
    done = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", str(copy)], capture_output=True, text=True
    )
    assert "on-fail" in done.stderr, "the checker checks nothing"


def test_sigterm_ends_the_units_command_with_0_and_everything_written(
    camera: str, folder: Path
) -> None:
    state, vehicle = folder / "state", folder / "chromadock" / "vehicle.toml"
    vehicle.write_text(
        f'[camera]\nsource = "{camera}"\n[outputs]\nresults = ["json:log.jsonl"]\n'
        'record = "dive.mcap"\noverlay = "seen.mp4"\n'
    )
    checked = subprocess.run(command("ExecStartPre", folder), cwd=state, capture_output=True)
    assert checked.returncode == 0
    log = state / "log.jsonl"
    with subprocess.Popen(
        command("ExecStart", folder),
        cwd=state, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
    ) as run:  # fmt: skip
        end = time.monotonic() + 40
        while not log.exists() or len(log.read_bytes().splitlines()) < 10:
            assert run.poll() is None and time.monotonic() < end
            time.sleep(0.1)
        run.send_signal(signal.SIGTERM)
        assert run.stderr is not None
        said = run.stderr.read()
        assert run.wait(10) == 0
    assert len(said.splitlines()) < 5, "the journal is spared"
    assert {path.name for path in state.iterdir()} == {"log.jsonl", "dive.mcap", "seen.mp4"}
    results = len(log.read_bytes().splitlines())
    bag = McapBag(state / "dive.mcap")
    assert bag.cut_short is None and abs(len(list(bag.messages(RECORD))) - results) <= 1
    with av.open(str(state / "seen.mp4")) as video:
        assert abs(sum(1 for _ in video.decode(video=0)) - results) <= 1


def test_a_file_with_a_slip_in_it_is_told_before_the_camera_is_opened(folder: Path) -> None:
    (folder / "chromadock" / "vehicle.toml").write_text("[camera]\nsorce = 0\n")
    checked = subprocess.run(command("ExecStartPre", folder), capture_output=True, text=True)
    assert checked.returncode == 2 and checked.stderr.count("\n") == 1
    assert "sorce" in checked.stderr


def test_a_stop_while_the_camera_is_opened_is_no_failure() -> None:
    assert read_unit(UNIT)["Service"]["SuccessExitStatus"] == str(EXIT_TERMINATED)
