"""What an autopilot is told, read by programs that were not written here."""

from __future__ import annotations

import json
import os
import select
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from autopilot_peer import Peer, free_port, waiting
from autopilot_truth import AHEAD, detection, pose_at, tracked
from mavproxy import MavProxy
from patience import PATIENCE_S
from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mavlink
from step import missing

from chromadock.autopilot.output import AutopilotOutput
from chromadock.autopilot.settings import AutopilotSettings

ROOT = Path(__file__).resolve().parents[3]
MAVSDK = ROOT / "build" / "mavsdk"
BODY = (4.0, 0.5, 0.2)


@pytest.fixture
def port() -> int:
    return free_port()


def opened(port: int, options: str) -> AutopilotOutput:
    settings = AutopilotSettings.parse(f"mavlink:udpin:127.0.0.1:{port}?{options}")
    return AutopilotOutput(settings, AHEAD, lambda line: None)


def frame(out: AutopilotOutput) -> int:
    """One frame; its time in microseconds."""
    time_s = time.monotonic() - 0.03
    out.write(time_s, detection(tracked(time_s, pose_at(BODY))))
    return round(time_s * 1e6)


class Mavsdk:
    """The program ``mavsdk_autopilot.py``, and what it prints."""

    def __init__(self, port: int) -> None:
        script = ROOT / "tests" / "mavsdk_autopilot.py"
        self.process = subprocess.Popen(
            [sys.executable, "-u", str(script), str(port)],
            env={**os.environ, "PYTHONPATH": str(MAVSDK)},
            stdout=subprocess.PIPE,
            bufsize=0,
        )
        self._rest = b""
        self.messages: list[Any] = []

    def read(self) -> None:
        """All lines that wait; those of its own log are passed over."""
        assert self.process.stdout is not None
        while select.select([self.process.stdout], [], [], 0)[0]:
            data = self.process.stdout.read(65536)
            assert data, "it ended"
            *lines, self._rest = (self._rest + data).split(b"\n")
            self.messages += [json.loads(line) for line in lines if line.startswith(b'["')]

    def close(self) -> None:
        """End it."""
        self.process.kill()
        self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()


@pytest.fixture
def mavsdk(port: int) -> Iterator[Mavsdk]:
    if not MAVSDK.is_dir():
        pytest.skip(f"mavsdk: {missing('mavsdk') or 'not in build/mavsdk: run make setup'}")
    peer = Mavsdk(port)
    yield peer
    peer.close()


def heard(mavsdk: Mavsdk, out: AutopilotOutput, names: set[str]) -> tuple[dict[str, Any], set[int]]:
    """The newest message of each name, as MAVSDK decodes it, and the frames' times till then."""
    times, end = set[int](), time.monotonic() + PATIENCE_S
    while not mavsdk.messages:  # what is said once must not be said before it listens
        assert time.monotonic() < end
        mavsdk.read()
        time.sleep(0.05)
    while True:
        mavsdk.read()
        newest = {name: fields for name, *_, fields in mavsdk.messages}
        if names <= newest.keys():
            return newest, times
        assert time.monotonic() < end, newest.keys()
        times.add(frame(out))
        time.sleep(0.05)


def test_mavsdk_reads_what_a_rover_is_told_extensions_included(mavsdk: Mavsdk, port: int) -> None:
    with opened(port, "receiver=ardupilot-rover&vision=on") as out:
        wanted = {"HEARTBEAT", "LANDING_TARGET", "VISION_POSITION_ESTIMATE", "STATUSTEXT"}
        newest, times = heard(mavsdk, out, wanted)
    target, vision = newest["LANDING_TARGET"], newest["VISION_POSITION_ESTIMATE"]
    assert (target["x"], target["y"], target["z"]) == pytest.approx((-0.2, 0.5, 4.0), abs=1e-6)
    assert (target["distance"], target["frame"]) == (pytest.approx(4.0361, abs=1e-4), 12)
    assert (target["position_valid"], target["q"]) == (1, [1.0, 0.0, 0.0, 0.0])
    assert target["time_usec"] in times
    # By the attitude that MAVSDK itself has sent: to the east.
    assert (vision["x"], vision["y"], vision["z"]) == pytest.approx((0.5, -4.0, -0.2), abs=1e-5)
    assert vision["yaw"] == pytest.approx(1.5707963, abs=1e-5)
    assert len(vision["covariance"]) == 21 and vision["covariance"][0] > 0
    assert 0 <= vision["reset_counter"] <= 255
    assert newest["STATUSTEXT"]["text"] == "Chromadock: dock locked, 4.0 m"
    assert (newest["HEARTBEAT"]["type"], newest["HEARTBEAT"]["autopilot"]) == (18, 8)
    assert {tuple(m[1:3]) for m in mavsdk.messages} == {(7, 191)}


