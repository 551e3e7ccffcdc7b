"""What goes wrong between a user and a dock: one line with the mend, within 3 s."""

import errno
import os
import subprocess
import sys
import time

import cv2
import numpy as np
import pytest
import serial
from simulation import chromadock, heartbeat, packed, peer, running_dock

from chromadock import dialect, method
from chromadock.cli import dock_flash
from chromadock.errors import ChromadockError
from chromadock.link import Connection, DockClient, connection, discovery
from chromadock.link.commands import command_long
from chromadock.link.framing import FrameFinder
from chromadock.parameter_table import PARAMETERS
from chromadock.simulated import parse_fault

WITHIN_S = 3.0


@pytest.fixture
def refused(capsys):
    """Runs a command that must fail in one line that says all of ``says``.

    With ``soon`` it waits less for answers than a user would.
    """

    def run(*arguments, says, port=None, soon=False):
        arguments = [*arguments, *(["--timeout", 0.5] if soon else [])]
        start = time.monotonic()
        done = chromadock(capsys, "dock", *arguments, *(["--port", port] if port else []))
        assert time.monotonic() - start < WITHIN_S
        assert done.status == 2, done.out
        lines = done.err.splitlines()
        assert len(lines) == 1, done.err
        assert lines[0].startswith("chromadock: error: ")
        for words in [says] if isinstance(says, str) else says:
            assert words in lines[0], lines[0]
        return lines[0]

    return run


@pytest.fixture(scope="module")
def url():
    with running_dock() as (url, _dock):
        yield url


def version(digest=method.DIGEST):
    return dialect.MAVLink_autopilot_version_message(
        0, 0, 0, 0, 0, [*b"abcdef12"], [*reversed(bytes.fromhex(digest))], [0] * 8, 0, 0, 0
    )


def answering(answers):
    """A peer's script: for each message of the host, what ``answers`` returns."""

    def script(client):
        finder = FrameFinder()
        while data := client.recv(4096):
            for message in finder.feed(data):
                client.sendall(answers(message))

    return script


# The port


def test_no_such_port(refused):
    refused("info", port="/dev/ttyUSB77", says=["/dev/ttyUSB77: no such port", "leave out --port"])


def test_a_file_is_no_port(refused, tmp_path):
    file = tmp_path / "notes.txt"
    file.write_text("notes")
    refused("info", port=str(file), says=["notes.txt", "serial port", "/dev/ttyUSB0"])


@pytest.mark.parametrize("port", ["foo://bar", "socket://nonsense", "socket://host:port"])
def test_a_url_that_pyserial_does_not_know(refused, port):
    refused("info", port=port, says=[port, "socket://localhost:5760"])


def test_a_tcp_port_where_nobody_listens(refused):
    refused("info", port="socket://127.0.0.1:1", says="nothing listens there")


def test_a_port_in_use(refused, url):
    with Connection(url):
        refused("info", port=url, says=["in use by another program", f"fuser {url}"])


@pytest.mark.parametrize("number", [errno.EACCES, errno.EPERM])
def test_a_port_without_permission(refused, monkeypatch, number):
    def deny(_url, **_options):
        raise serial.SerialException(number, "could not open port")

    monkeypatch.setattr(serial, "serial_for_url", deny)
    refused("info", port="/dev/ttyUSB0", says=["permission denied", "dialout"])


def test_an_address_that_swallows_everything(refused, monkeypatch):
    monkeypatch.setattr(connection, "_open", lambda _url, _baud: time.sleep(60))
    refused("info", port="socket://192.0.2.1:5760", says=["does not open", "check the address"])


def test_dtr_and_rts_are_released_before_the_port_opens(monkeypatch):
    states = []

    class Spy(serial.Serial):
        def open(self):
            states.append((self.dtr, self.rts, self.exclusive))

    monkeypatch.setattr(serial, "Serial", Spy)
    Connection("/dev/ttyUSB0")
    assert states == [(False, False, True)]


def test_a_log_that_cannot_be_written(refused, url, tmp_path):
    log = tmp_path / "missing" / "raw.log"
    refused("info", "--log", log, port=url, says=["raw.log", "cannot be written"])


