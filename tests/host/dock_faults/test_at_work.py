"""Faults while a command is at work."""

import subprocess
import sys

import cv2
import numpy as np
import pytest
from peer_scripts import answering, version
from simulation import packed, peer, running_dock

from chromadock import dialect
from chromadock.errors import ChromadockError
from chromadock.link import Connection, DockClient
from chromadock.link.commands import command_long
from chromadock.parameter_table import PARAMETERS
from chromadock.simulated import parse_fault


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
