"""What the hardware suite does around its tests, on the simulated dock."""

from __future__ import annotations

import fcntl
import signal
import subprocess
import sys
import time
from pathlib import Path

import hardware
from patience import PATIENCE_S
from simulator import Simulator

from chromadock import dialect
from chromadock.link.framing import FrameFinder

DARK = (dialect.DOCK_LED_RAW, 0, 0, 0)


def suite(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [
            *(sys.executable, "-m", "pytest", "-c", "hil/pytest.ini", "hil"),
            *(f"--root-logdir={folder}", "-p", "no:cacheprovider", *arguments),
        ],
        cwd=hardware.ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def messages_to_the_dock(log: Path) -> list:
    finder = FrameFinder()
    lines = [line.split(" ") for line in log.read_text().splitlines()]
    return [
        message
        for *_, direction, data in lines
        if direction == ">"
        for message in finder.feed(bytes.fromhex(data))
    ]


def leds_were_put_out_last(log: Path) -> bool:
    commands = [m for m in messages_to_the_dock(log) if m.get_type() == "COMMAND_LONG"]
    leds = [m for m in commands if m.command == dialect.MAV_CMD_DOCK_LED]
    return (leds[-1].param1, leds[-1].param2, leds[-1].param3, leds[-1].param4) == DARK


def wait_for_restarts(log: Path, process: subprocess.Popen[str]) -> None:
    """Into the middle of the test of five restarts."""
    end = time.monotonic() + PATIENCE_S
    boot_line = b"(SW_CPU_RESET)".hex()
    while not log.is_file() or log.read_text().count(boot_line) < 2:
        assert process.poll() is None and time.monotonic() < end
        time.sleep(0.02)


def test_a_session_that_ends_well_leaves_the_leds_dark(tmp_path: Path) -> None:
    process = suite(tmp_path, "-k", "one_channel")
    said, _ = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0, said
    assert "3 passed" in said
    assert leds_were_put_out_last(tmp_path / "simulator-wire.log")


def test_a_session_that_is_stopped_leaves_the_leds_dark(tmp_path: Path) -> None:
    process = suite(tmp_path, "-k", "five_restarts")
    log = tmp_path / "simulator-wire.log"
    wait_for_restarts(log, process)
    process.send_signal(signal.SIGTERM)
    said, _ = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 2, said
    assert leds_were_put_out_last(log)


def test_tests_for_a_board_alone_are_named_and_not_passed(tmp_path: Path) -> None:
    process = suite(tmp_path, "-k", "watchdog", "--collect-only", "-q")
    said, _ = process.communicate(timeout=PATIENCE_S)
    assert f"{hardware.LEFT_OUT}test_ten_seconds_without_a_reset_by_the_watchdog" in said
    assert process.returncode == 5, "pytest's status where nothing was run"


def test_a_port_in_use_is_one_clear_line(tmp_path: Path) -> None:
    simulator = Simulator(tmp_path / "simulator.log")
    try:
        with Path(simulator.url).open("rb", buffering=0) as other:
            fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
            process = suite(tmp_path, f"--port={simulator.url}", "-k", "heartbeats_come")
            said, _ = process.communicate(timeout=PATIENCE_S)
    finally:
        simulator.stop()
    assert process.returncode == 2, said
    assert f"{simulator.url}: in use by another program" in said
