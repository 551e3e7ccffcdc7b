"""Faults that only the simulated dock can be made to have."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from rig import DARK, Message, Rig, parameter_read

from chromadock import dialect
from chromadock.errors import ChromadockError
from chromadock.link.values import TABLE

pytestmark = pytest.mark.simulator
Simulate = Callable[..., Rig]
SAVE = (dialect.MAV_CMD_PREFLIGHT_STORAGE, 1)


def is_back(message: Message) -> bool:
    return bool(
        message.get_type() == "DOCK_STATUS"
        and message.camera_faults == 1
        and not message.faults & dialect.DOCK_FAULT_CAMERA
    )


def test_a_camera_fault_is_told_and_the_colour_kept_until_it_is_back(simulate: Simulate) -> None:
    rig = simulate("--fault", "camera-timeout@1.5s")
    shown = list(rig.status(lambda s: s.frames > 0).duty)
    assert shown != DARK
    rig.dock.set_parameter("REPORT_HZ", 30)  # the fault lasts from one grab to the next
    heard = rig.heard_until(is_back, timeout_s=8)
    statuses = [m for m in heard if m.get_type() == "DOCK_STATUS"]
    bad = [m for m in statuses if m.faults & dialect.DOCK_FAULT_CAMERA]
    assert bad, "it never said so"
    assert all(list(m.duty) == shown for m in statuses)
    assert {m.camera_faults for m in bad} == {1}
    assert statuses[-1].frames > bad[-1].frames
    assert "colour kept" in rig.text("camera gives no frame")
    rig.text("camera is back")


def test_a_camera_that_never_comes_leaves_the_leds_dark_and_the_link_alive(
    simulate: Simulate,
) -> None:
    rig = simulate("--fault", "camera-lost")
    status = rig.status(lambda s: s.faults & dialect.DOCK_FAULT_CAMERA)
    assert status.frames == 0
    assert list(status.duty) == DARK
    assert rig.wait("HEARTBEAT").system_status == dialect.MAV_STATE_CRITICAL
    assert rig.dock.set_parameter("WINDOW_MS", 500) == 500
    rig.dock.led_hue(0)
    assert list(rig.dock.status().duty) != DARK


def test_a_camera_that_never_comes_leaves_the_fallback_after_15_seconds(
    simulate: Simulate,
) -> None:
    rig = simulate("--fault", "camera-lost")
    status = rig.status(lambda s: list(s.duty) != DARK, timeout_s=25)
    assert 14_000 < status.time_boot_ms < 21_000
    assert (status.marker_hue, status.frame_rate_dhz, status.confidence) == (512, 0, 0)


def test_at_night_it_does_not_follow_its_own_light(simulate: Simulate, tmp_path: Path) -> None:
    night = tmp_path / "night.png"
    cv2.imwrite(str(night), np.zeros((120, 160, 3), np.uint8))
    rig = simulate(str(night), "--own-light", "0.05")
    rig.status(lambda s: s.faults == dialect.DOCK_FAULT_OWN_LIGHT, timeout_s=20)
    heard = rig.heard_until(
        lambda m: m.get_type() == "DOCK_STATUS" and m.time_boot_ms > 15_000, timeout_s=20
    )
    shown = {m.marker_hue for m in heard if m.get_type() == "DOCK_STATUS" and m.frames > 0}
    assert shown == {512}


def flip(blob: bytes) -> bytes:
    return blob[:20] + bytes([blob[20] ^ 1]) + blob[21:]


@pytest.mark.parametrize(
    "spoil",
    [flip, lambda blob: blob[:-1], lambda blob: b"", lambda blob: b"\xff" * len(blob)],
    ids=["one bit", "too short", "empty", "erased flash"],
)
def test_corrupt_storage_gives_defaults_and_says_so_until_saved_anew(
    simulate: Simulate, tmp_path: Path, spoil: Callable[[bytes], bytes]
) -> None:
    file = tmp_path / "settings.bin"
    rig = simulate("--settings", file)
    rig.dock.set_parameter("WINDOW_MS", 777)
    rig.dock.save()
    file.write_bytes(spoil(file.read_bytes()))
    rig.reset()
    rig.text("stored settings corrupt: defaults in use")
    assert rig.dock.parameter("WINDOW_MS") == TABLE["WINDOW_MS"].default
    assert rig.dock.status().faults & dialect.DOCK_FAULT_SETTINGS
    rig.alive()
    rig.dock.save()
    assert not rig.dock.status().faults & dialect.DOCK_FAULT_SETTINGS
    rig.reset()
    rig.alive()
    assert not rig.dock.status().faults & dialect.DOCK_FAULT_SETTINGS


def test_settings_that_cannot_be_saved_are_a_fault(simulate: Simulate) -> None:
    rig = simulate("--fault", "storage")
    rig.dock.set_parameter("WINDOW_MS", 888)
    with pytest.raises(ChromadockError, match="saving the parameters"):
        rig.dock.save()
    assert rig.command(*SAVE) == dialect.MAV_RESULT_FAILED
    rig.text("settings could not be saved")
    assert rig.dock.status().faults & dialect.DOCK_FAULT_STORAGE
    assert rig.dock.parameter("WINDOW_MS") == 888


def test_driver_text_inside_messages_costs_only_those(simulate: Simulate) -> None:
    rig = simulate("--fault", "driver-text")
    assert len(rig.dock.parameters()) == len(TABLE)
    rig.status(lambda s: s.time_boot_ms > 3000)
    heard = rig.raw.count(b"cam_hal: EV-EOF-OVF\r\n")
    assert heard >= 4
    assert rig.messenger.finder.skipped >= heard * len(b"cam_hal: EV-EOF-OVF\r\n")
    assert rig.messenger.heartbeats >= 1


def test_noise_and_boot_text_are_survived(simulate: Simulate) -> None:
    rig = simulate("--fault", "noise@3s", "--fault", "boot-text@3.3s", "--fault", "noise@3.5s")
    rig.status(lambda s: s.time_boot_ms > 4000)
    assert b"rst:0x1 (POWERON_RESET)" in rig.raw
    assert rig.messenger.finder.skipped >= 512
    rig.send(parameter_read("MAPPING"))
    rig.wait("PARAM_VALUE")


def test_a_power_failure_is_told_from_a_restart(simulate: Simulate) -> None:
    rig = simulate("--fault", "reboot@3s")
    rig.status(lambda s: s.time_boot_ms > 800)
    rig.forget()
    rig.text("reset reason 1")
    assert b"rst:0x1 (POWERON_RESET),boot:0x13" in rig.raw
    rig.alive()


def test_a_damaged_line_still_answers(simulate: Simulate) -> None:
    rig = simulate("--fault", "corrupt=0.01")
    assert len(rig.dock.parameters()) == len(TABLE)
    assert rig.dock.set_parameter("WINDOW_MS", 999) == 999
    status = rig.status(lambda s: s.time_boot_ms > 2000)
    assert not status.faults & dialect.DOCK_FAULT_CAMERA
