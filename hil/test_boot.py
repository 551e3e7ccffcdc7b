"""From reset to the first colour."""

from __future__ import annotations

import subprocess

import pytest
from rig import BOOT_LINE, DARK, Rig
from targets import ROOT

from chromadock import dialect, method


def test_the_boot_line_names_the_reset_and_the_flash_pins_are_right(rig: Rig) -> None:
    line = rig.reset()
    assert line[2].decode() == rig.target.reset_cause
    straps = int(line[3], 16)
    assert straps & 0x20 == 0, "GPIO12 was high at reset: 1.8 V for the flash"
    assert straps == 0x13
    assert line[4] == b"SPI_FAST_FLASH_BOOT"
    rig.alive()


def test_pytest_embedded_reads_the_boot_line(rig: Rig, dut) -> None:
    rig.reset()
    found = dut.expect(BOOT_LINE.pattern, timeout=5, not_matching=["Brownout", "Guru"])
    assert found[2].decode() == rig.target.reset_cause
    rig.alive()


def test_the_dock_says_why_it_started(rig: Rig) -> None:
    rig.reset()
    rig.alive()
    reason = rig.target.reset_reason
    assert rig.dock.status().reset_reason == reason
    assert f"reset reason {reason}" in rig.text("Chromadock")


def test_a_restart_by_command_is_told_from_a_power_on(rig: Rig) -> None:
    line = rig.reboot()
    assert line[2].startswith(b"SW_")
    rig.alive()
    assert rig.dock.status().reset_reason == 3


def test_heartbeat_and_first_colour_come_in_time(rig: Rig, record_property) -> None:
    rig.reset()
    beat = rig.wait("HEARTBEAT", timeout_s=rig.target.boot_s)
    assert (beat.type, beat.mavlink_version) == (dialect.MAV_TYPE_GENERIC, 3)
    status = rig.status(lambda s: s.frames > 0, rig.target.boot_s)
    assert list(status.duty) != DARK
    figure = f"reset to first colour on the {rig.target.name}: {status.time_boot_ms} ms"
    record_property("figure", figure)
    assert status.time_boot_ms < 1000 * rig.target.boot_s


def test_leds_are_dark_until_the_first_decision(rig: Rig) -> None:
    rig.reset()
    heard = rig.heard_until(
        lambda m: m.get_type() == "DOCK_STATUS" and m.frames > 0, rig.target.boot_s
    )
    early = [m for m in heard if m.get_type() == "DOCK_STATUS" and m.frames == 0]
    assert all(list(status.duty) == DARK for status in early)
    assert list(heard[-1].duty) != DARK


def test_the_version_has_commit_and_method(rig: Rig, request: pytest.FixtureRequest) -> None:
    version = rig.dock.version
    assert version.method_digest == method.DIGEST
    assert len(version.git_hash) == 8
    if request.config.getoption("flash"):
        head = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True
        )
        assert head.stdout.startswith(version.git_hash)


def test_five_restarts_in_a_row(rig: Rig) -> None:
    for _ in range(5):
        line = rig.reboot()
        assert line[2].startswith(b"SW_")
        rig.alive()
        assert rig.dock.status().time_boot_ms < 1000 * rig.target.boot_s


def test_camera_settings_lock_after_the_start(rig: Rig) -> None:
    rig.reset()
    unlocked = dialect.DOCK_FAULT_UNLOCKED
    rig.status(lambda s: not s.faults & unlocked, rig.target.settle_s)


@pytest.mark.board
def test_the_reset_line_restarts_the_clock(rig: Rig) -> None:
    rig.status(lambda s: s.time_boot_ms > 2000)
    rig.reset()
    rig.alive()
    assert rig.dock.status().time_boot_ms < 1000 * rig.target.boot_s


@pytest.mark.board
def test_ten_seconds_without_a_reset_by_the_watchdog(rig: Rig) -> None:
    rig.reset()
    rig.alive()
    rig.status(lambda s: s.time_boot_ms > 10000, 15)
    rig.healthy()
