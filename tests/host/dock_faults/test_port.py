"""Faults of the port, and of what is at its other end."""

import errno
import os
import time

import pytest
import serial
from peer_scripts import answering, version
from simulation import heartbeat, packed, peer, running_dock

from chromadock import dialect, method
from chromadock.link import Connection, connection, discovery


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
