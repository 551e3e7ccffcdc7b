"""The parts of the simulated dock: its camera, faults, storage and ports."""

import os
import random
import socket
from threading import Event

import cv2
import numpy as np
import pytest
import serial
from simulated_bench import HOST, limit
from simulation import packed, running_dock

from chromadock.errors import ChromadockError
from chromadock.link import Connection, DockClient
from chromadock.link.rgb565 import HEIGHT, WIDTH, from_rgb565, to_qqvga, to_rgb565
from chromadock.simulated import Fault, PtyPort, TcpPort, parse_fault
from chromadock.simulated.camera import LiveCamera, open_camera
from chromadock.simulated.damage import Damage
from chromadock.simulated.faults import KINDS
from chromadock.simulated.storage import Storage
from chromadock.sources import Frame, Source


def test_the_camera_shows_a_folder_again_and_again(tmp_path):
    for name, colour in (("1.png", (255, 0, 0)), ("2.png", (0, 255, 0))):
        cv2.imwrite(str(tmp_path / name), np.full((48, 64, 3), colour, np.uint8))
    camera = open_camera(str(tmp_path))
    pixels = [tuple(from_rgb565(camera.frame(), WIDTH, HEIGHT)[60, 80]) for _ in range(5)]
    blue, green = (255, 0, 0), (0, 255, 0)
    assert pixels == [blue, green, blue, green, blue]
    camera.close()


class Webcam(Source):
    """Two frames, then unplugged."""

    live = True

    def __init__(self, colours):
        self.colours = colours
        self.unplugged = Event()
        self.closed = False

    def __iter__(self):
        for index, colour in enumerate(self.colours):
            yield Frame(np.full((48, 64, 3), colour, np.uint8), "camera 0", index, index / 30)
        self.unplugged.wait(5)
        raise ChromadockError("camera 0: delivers no more frames: check the cable")

    def close(self):
        self.closed = True


def test_a_live_source_gives_its_newest_frame_and_its_fault():
    source = Webcam([(255, 0, 0), (0, 255, 0)])
    camera = LiveCamera(source)
    newest = camera.frame()
    source.unplugged.set()
    with pytest.raises(ChromadockError, match="check the cable"):
        while True:
            newest = camera.frame()
    assert newest[:2] in (b"\x00\x1f", b"\x07\xe0")
    camera.close()
    assert source.closed


def test_rgb565_is_big_endian_and_full_scale_stays():
    red = np.zeros((1, 2, 3), np.uint8)
    red[0, 0] = (0, 0, 255)
    red[0, 1] = (255, 255, 255)
    assert to_rgb565(red) == b"\xf8\x00\xff\xff"
    assert np.array_equal(from_rgb565(to_rgb565(red), 2, 1), red)


def test_all_rgb565_words_come_back_as_they_were():
    words = np.arange(65536, dtype=">u2").tobytes()
    assert to_rgb565(from_rgb565(words, 256, 256)) == words


def test_a_frame_of_another_size_is_averaged_to_the_cameras():
    striped = np.zeros((480, 640, 3), np.uint8)
    striped[:, ::2] = 200
    assert to_qqvga(striped).shape == (120, 160, 3)
    assert set(to_qqvga(striped).flat) == {100}


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 1.0])
def test_damage_hits_its_share_of_the_bytes_in_pieces_of_any_size(share):
    damage = Damage(share, random.Random(3))
    sizes = random.Random(4)
    hit = total = 0
    while total < 50_000:
        piece = bytes(sizes.randrange(1, 200))
        hit += sum(map(bool, damage.apply(piece)))
        total += len(piece)
    assert hit / total == pytest.approx(share, rel=0.15)


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_a_fault_is_read_with_its_time(kind):
    share = "=0.5" if kind == "corrupt" else ""
    wanted = 0.5 if share else 0.0
    assert parse_fault(kind + share) == Fault(kind, 0.0, wanted)
    assert parse_fault(f"{kind}{share}@2.5s") == Fault(kind, 2.5, wanted)


@pytest.mark.parametrize(
    "text",
    ["", "flood", "noise@", "noise@x", "noise@1.2.3s", "noise=1", "corrupt", "corrupt=2", "NOISE"],
)
def test_another_fault_is_refused_in_one_line(text):
    with pytest.raises(ChromadockError, match="--fault") as refusal:
        parse_fault(text)
    assert "\n" not in str(refusal.value)


def test_storage_without_a_file_forgets_with_the_process():
    storage = Storage(None)
    assert storage.load() is None
    assert storage.save(b"blob")
    assert storage.load() == b"blob"


def test_storage_that_is_no_file_is_refused(tmp_path):
    with pytest.raises(ChromadockError, match="--settings"):
        Storage(tmp_path).load()


def test_a_pseudo_terminal_survives_clients_that_come_and_go():
    port = PtyPort()
    for _ in range(3):
        with serial.Serial(port.url, timeout=1) as client:
            client.write(b"ping")
            assert port.read(1) == b"ping"
            assert port.write(b"pong") == 4
            assert client.read(4) == b"pong"
    port.close()


def test_a_pseudo_terminal_that_nobody_reads_takes_no_more_but_does_not_block():
    port = PtyPort()
    assert sum(port.write(bytes(1000)) for _ in range(100)) < 100_000
    assert port.read(0) == b""
    port.close()


def test_a_tcp_port_serves_one_client_at_a_time():
    port = TcpPort("localhost:0")
    address = ("127.0.0.1", int(port.url.rpartition(":")[2]))
    with socket.create_connection(address) as first:
        port.read(1)
        with socket.create_connection(address) as second:
            port.read(1)
            assert second.recv(1) == b""  # turned away
        first.sendall(b"ping")
        assert port.read(1) == b"ping"
        assert port.write(b"pong") == 4
        assert first.recv(4) == b"pong"
    assert port.read(1) == b""
    assert port.write(b"nobody") == 6
    with socket.create_connection(address) as third:
        port.read(1)
        third.sendall(b"ping")
        assert port.read(1) == b"ping"
    port.close()


@pytest.mark.parametrize(
    ("address", "says"),
    [
        ("0.0.0.0:5760", "only localhost"),
        ("192.168.1.1:5760", "only localhost"),
        ("example.com:5760", "only localhost"),
        ("5760", "HOST:PORT"),
        ("localhost:http", "HOST:PORT"),
        ("localhost:70000", "HOST:PORT"),
    ],
)
def test_a_tcp_address_that_is_not_this_computers_is_refused(address, says):
    with pytest.raises(ChromadockError, match=says):
        TcpPort(address)


def test_a_tcp_port_that_is_taken_is_refused():
    refused = pytest.raises(ChromadockError, match="another port")
    with socket.create_server(("127.0.0.1", 0)) as taken, refused:
        TcpPort(f"localhost:{taken.getsockname()[1]}")


def test_a_client_that_leaves_within_a_message_does_no_harm_to_the_next_one():
    with running_dock() as (url, _dock):
        fd = os.open(url, os.O_RDWR | os.O_NOCTTY)
        os.write(fd, packed(limit(7), **HOST)[:9])
        os.close(fd)
        with DockClient(Connection(url)) as client:
            assert client.parameter("LED_LIMIT") == 255
