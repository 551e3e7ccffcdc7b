"""Programs that were not written here, against the simulated dock."""

from __future__ import annotations

import json
import os
import re
import struct
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from mavproxy import MavProxy
from patience import PATIENCE_S
from pymavlink import mavutil
from simulator import Simulator

from chromadock.link.values import step
from chromadock.parameter_table import PARAMETERS

ROOT = Path(__file__).resolve().parents[2]
MAVSDK = ROOT / "build" / "mavsdk"
CLIENT = ROOT / "tests" / "mavsdk_parameters.py"
WHOLE = [p.name for p in PARAMETERS if step(p) == 1.0]
"""Parameters whose every value is a whole number."""


@pytest.fixture
def tcp_dock(tmp_path: Path) -> Iterator[str]:
    simulator = Simulator(tmp_path / "simulator.log", ["--tcp", "localhost:0"])
    yield simulator.url.replace("socket://", "tcp:")
    simulator.stop()


@pytest.fixture
def pty_dock(tmp_path: Path) -> Iterator[str]:
    simulator = Simulator(tmp_path / "simulator.log")
    yield simulator.url
    simulator.stop()


@pytest.fixture(params=["tcp", "pty"])
def ground_station(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch):
    """pymavlink with the common dialect alone: it knows nothing of ours."""
    monkeypatch.setenv("MAVLINK20", "1")
    device = request.getfixturevalue(f"{request.param}_dock")
    link = mavutil.mavlink_connection(device, baud=921600, dialect="common")
    assert link.wait_heartbeat(timeout=PATIENCE_S) is not None
    yield link
    link.close()


