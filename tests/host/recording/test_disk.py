"""Recordings on disks that are full, slow or not to be written, and what a kill leaves of them."""

from __future__ import annotations

import contextlib
import dataclasses
import itertools
import json
import multiprocessing
import os
import random
import re
import resource
import signal
import threading
import time
from collections.abc import Iterator
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path

import cv2
import numpy as np
import pytest
from filmed_approach import CAMERA, FPS
from recorded_dive import COUNT, open_output, read, recovered

from chromadock import Attitude
from chromadock.errors import ChromadockError
from chromadock.output import Guarded, Surroundings
from chromadock.output import open_output as open_named
from chromadock.output.recording import Recording
from chromadock.output.run_setup import RunSetup
from chromadock.results.detection import Detection
from chromadock.ros.topics import TOPICS
from chromadock.sources import Frame, open_source
from chromadock.vehicle.keys import VehicleFile

KILLS = int(os.environ.get("CHROMADOCK_KILLS", "5"))
"""How many runs are killed."""

RATE_HZ = 10 if KILLS == 5 else 30
"""Of what they record: few enough for a computer that runs other tests besides; `make soak` has
one for itself."""


def test_no_recording_is_overwritten(tmp_path: Path) -> None:
    told: list[str] = []
    for _ in range(3):
        open_named(f"mcap:{tmp_path / 'dive.mcap'}", Surroundings(None, told.append)).close()
    assert sorted(p.name for p in tmp_path.iterdir()) == [
        "dive-2.mcap", "dive-3.mcap", "dive.mcap"
    ]  # fmt: skip
    assert [line.endswith(f"recording into {tmp_path}/dive-{k}.mcap") for line, k in
            zip(told, (2, 3), strict=True)] == [True, True]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("mcap:", "no such output: give one of json:FILE, mcap:FILE"),
        ("mcap:no/such/dive.mcap", "no such folder: create it first"),
        ("mcap:/proc/dive.mcap", "cannot be written"),
    ],
)
def test_a_place_where_nothing_can_be_recorded_is_one_line(text: str, said: str) -> None:
    with pytest.raises(ChromadockError, match=re.escape(said)) as refused:
        open_output(text)
    assert "\n" not in str(refused.value)


def test_a_full_disk_stops_the_recording_only_and_it_goes_on_when_there_is_room(
    tmp_path: Path, run: tuple[list[Frame], list[Detection]]
) -> None:
    """A limit on the size of files does what a full disk does; lifted, the file is whole."""
    path, told = tmp_path / "dive.mcap", list[str]()
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, before[1]))
        with Guarded(Recording(path), told.append) as output:
            until = time.monotonic() + 20
            number = 0
            while len(told) < 2 and time.monotonic() < until:
                frame, detection = (one[number % COUNT] for one in run)
                output.write(Frame(frame.image, frame.name, number, number / FPS), detection, 0.01)
                number += 1
                time.sleep(0.02)
                if told:
                    resource.setrlimit(resource.RLIMIT_FSIZE, before)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, ignored)
    assert "dive.mcap: cannot be written (File too large): check disk" in told[0]
    assert "works again" in told[1]
    found = read(path)
    numbers = [json.loads(m.data)["frame"] for _, m in found["/chromadock/detection"]]
    assert numbers[0] == 0 and numbers == sorted(set(numbers)) and numbers[-1] == number - 1
    assert len(found["/chromadock/image"]) == len(numbers) < number


def test_a_disk_that_stays_full_leaves_what_was_written(
    tmp_path: Path, run: tuple[list[Frame], list[Detection]]
) -> None:
    with (
        pytest.raises(ChromadockError, match="/dev/full: cannot be written"),
        Recording(Path("/dev/full")) as recording,
    ):
        recording.write(run[0][0], run[1][0], None)


