"""The doctor says in a line each what is well, what is not, and what to do."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from autopilot_peer import free_port, udp_peer
from pymavlink.dialects.v20 import common as mavlink
from simulator import Simulator

from chromadock import CameraModel
from chromadock.doctor import camera as eyes
from chromadock.doctor import computer
from chromadock.doctor.autopilot import heartbeats
from chromadock.doctor.finding import Finding
from chromadock.doctor.ports import dock
from chromadock.sources.grabber import Grabber, Shot
from chromadock.sources.live import Live


class Camera(Grabber):
    """Thirty pictures a second of VGA, said to be sixty."""

    fps = 60.0
    monotonic = True

    def grab(self) -> Shot | None:
        time.sleep(1 / 30)
        return Shot(np.zeros((480, 640, 3), np.uint8), time.monotonic() - 0.4)

    def close(self) -> None:
        """Nothing is open."""


def by_subject(findings: list[Finding]) -> dict[str, Finding]:
    return {finding.subject: finding for finding in findings}


def test_a_camera_is_held_to_its_calibration_and_its_rate(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(eyes, "LOOK_S", 0.5)
    monkeypatch.setattr(eyes, "open_source", lambda _: Live(Camera, "camera 97"))
    found = by_subject(list(eyes.camera("97", CameraModel.nominal(1280, 720))))
    assert found["camera"].level == "fault"
    assert "640x480 but calibrated for 1280x720" in found["camera"].words
    assert found["rate"].level == "warning" and "of 60 that are announced" in found["rate"].words
    assert found["delay"].level == "warning" and "a picture is 4" in found["delay"].words
    assert found["camera controls"].level == "warning"
    assert "/dev/video97: its controls cannot be reached" in found["camera controls"].words


def test_a_source_that_does_not_open_is_a_fault_in_its_own_words() -> None:
    [found] = eyes.camera("/dev/video97", None)
    assert found.level == "fault" and "/dev/video97" in found.words


def test_a_calibration_is_told_by_its_field_of_view() -> None:
    assert eyes.calibration(None).level == "warning"
    found = eyes.calibration(CameraModel.nominal(640, 480))
    assert found == Finding("ok", "calibration", "640x480, 64 degrees across, plumb_bob lens")
    wide = CameraModel(640, 480, [[230, 0, 320], [0, 230, 240], [0, 0, 1]], [], lens="equidistant")
    assert "159 degrees across, equidistant lens" in eyes.calibration(wide).words


def test_a_clock_of_the_past_is_told() -> None:
    found = computer.clock(0.0)
    assert found.level == "warning" and "1970-01-01" in found.words and "timedatectl" in found.words


def test_a_folder_that_is_not_there_has_no_room(tmp_path: Path) -> None:
    assert computer.disk(tmp_path / "none").level == "fault"
    assert computer.disk(tmp_path).level in ("ok", "warning")


def test_a_vehicle_that_is_heard_gets_its_output_proposed() -> None:
    port, silent = free_port(), free_port()
    taken = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    taken.bind(("", 0))
    busy = taken.getsockname()[1]
    peer, end = udp_peer(port, mavlink.MAV_TYPE_SUBMARINE)
    stop = threading.Event()

    def live() -> None:
        while not stop.is_set():
            peer.step()

    vehicle = threading.Thread(target=live)
    vehicle.start()
    with end, taken:
        found = list(heartbeats((port, busy, silent), 1.0))
        stop.set()
        vehicle.join()
    assert [f.level for f in found] == ["warning", "ok"]
    assert f"UDP port {busy} is taken" in found[0].words
    assert f"--out 'mavlink:udpin:0.0.0.0:{port}?receiver=ardusub'" in found[1].words


def test_nobody_on_the_line_is_told_with_the_mend() -> None:
    [found] = heartbeats((free_port(),), 0.2)
    assert found.level == "warning" and "make an endpoint" in found.words


def test_a_dock_is_asked_for_its_firmware(tmp_path: Path) -> None:
    simulator = Simulator(tmp_path / "log")
    try:
        found = dock(simulator.url, 5.0)
    finally:
        simulator.stop()
    assert found.level == "ok" and "the same colour method as here" in found.words
    gone = dock("socket://127.0.0.1:9", 0.5)
    assert gone.level == "fault" and "\n" not in gone.words


def test_the_command_prints_a_line_each_and_exits_by_the_worst() -> None:
    command = [sys.executable, "-m", "chromadock", "doctor", "--set", "camera.source=none.png"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1 and not done.stderr
    levels = [line.split()[0] for line in done.stdout.splitlines()]
    assert len(levels) > 6 and {"ok", "fault"} <= set(levels) <= {"ok", "warning", "fault"}
    assert "fault    camera: none.png: no such file" in done.stdout