@pytest.mark.parametrize("timeout", [0, -1, "nan", "1e9"])
def test_an_impossible_timeout(refused, url, timeout):
    refused("info", "--timeout", timeout, port=url, says="--timeout")


def test_an_impossible_speed(refused, url):
    refused("info", "--baud", -5, port=url, says=["--baud", "LINK_BAUD"])


# What is at its other end


def test_a_silent_port(refused):
    other, silent = os.openpty()
    refused("info", port=os.ttyname(silent), says=["silent for 2 s", "power and cable"])
    os.close(other)
    os.close(silent)


def test_other_firmware(refused):
    def chatter(client):
        while True:
            client.sendall(b"Camera Ready! Use 'http://192.168.1.5' to connect\r\n")
            time.sleep(0.1)

    with peer(chatter) as port:
        refused("info", port=port, soon=True, says=["other firmware", "dock flash"])


def test_an_autopilot_instead_of_a_dock(refused):
    def autopilot(client):
        while True:
            client.sendall(packed(heartbeat(), system=1))
            time.sleep(0.2)

    with peer(autopilot) as port:
        refused("watch", port=port, soon=True, says=["MAVLink system 1", "no dock"])


def test_a_dock_that_tells_no_version(refused):
    with peer(answering(lambda _message: packed(heartbeat()))) as port:
        refused("info", port=port, soon=True, says=["no version", "dock flash"])


def test_a_dock_with_another_method(refused):
    other = "0123456789abcdef"
    with peer(answering(lambda _message: packed(version(other)))) as port:
        refused("info", port=port, says=[other, method.DIGEST, "dock flash"])


def of_another_dialect(client):
    """Statuses have another checksum, as they have when their fields change; the rest is the
    same."""
    status = dialect.MAVLink_dock_status_message(*[1] * 10, [0] * 3, *[1] * 3, [0] * 3, *[1] * 3)
    damaged = bytearray(packed(status))
    damaged[-1] ^= 0x55
    while True:
        client.sendall(packed(version(), heartbeat()) + damaged)
        time.sleep(0.05)


@pytest.mark.parametrize("command", ["info", "watch"])
def test_a_dock_of_another_dialect(refused, command):
    with peer(of_another_dialect) as port:
        refused(command, port=port, soon=True, says=["another layout", "dock flash"])


def test_no_port_at_all(refused, monkeypatch):
    monkeypatch.setattr(discovery, "candidates", list)
    refused("info", says=["no USB serial port", "--port"])


def test_several_docks(refused, monkeypatch, url):
    with running_dock(tcp=True) as (other, _dock):
        monkeypatch.setattr(discovery, "candidates", lambda: [url, other])
        refused("info", says=["several docks", url, other, "--port"])


def test_several_ports_but_no_dock(refused, monkeypatch):
    monkeypatch.setattr(discovery, "candidates", lambda: ["/dev/ttyUSB77", "/dev/ttyUSB78"])
    refused("info", says=["no dock answers", "/dev/ttyUSB77: no such port", "/dev/ttyUSB78"])


# While it is at work


@pytest.mark.parametrize(
    "command", [("info",), ("watch",), ("params", "list"), ("led", "auto"), ("reboot",)]
)
def test_unplugged_in_the_middle_of_a_command(refused, command):
    def script(client):
        client.recv(4096)
        client.sendall(packed(version()))
        client.recv(4096)

    with peer(script) as port:
        refused(*command, port=port, says=["went away", "cable"])


