"""The host's end of the link where the line loses messages, a dock takes its time, or there is
another one."""

from __future__ import annotations

import contextlib
import socket
import threading
import time

import pytest
import serial
import serial.rfc2217
from simulation import chromadock, running_dock, served

from chromadock import dialect
from chromadock.errors import ChromadockError
from chromadock.link import Connection, DockClient
from chromadock.link.framing import HEADER_BYTES, START
from chromadock.link.rgb565 import HEIGHT, WIDTH
from chromadock.simulated import SimulatedDock
from chromadock.simulated.camera import open_camera
from chromadock.simulated.loop import CLOCK

ACK, HANDSHAKE, PACKET = 77, 130, 131
SNAPSHOT = dialect.MAV_CMD_DOCK_SNAPSHOT


class Line(SimulatedDock):
    """A dock behind a line that damages the messages that ``hit`` chooses."""

    def __init__(self, hit):
        super().__init__(open_camera(None), fps=20.0, now_s=CLOCK(), save_s=0.0)
        self._hit = hit

    def transmit(self, now_s):
        data = bytearray(super().transmit(now_s))
        at = data.find(START)
        while at >= 0:
            end = at + HEADER_BYTES + data[at + 1]
            number = int.from_bytes(data[at + 7 : at + 10], "little")
            payload = bytes(data[at + HEADER_BYTES : end])
            if self._hit(number, payload):
                data[at + HEADER_BYTES] ^= 0xFF
            at = data.find(START, end + 2)
        return bytes(data)


def acknowledges_a_snapshot(number, payload):
    return number == ACK and payload[:2] == SNAPSHOT.to_bytes(2, "little")


def nth(wanted, *numbers):
    """Chooses those of these numbers, from 1, among the messages that ``wanted`` accepts."""
    count = 0

    def hit(number, payload):
        nonlocal count
        count += wanted(number, payload)
        return wanted(number, payload) and count in numbers

    return hit


def packets(number, payload):
    return number == PACKET


@contextlib.contextmanager
def client_of(dock, **options):
    with served(dock) as url, DockClient(Connection(url), **options) as client:
        yield client


def is_water(picture):
    data, width, height = picture
    return (width, height) == (WIDTH, HEIGHT) and data == data[:2] * (WIDTH * HEIGHT)


def test_a_lost_answer_does_not_fail_a_snapshot():
    with client_of(Line(nth(acknowledges_a_snapshot, 1, 3))) as client:
        for _ in range(2):
            assert is_water(client.snapshot())


def test_a_lost_announcement_does_not_fail_a_snapshot():
    hit = nth(lambda number, _: number == HANDSHAKE, 1)
    with client_of(Line(hit)) as client:
        assert is_water(client.snapshot())


def packets_sent_for_a_snapshot(hit):
    sent = 0

    def count(number, payload):
        nonlocal sent
        sent += number == PACKET
        return hit(number, payload)

    with client_of(Line(count)) as client:
        assert is_water(client.snapshot())
    return sent


def test_only_the_packets_that_were_lost_are_sent_again():
    """In each try one of the 152 was lost, and four tries were all there were."""
    assert packets_sent_for_a_snapshot(nth(packets, 1, 70, 71, 152)) == 152 + 4


def test_packets_that_are_lost_again_are_asked_for_again():
    lost = [10, 50, 51, 152, 153, 154, 155]
    assert packets_sent_for_a_snapshot(nth(packets, *lost)) < 152 + 12


def test_a_line_that_loses_one_packet_in_ten_still_gives_a_snapshot():
    assert packets_sent_for_a_snapshot(nth(packets, *range(5, 4000, 10))) < 152 + 30


