from __future__ import annotations

import contextlib
import socket
import time
from pathlib import Path

import numpy as np
import pytest
from autopilot_peer import free_port

from chromadock.output import Surroundings, open_output
from chromadock.output.page import server
from chromadock.output.page.picture import PERIOD_S, Picture
from chromadock.output.page.status import STALE_S, Status
from chromadock.output.results import ResultOutput
from chromadock.output.run_setup import RunSetup
from chromadock.results.detection import Background, Detection, Marker
from chromadock.sources import Frame
from chromadock.vehicle.reading import settings_of

RESULT = Detection(
    "not_found", Background((10, 100, 90), 170.0, 0.8), Marker(None, None), None, 0.0
)


def frame(index: int, level: int = 90) -> Frame:
    return Frame(np.full((240, 320, 3), level, np.uint8), "camera 0", index, index / 30)


def test_the_age_goes_on_while_no_picture_comes_and_frames_that_were_left_out_are_counted() -> None:
    status = Status()
    status.begin(None)
    assert status.trouble(10.0) == "no picture yet"
    for index, now_s in ((0, 10.0), (3, 10.1), (4, 10.2)):
        status.take(frame(index), RESULT, 0.05, now_s)
    told = status.record(10.5)
    assert told["age_s"] == pytest.approx(0.35)
    assert (told["frames"], told["dropped"], told["rate_hz"]) == (3, 2, 10.0)
    assert told["trouble"] is None and told["result"]["frame"] == 4
    assert status.trouble(10.2 + STALE_S) == "no new picture for 5 s"


def test_what_fails_is_told_until_the_next_run_begins() -> None:
    status = Status()
    status.take(frame(0), RESULT, None, 1.0)
    status.fails("camera 0: does not open")
    assert status.trouble(1.0) == "camera 0: does not open"
    status.begin(None)
    assert status.record(1.0)["frames"] == 0 and status.newest is None


class Troubled(ResultOutput):
    def __init__(self, trouble: str | None) -> None:
        self._trouble = trouble

    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        raise AssertionError

    def trouble(self) -> str | None:
        return self._trouble


@pytest.mark.parametrize(
    ("name", "trouble", "shown"),
    [
        ("json:/log", "/log: the disk is full: make room", "the disk is full: make room"),
        ("udp:eye:9000", "udp:eye:9000: cannot be reached", "cannot be reached"),
        ("mcap:dive.mcap", "dive-2.mcap: cannot be written", "dive-2.mcap: cannot be written"),
        ("json:/log", None, None),
    ],
)
def test_the_trouble_of_an_output_does_not_name_it_again(
    name: str, trouble: str | None, shown: str | None
) -> None:
    status = Status()
    status.beside({name: Troubled(trouble)})
    assert status.record(1.0)["outputs"] == [{"name": name, "trouble": shown}]


def test_however_many_ask_a_picture_is_drawn_five_times_a_second_at_most() -> None:
    now, status = [0.0], Status()
    picture = Picture(lambda: now[0])
    drawn = []
    for index in range(30):
        now[0] = index / 30
        status.take(frame(index, 5 * index), RESULT, 0.0, now[0])
        assert status.newest is not None
        drawn.append(picture.jpeg(status.newest, None))
    assert 4 <= len(set(drawn)) <= 1 / PERIOD_S
    assert drawn[0] != drawn[-1]


@pytest.mark.parametrize(("host", "others_can"), [("", False), ("0.0.0.0:", True)])
def test_only_who_asks_for_it_lets_other_computers_see_the_page(
    host: str, others_can: bool
) -> None:
    """127.0.0.2 is this computer by another address."""
    port = free_port(socket.SOCK_STREAM)
    with open_output(f"http:{host}{port}", Surroundings(None, print)):
        for address, can in (("127.0.0.1", True), ("127.0.0.2", others_can)):
            with socket.socket() as client:
                assert (client.connect_ex((address, port)) == 0) is can


def test_a_client_that_neither_asks_nor_reads_gives_up_its_place(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Half of them never ask, half never read a recording that fills every buffer."""
    monkeypatch.setattr(server._Handler, "timeout", 0.5)
    dive = tmp_path / "dive.mcap"
    with dive.open("wb") as file:
        file.truncate(64_000_000)
    setup = RunSetup(settings_of({"outputs.record": str(dive)}), None)
    port = free_port(socket.SOCK_STREAM)
    with (
        open_output(f"http:{port}", Surroundings(setup, print)),
        contextlib.ExitStack() as stack,
    ):
        for number in range(server.MOST_CLIENTS):
            client = stack.enter_context(socket.create_connection(("127.0.0.1", port)))
            if number % 2:
                client.send(b"GET /recordings/dive.mcap HTTP/1.0\r\n\r\n")
        late = stack.enter_context(socket.create_connection(("127.0.0.1", port)))
        assert late.recv(1) == b""  # turned away
        time.sleep(1.5)
        later = stack.enter_context(socket.create_connection(("127.0.0.1", port)))
        later.send(b"GET /healthz HTTP/1.0\r\n\r\n")
        assert later.recv(9) == b"HTTP/1.0 "