def answer_about(link, name: str):
    """The next answer about one parameter."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        answer = link.recv_match(type="PARAM_VALUE", blocking=True, timeout=1)
        if answer is not None and answer.param_id == name:
            return answer
    raise AssertionError(f"no answer about {name}")


def value_of(link, name: str) -> float:
    """The next answer about one parameter, as mavutil shows every one: a float."""
    return float(answer_about(link, name).param_value)


def test_mavutil_fetches_and_sets_every_parameter(ground_station) -> None:
    link = ground_station
    assert link.target_system == 50
    link.param_fetch_all()
    fetched: dict[str, float] = {}
    end = time.monotonic() + PATIENCE_S
    while len(fetched) < len(PARAMETERS) and time.monotonic() < end:
        answer = link.recv_match(type="PARAM_VALUE", blocking=True, timeout=1)
        if answer is not None:
            assert answer.param_count == len(PARAMETERS)
            fetched[answer.param_id] = answer.param_value
    assert fetched == {p.name: pytest.approx(p.default, abs=1e-4) for p in PARAMETERS}
    for p in PARAMETERS:
        for value in (p.minimum, p.maximum):
            link.param_set_send(p.name, value)
            assert value_of(link, p.name) == pytest.approx(value, abs=1e-4)
    for p in PARAMETERS:
        link.param_fetch_one(p.name)
        assert value_of(link, p.name) == pytest.approx(p.maximum, abs=1e-4)


def test_mavutil_is_told_the_range_of_a_value_refused(ground_station) -> None:
    link = ground_station
    link.param_set_send("REPORT_HZ", 31)
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        text = link.recv_match(type="STATUSTEXT", blocking=True, timeout=1)
        if text is not None and "REPORT_HZ" in text.text:
            break
    assert text.text == "REPORT_HZ refused: allowed 0 to 30"
    assert text.severity == mavutil.mavlink.MAV_SEVERITY_WARNING


@pytest.mark.parametrize("kind", [mavutil.mavlink.MAV_PARAM_TYPE_INT32])
def test_mavutil_sets_whole_numbers_by_their_bytes(ground_station, kind: int) -> None:
    """The answer to such a set is such bytes; what is read afterwards is a float."""
    link = ground_station
    for p in PARAMETERS:
        for value in (p.minimum, p.maximum):
            if p.name not in WHOLE:
                continue
            (number,) = struct.unpack("<f", struct.pack("<i", int(value)))
            link.param_set_send(p.name, number, kind)
            answer = answer_about(link, p.name)
            assert answer.param_type == kind
            assert struct.unpack("<i", struct.pack("<f", answer.param_value)) == (value,)
            link.param_fetch_one(p.name)
            assert value_of(link, p.name) == value


@pytest.mark.parametrize(
    ("protocol", "calls"), [("default", "typed"), ("default", "floats"), ("ext", "typed")]
)
def test_mavsdk_sets_and_reads_every_parameter(tcp_dock: str, protocol: str, calls: str) -> None:
    """Whole numbers by its calls for integers and the rest by those for floats, or all by these."""
    if not MAVSDK.is_dir():
        pytest.skip("mavsdk: not in build/mavsdk: run make setup")
    wanted = [[p.name, p.minimum, p.maximum, p.name in WHOLE] for p in PARAMETERS]
    done = subprocess.run(
        [sys.executable, CLIENT, tcp_dock.split(":")[2], protocol, calls],
        env={**os.environ, "PYTHONPATH": str(MAVSDK)},
        input=json.dumps(wanted) + "\n",
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
    )
    assert done.returncode == 0, done.stderr
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("[{")]
    first, read, last = json.loads(line)
    if calls == "typed":  # before it set anything
        assert first == {p.name: pytest.approx(p.default, abs=1e-4) for p in PARAMETERS}
    assert read == {
        p.name: [pytest.approx(p.minimum, abs=1e-4), pytest.approx(p.maximum, abs=1e-4)]
        for p in PARAMETERS
    }
    integers, floats = last
    assert sorted(integers + floats) == sorted(p.name for p in PARAMETERS)
    assert sorted(integers) == (sorted(WHOLE) if calls == "typed" else [])


@pytest.fixture
def mavproxy(tcp_dock: str, tmp_path: Path) -> Iterator[MavProxy]:
    folder = tmp_path / "mavproxy"
    folder.mkdir()
    console = MavProxy(tcp_dock, folder)
    yield console
    console.close()


def test_mavproxy_lists_parameters_sets_one_and_shows_status_text(mavproxy: MavProxy) -> None:
    mavproxy.expect(rf"Received {len(PARAMETERS)} parameters")
    mavproxy.type("param show *")
    last = max(p.name for p in PARAMETERS)
    mavproxy.expect(rf"{last}\s+[\d.]+\s")
    listed = dict(re.findall(r"^(?:.*> )?([A-Z_]+)\s+(-?[\d.]+)\s*$", mavproxy.said, re.MULTILINE))
    listed = {name: float(value) for name, value in listed.items()}
    assert listed == {p.name: pytest.approx(p.default, abs=1e-4) for p in PARAMETERS}

    mavproxy.type("param set WINDOW_MS 1500")
    for _ in range(20):  # it sends when it finds the time
        mavproxy.type("param fetch WINDOW_MS")
        if float(mavproxy.expect(r"WINDOW_MS = ([\d.]+)\n")[1]) == 1500:
            break
    else:
        pytest.fail("WINDOW_MS was not set")

    for p in PARAMETERS:
        if p.name in ("REPORT_HZ", "LINK_BAUD"):  # the first is refused below
            continue
        mavproxy.type(f"param set {p.name} {p.maximum:g}")
        shown = rf"{p.name} = (-?[\d.]+)\n"
        for _ in range(20):
            mavproxy.type(f"param fetch {p.name}")
            if float(mavproxy.expect(shown)[1]) == pytest.approx(p.maximum, abs=1e-3):
                break
        else:
            pytest.fail(f"{p.name} was not set")

    mavproxy.type("param set REPORT_HZ 31")
    mavproxy.expect(r"REPORT_HZ refused: allowed 0 to 30")
    mavproxy.expect(r"Failed to set REPORT_HZ to 31")