class Older(Line):
    """Firmware that has no number for its pictures: what asks for packets is a new picture."""

    def __init__(self, hit):
        super().__init__(hit)
        self.asked = 0

    def receive(self, data, now_s):
        self.asked += data.count(SNAPSHOT.to_bytes(2, "little"))
        super().receive(data, now_s)

    def transmit(self, now_s):
        out = super().transmit(now_s)
        id_at = out.find(bytes([HANDSHAKE, 0, 0]))
        if id_at < 7 or out[id_at - 7] != START:
            return out
        at = id_at - 7
        end = at + HEADER_BYTES + out[at + 1]
        message = dialect.MAVLink(None).decode(bytearray(out[at : end + 2]))
        message.jpg_quality = 0
        sender = dialect.MAVLink(None, 50, 1)
        sender.seq = out[at + 4]
        return out[:at] + message.pack(sender) + out[end + 2 :]


def test_of_older_firmware_a_new_picture_is_taken():
    dock = Older(nth(packets, 7))
    with client_of(dock) as client:
        assert is_water(client.snapshot())
    assert dock.asked == 2


@pytest.mark.parametrize("save_s", [0.6, 4.0])
def test_a_save_that_takes_as_long_as_on_a_board_succeeds(save_s, capsys, tmp_path):
    file = tmp_path / "flash"
    with running_dock(settings=file, save_s=save_s) as (url, _dock):
        start = time.monotonic()
        done = chromadock(capsys, "dock", "params", "save", "--port", url)
        assert done.status == 0, done.err
        assert time.monotonic() - start > save_s
        assert file.exists()


def test_a_save_that_fails_after_a_while_is_said_to_fail(tmp_path):
    file = tmp_path / "missing" / "flash"
    fails = pytest.raises(ChromadockError, match="could not")
    with running_dock(settings=file, save_s=0.6) as (url, _dock):
        client = DockClient(Connection(url))
        with client, fails:
            client.save()


def test_a_save_whose_last_answer_is_lost_is_asked_for_again():
    def done(number, payload):
        store = dialect.MAV_CMD_PREFLIGHT_STORAGE.to_bytes(2, "little")
        return number == ACK and payload[:2] == store and payload[2:3] in (b"", b"\0")

    with client_of(Line(nth(done, 1))) as client:
        client.save()


def test_a_dock_is_restarted_twice_in_a_row():
    with running_dock() as (url, _dock), DockClient(Connection(url)) as client:
        for _ in range(3):
            client.reboot()


class Both:
    """Two docks on one line."""

    def __init__(self, *docks):
        self.docks = docks

    def next_due_s(self):
        return min(dock.next_due_s() for dock in self.docks)

    def step(self, now_s):
        for dock in self.docks:
            dock.step(now_s)

    def receive(self, data, now_s):
        for dock in self.docks:
            dock.receive(data, now_s)

    def transmit(self, now_s):
        return b"".join(dock.transmit(now_s) for dock in self.docks)


@pytest.fixture
def two(tmp_path):
    """The port of docks 50 and 51."""
    file = tmp_path / "flash51"
    with running_dock(settings=file) as (url, _dock), DockClient(Connection(url)) as client:
        assert client.set_parameter("SYSTEM_ID", 51) == 51
        assert client.name == "dock 50"  # from the next start on
        client.save()
    camera = open_camera(None)
    docks = [SimulatedDock(camera, settings=s, now_s=CLOCK()) for s in (None, file)]
    with served(Both(*docks)) as url:
        yield url


def test_a_dock_of_another_system_is_found(tmp_path, capsys):
    file = tmp_path / "flash"
    with running_dock(settings=file) as (url, _dock), DockClient(Connection(url)) as client:
        client.set_parameter("SYSTEM_ID", 77)
        client.save()
        client.messenger.send(
            dialect.MAVLink_command_long_message(50, 1, 246, 0, 1, 0, 0, 0, 0, 0, 0)
        )
    with running_dock(settings=file) as (url, _dock):
        done = chromadock(capsys, "dock", "info", "--port", url)
        assert done.status == 0, done.err
        assert "name      dock 77, chip 51d0c0000001" in done.out
        with DockClient(Connection(url), system=77) as client:
            client.led_raw(1, 2, 3)
            assert client.parameters()["SYSTEM_ID"] == 77
            assert is_water(client.snapshot())