def test_mavsdk_reads_the_odometry_for_px4(mavsdk: Mavsdk, port: int) -> None:
    with opened(port, "receiver=px4") as out:
        newest, times = heard(mavsdk, out, {"ODOMETRY"})
    odometry = newest["ODOMETRY"]
    assert (odometry["x"], odometry["y"], odometry["z"]) == pytest.approx(
        (0.5, -4.0, -0.2), abs=1e-5
    )
    assert (odometry["frame_id"], odometry["child_frame_id"]) == (1, 12)
    assert odometry["time_usec"] in times and odometry["quality"] == 90
    # The dock's place on earth needs LOCAL_POSITION_NED, which is not sent here.
    assert "LANDING_TARGET" not in newest


def test_pymavlinks_own_connection_reads_it(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """``mavutil`` with the common dialect, as scripts on a vehicle use it."""
    monkeypatch.setenv("MAVLINK20", "1")
    vehicle = mavutil.mavlink_connection(
        f"udpout:127.0.0.1:{port}", source_system=7, source_component=1, dialect="common"
    )
    with opened(port, "receiver=ardupilot-copter") as out:
        target, end = None, time.monotonic() + PATIENCE_S
        while target is None and time.monotonic() < end:
            vehicle.mav.heartbeat_send(mavlink.MAV_TYPE_QUADROTOR, 3, 0, 0, 4)
            frame(out)
            target = vehicle.recv_match(type="LANDING_TARGET", blocking=True, timeout=0.1)
        vehicle.close()
    assert target is not None
    assert (target.x, target.y, target.z) == pytest.approx(BODY, abs=1e-6)
    assert (target.position_valid, target.get_srcComponent()) == (1, 191)


@pytest.fixture
def router(port: int, tmp_path: Path) -> Iterator[tuple[Peer, MavProxy]]:
    """An autopilot behind MAVProxy, which passes all it hears on to ``port`` and back."""
    folder = tmp_path / "mavproxy"
    folder.mkdir()
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(PATIENCE_S)
        master = f"tcp:127.0.0.1:{server.getsockname()[1]}"
        console = MavProxy(master, folder, f"--out=udpout:127.0.0.1:{port}", "--mav20")
        try:
            end, _ = server.accept()
            with end:
                yield (
                    Peer(lambda: waiting(end), end.sendall, mavlink.MAV_TYPE_SURFACE_BOAT),
                    console,
                )
        finally:
            console.close()


def test_mavproxy_passes_it_on_to_the_autopilot(router: tuple[Peer, MavProxy], port: int) -> None:
    peer, _console = router
    with opened(port, "receiver=ardupilot-rover&vision=on") as out:

        def arrived() -> bool:
            frame(out)
            kinds = {m.get_type() for m in peer.messages if m.get_srcComponent() == 191}
            return {"LANDING_TARGET", "VISION_POSITION_ESTIMATE", "STATUSTEXT"} <= kinds

        peer.until(arrived)
    target = peer.named("LANDING_TARGET")[-1]
    assert (target.get_srcSystem(), target.get_srcComponent()) == (7, 191)
    assert (target.x, target.y, target.z) == pytest.approx((-0.2, 0.5, 4.0), abs=1e-6)
    assert target.position_valid == 1
    assert peer.named("VISION_POSITION_ESTIMATE")[-1].covariance[0] > 0