def test_a_recording_without_a_camera_waits_for_the_disk_and_with_one_does_not(
    tmp_path: Path, run: tuple[list[Frame], list[Detection]]
) -> None:
    """The disk is a pipe that nobody reads at first."""
    pipe = tmp_path / "slow"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    recording = Recording(pipe)
    with pytest.raises(ChromadockError, match="the disk is too slow to record every frame"):
        while True:
            recording.write(run[0][0], run[1][0], 0.01)
            time.sleep(0.002)
    waits = threading.Thread(target=recording.write, args=(run[0][0], run[1][0], None))
    waits.start()
    waits.join(0.3)
    assert waits.is_alive()
    os.set_blocking(reader, True)
    drain = threading.Thread(
        target=lambda: [0 for _ in iter(lambda: os.read(reader, 1 << 20), b"")]
    )
    drain.start()
    waits.join(20)
    assert not waits.is_alive()
    recording.close()
    drain.join(20)
    os.close(reader)


def rolled(number: int) -> Attitude:
    """Of a frame, by its number."""
    return Attitude(1e-4 * number, 0.0, 0.0)


def write_without_end(path: Path, frame: Frame, detection: Detection, told: Connection) -> None:
    """``RATE_HZ`` frames a second; tells the number and the time of each that was written."""
    recording = Recording(path, RunSetup(VehicleFile(), CAMERA))
    start_s = time.monotonic()
    for number in itertools.count():
        time.sleep(max(start_s + number / RATE_HZ - time.monotonic(), 0))
        now_s = time.monotonic()
        taken = dataclasses.replace(
            frame, index=number, time_s=now_s - start_s, attitude=rolled(number)
        )
        recording.write(taken, detection, 0.0)
        told.send((number, time.monotonic()))


@pytest.mark.parametrize("seed", range(KILLS))
def test_a_kill_at_any_moment_takes_the_last_second_at_most(
    tmp_path: Path, run: tuple[list[Frame], list[Detection]], seed: int
) -> None:
    path = tmp_path / "dive.mcap"
    writer, pipe = killable(path, run[0][-1], run[1][-1])
    time.sleep(random.Random(seed).uniform(0.05, 2.2))
    killed_s = time.monotonic()
    writer.kill()
    writer.join()
    due = [number for number, at_s in received(pipe) if at_s < killed_s - 1.0]
    found, attached = recovered(path)
    assert attached == {"vehicle.toml", "dock.toml"}
    said = [json.loads(m.data)["frame"] for _, m in found.get("/chromadock/detection", [])]
    assert said == list(range(len(said)))
    assert len(said) > max(due, default=-1)
    for topic in set(TOPICS) if said else ():
        assert len(found[topic]) == len(said)
    for _, message in found.get("/chromadock/image", []):
        assert cv2.imdecode(np.frombuffer(bytes(message.data), np.uint8), 1) is not None
    told = frames_of_ours(path)
    assert len(told) == len(said)
    for frame in told:
        assert frame.attitude is not None
        assert frame.attitude.roll_rad == pytest.approx(rolled(frame.index).roll_rad, abs=1e-9)


def killable(path: Path, frame: Frame, detection: Detection) -> tuple[BaseProcess, Connection]:
    """A process that records without end, and where it tells what it wrote; it has begun."""
    fork = multiprocessing.get_context("fork")
    ours, its = fork.Pipe(duplex=False)
    writer = fork.Process(target=write_without_end, args=(path, frame, detection, its), daemon=True)
    writer.start()
    its.close()
    assert ours.poll(20)
    return writer, ours


def received(pipe: Connection) -> Iterator[tuple[int, float]]:
    """All that a process told before its end."""
    with contextlib.suppress(EOFError):
        while True:
            yield pipe.recv()


def frames_of_ours(path: Path) -> list[Frame]:
    """The frames that this program reads of an unfinished file, which it says is one."""
    told: list[str] = []
    try:
        with open_source(str(path), on_fault=told.append) as source:
            found = list(source)
            assert source.cut_short
    except ChromadockError as error:  # killed before there was any
        assert "no pictures in it" in str(error)
        return []
    assert len(told) == 1 and "cut short (it was never finished" in told[0]
    return found