@pytest.mark.parametrize(
    ("command", "says"),
    [
        (("info",), "DOCK_STATUS"),
        (("watch",), "fell silent"),
        (("params", "list"), "its parameters"),
        (("params", "get", "MAPPING"), "MAPPING"),
        (("params", "set", "MAPPING", "ternary"), "setting MAPPING"),
        (("params", "save"), "saving"),
        (("led", "10"), "led 10"),
        (("snapshot", "out.png"), "snapshot"),
        (("inject", "water.png"), "an injected frame"),
        (("reboot",), "DOCK_STATUS"),
    ],
)
def test_a_dock_that_falls_silent(refused, command, says, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    cv2.imwrite("water.png", np.full((120, 160, 3), (200, 160, 40), np.uint8))

    def script(client):
        client.recv(4096)
        client.sendall(packed(version()))
        while client.recv(4096):
            pass

    with peer(script) as port:
        refused(*command, port=port, soon=True, says=[port, says])
    assert [p.name for p in tmp_path.iterdir()] == ["water.png"]


def test_a_dock_that_falls_silent_is_given_up_within_three_seconds(refused):
    def script(client):
        client.recv(4096)
        client.sendall(packed(version()))
        while client.recv(4096):
            pass

    with peer(script) as port:
        refused("watch", port=port, says=["fell silent 2 s ago"])


def test_a_snapshot_without_a_camera(refused, tmp_path):
    with running_dock(faults=(parse_fault("camera-lost"),)) as (url, _dock):
        refused("snapshot", tmp_path / "out.png", port=url, soon=True, says="camera gives no frame")


def test_a_pseudo_terminal_whose_dock_was_killed():
    command = [sys.executable, "-m", "chromadock", "dock", "simulate"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        port = process.stdout.readline().removeprefix("port: ").strip()
        client = DockClient(Connection(port))
        process.kill()
        process.wait()
        with pytest.raises(ChromadockError, match=r"went away .*: check the cable"):
            for _ in range(100):
                client.status()
        client.close()


@pytest.mark.parametrize(
    ("result", "says"),
    [
        (dialect.MAV_RESULT_TEMPORARILY_REJECTED, "busy"),
        (dialect.MAV_RESULT_DENIED, "refuses"),
        (dialect.MAV_RESULT_UNSUPPORTED, "does not know"),
        (dialect.MAV_RESULT_FAILED, "could not"),
        (77, "result 77"),
    ],
)
def test_a_command_that_the_dock_refuses(refused, result, says):
    def answers(message):
        if message.get_type() != "COMMAND_LONG":
            return b""
        if message.command == dialect.MAV_CMD_REQUEST_MESSAGE:
            return packed(version())
        return packed(dialect.MAVLink_command_ack_message(message.command, result))

    with peer(answering(answers)) as port:
        refused("params", "save", port=port, says=["saving the parameters", says])


def test_a_parameter_that_the_dock_refuses(refused):
    def answers(message):
        if message.get_type() == "COMMAND_LONG":
            return packed(version())
        if message.get_type() != "PARAM_SET":
            return b""
        return packed(
            dialect.MAVLink_statustext_message(4, b"LED_LIMIT refused: allowed 0 to 200"),
            dialect.MAVLink_param_value_message(b"LED_LIMIT", 200.0, 9, 26, 18),
        )

    refusal = pytest.raises(ChromadockError, match=r"LED_LIMIT stays 200.*allowed 0 to 200")
    with peer(answering(answers)) as port, DockClient(Connection(port)) as client, refusal:
        client.set_parameter("LED_LIMIT", 255)


def test_answers_are_found_on_a_line_that_damages_bytes():
    faults = (parse_fault("corrupt=0.001"), parse_fault("driver-text"))
    with running_dock(faults=faults) as (url, _dock), DockClient(Connection(url)) as client:
        assert client.parameters() == pytest.approx({p.name: p.default for p in PARAMETERS})
        for name in ("LED_LIMIT", "WINDOW_MS", "CAM_EXPOSURE"):
            assert client.set_parameter(name, 200) == 200


def test_messages_for_others_and_from_others_change_nothing(url):
    with DockClient(Connection(url)) as client:
        other = command_long(dialect.MAV_CMD_DOCK_LED, dialect.DOCK_LED_RAW, 1, 2, 3)
        other.target_system = 99
        client.messenger.send(other)
        assert client.status().led_mode == dialect.DOCK_LED_AUTO
        stranger = dialect.MAVLink(None, 50, 1)  # another dock
        mine = command_long(dialect.MAV_CMD_DOCK_LED, dialect.DOCK_LED_RAW, 1, 2, 3)
        client.connection.write(mine.pack(stranger))
        assert client.status().led_mode == dialect.DOCK_LED_AUTO


# What the user typed


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