def test_of_two_docks_one_has_to_be_chosen(two, capsys):
    done = chromadock(capsys, "dock", "info", "--port", two)
    assert done.status == 2
    assert "several docks, systems 50, 51: choose one with --system" in done.err
    for system in (50, 51):
        done = chromadock(capsys, "dock", "info", "--port", two, "--system", system)
        assert done.status == 0, done.err
        assert f"dock {system}," in done.out


def test_what_is_set_on_one_dock_is_not_set_on_the_other(two):
    with DockClient(Connection(two), system=51) as client:
        client.set_parameter("LED_LIMIT", 7)
        client.led_raw(9, 9, 9)
    with DockClient(Connection(two), system=50) as client:
        assert client.parameter("LED_LIMIT") == 255
        assert client.status().led_mode == dialect.DOCK_LED_AUTO


def test_a_dock_that_is_not_there_is_told_from_one_that_is(capsys):
    with running_dock() as (url, _dock):
        done = chromadock(capsys, "dock", "info", "--port", url, "--system", 9, "--timeout", 0.5)
        assert done.status == 2
        assert "a dock of system 50 is there, but not 9" in done.err
        done = chromadock(capsys, "dock", "info", "--port", url, "--system", 255)
        assert "give the dock's SYSTEM_ID, 1 .. 254" in done.err


class Redirector:
    """A serial port at a TCP port by RFC 2217, as pyserial's example and ser2net serve it."""

    def __init__(self, url):
        self.port = serial.serial_for_url(url, timeout=0)
        self.server = socket.create_server(("127.0.0.1", 0))
        self.stop = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    @property
    def address(self):
        return f"127.0.0.1:{self.server.getsockname()[1]}"

    def run(self):
        client, _ = self.server.accept()
        client.settimeout(0.002)
        write = type("Client", (), {"write": staticmethod(client.sendall)})
        manager = serial.rfc2217.PortManager(self.port, write)
        with contextlib.suppress(OSError):
            while not self.stop.is_set():
                with contextlib.suppress(TimeoutError):
                    data = client.recv(4096)
                    if not data:
                        return
                    self.port.write(b"".join(manager.filter(data)))
                if data := self.port.read(4096):
                    client.sendall(b"".join(manager.escape(data)))

    def close(self):
        self.stop.set()
        self.thread.join(1)
        self.server.close()
        self.port.close()


@pytest.mark.filterwarnings("ignore::DeprecationWarning:serial")
def test_a_port_by_rfc_2217_opens_and_is_as_good_as_any():
    with contextlib.ExitStack() as stack:
        url, _dock = stack.enter_context(running_dock(tcp=True))
        redirector = stack.enter_context(contextlib.closing(Redirector(url)))
        connection = Connection(f"rfc2217://{redirector.address}")
        client = stack.enter_context(DockClient(connection))
        assert client.version.git_hash == "simulate"
        assert len(client.parameters()) > 20
        assert is_water(client.snapshot())


def test_an_address_as_mavlink_programs_write_it_opens(capsys):
    with running_dock(tcp=True) as (url, _dock):
        address = url.replace("socket://", "tcp:")
        done = chromadock(capsys, "dock", "info", "--port", address)
        assert done.status == 0, done.err


@pytest.mark.parametrize("address", ["udp:127.0.0.1:14550", "udpin:0.0.0.0:14550", "tcpin:a:1"])
def test_an_address_that_no_port_can_have_is_refused_with_what_to_write(address, capsys):
    done = chromadock(capsys, "dock", "info", "--port", address)
    assert done.status == 2
    assert done.err.count("\n") == 1
    assert "give a device such as /dev/ttyUSB0, or tcp:HOST:PORT" in done.err
