"""Recordings: what is in them, by two readers from elsewhere, and what a kill leaves of them."""

from __future__ import annotations

import contextlib
import dataclasses
import io
import itertools
import json
import multiprocessing
import os
import random
import re
import resource
import signal
import struct
import threading
import time
from collections.abc import Iterator
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from filmed_approach import CAMERA, CAMERA_YAML, FPS, detected, frames
from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from chromadock import Attitude, CameraModel
from chromadock.errors import ChromadockError
from chromadock.output import Guarded, ResultOutput, Surroundings
from chromadock.output import open_output as open_named
from chromadock.output.recording import Recording
from chromadock.output.run_setup import RunSetup
from chromadock.results.detection import Detection
from chromadock.ros.diagnostics import diagnostics
from chromadock.ros.image import camera_info
from chromadock.ros.topics import TOPICS
from chromadock.ros.types import serialised
from chromadock.sources import Frame, open_source
from chromadock.vehicle.keys import CameraKeys, DockKeys, MountingKeys, VehicleFile
from chromadock.vehicle.manual import as_toml
from chromadock.vehicle.reading import read_vehicle

COUNT = 12
KILLS = int(os.environ.get("CHROMADOCK_KILLS", "5"))
"""How many runs are killed."""

RATE_HZ = 10 if KILLS == 5 else 30
"""Of what they record: few enough for a computer that runs other tests besides; `make soak` has
one for itself."""

Messages = dict[str, list[tuple[int, Any]]]


@pytest.fixture(scope="module")
def run() -> tuple[list[Frame], list[Detection]]:
    """Of a vehicle that tells its attitude, another one with each frame."""
    pictures = [
        dataclasses.replace(frame, attitude=Attitude(0.01 * frame.index, 0.02, -0.5))
        for frame in frames(COUNT, start_s=3.0)
    ]
    results = detected(pictures)
    assert [r.track.state for r in results if r.track][-1] == "tracking"
    return pictures, results


@pytest.fixture(scope="module")
def recorded(
    run: tuple[list[Frame], list[Detection]], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """As of a camera whose pictures were 40 ms old when their results were out."""
    path = tmp_path_factory.mktemp("recorded") / "dive.mcap"
    with Recording(path, RunSetup(VehicleFile(), CAMERA)) as recording:
        for frame, detection in zip(*run, strict=True):
            recording.write(frame, detection, 0.04)
    return path


def open_output(text: str) -> ResultOutput:
    return open_named(text, Surroundings(None, print))


def read(path: Path) -> Messages:
    """Time and message of every topic, by the mcap library's own decoder."""
    found: Messages = {}
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
    return found


def recovered(path: Path) -> tuple[Messages, set[str]]:
    """The same of a file without an end, up to its last whole piece; and its attachments."""
    found: Messages = {}
    names: set[str] = set()
    content = path.read_bytes()
    reader = NonSeekingReader(io.BytesIO(content), decoder_factories=[DecoderFactory()])
    with contextlib.suppress(EndOfFile, struct.error, ValueError):
        for _, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
    with contextlib.suppress(EndOfFile, struct.error, ValueError):
        for attachment in NonSeekingReader(io.BytesIO(content)).iter_attachments():
            names.add(attachment.name)
    return found, names


def stamp_ns(message: Any) -> int:
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def plain(message: Any) -> Any:
    """Either library's message as plain values."""
    if hasattr(message, "__slots__") and not isinstance(message, (np.ndarray, np.generic)):
        return {name: plain(getattr(message, name)) for name in message.__slots__}
    if hasattr(message, "__dataclass_fields__"):
        names = [field.name for field in dataclasses.fields(message)]
        return {
            name: plain(getattr(message, name))
            for name in names
            if name[0] != "_" and name.islower()
        }
    if isinstance(message, bytes):
        return list(message)
    if isinstance(message, np.ndarray):
        return message.tolist()
    if isinstance(message, (list, tuple)):
        return [plain(one) for one in message]
    return message


def test_every_topic_has_its_messages_at_the_time_of_capture(
    recorded: Path, run: tuple[list[Frame], list[Detection]]
) -> None:
    _, results = run
    found = read(recorded)
    tracked = [r.track is not None and r.track.state == "tracking" for r in results]
    sometimes = ("/chromadock/pose", "/tf")
    assert set(found) == set(TOPICS)
    for topic, messages in found.items():
        assert len(messages) == (sum(tracked) if topic in sometimes else COUNT), topic
    times = [logged for logged, _ in found["/chromadock/image"]]
    now_ns = time.time_ns()
    assert now_ns - 60e9 < times[0] < now_ns
    assert np.diff(times) == pytest.approx([1e9 / FPS] * (COUNT - 1), abs=1)
    for topic, messages in found.items():
        of_frames = times if topic not in sometimes else list(np.array(times)[tracked])
        assert [logged for logged, _ in messages] == of_frames, topic
        if topic not in ("/tf", "/chromadock/detection"):
            assert [stamp_ns(m) for _, m in messages] == of_frames, topic
            where = "base_link" if topic == "/chromadock/attitude" else "camera_optical_frame"
            assert {m.header.frame_id for _, m in messages} == {where}


def test_the_messages_say_what_the_detector_said(
    recorded: Path, run: tuple[list[Frame], list[Detection]]
) -> None:
    results = run[1]
    found = read(recorded)
    last = results[-1]
    assert last.track is not None and last.track.pose is not None and last.pose is not None
    pose = found["/chromadock/pose"][-1][1].pose
    where, turn = pose.pose.position, pose.pose.orientation
    assert (where.x, where.y, where.z) == last.track.pose.t
    assert (turn.w, turn.x, turn.y, turn.z) == last.track.pose.q_wxyz
    assert tuple(pose.covariance) == last.track.pose.covariance
    transform = found["/tf"][-1][1].transforms[0]
    assert transform.header.frame_id == "camera_optical_frame"
    assert transform.child_frame_id == "dock"
    assert transform.transform.translation.z == pytest.approx(where.z)
    said = json.loads(found["/chromadock/detection"][-1][1].data)
    assert said["frame"] == COUNT - 1 and said["age_s"] == 0.04
    assert Detection.from_dict(said).state == last.state
    dock, *markers = found["/chromadock/detections"][-1][1].detections
    assert dock.results[0].hypothesis.class_id == "dock"
    assert dock.results[0].pose.pose.position.z == last.pose.t[2]
    assert last.markers is not None
    assert {m.id: (m.bbox.center.position.x, m.bbox.center.position.y) for m in markers} == (
        last.markers
    )
    xs = [x for x, _ in last.markers.values()]
    assert dock.bbox.size_x == pytest.approx(max(xs) - min(xs))
    status = found["/diagnostics"][-1][1].status[0]
    values = {pair.key: pair.value for pair in status.values}
    assert (status.message, values["latency_ms"], values["dropped"]) == ("tracking", "40.0", "0")
    assert float(values["clipped"]) == pytest.approx(last.clipped or 0.0, abs=1e-3)


def test_the_picture_is_that_of_the_camera_and_its_calibration_beside_it(
    recorded: Path, run: tuple[list[Frame], list[Detection]]
) -> None:
    found = read(recorded)
    image = found["/chromadock/image"][-1][1]
    decoded = cv2.imdecode(np.frombuffer(bytes(image.data), np.uint8), cv2.IMREAD_COLOR)
    off = np.abs(decoded.astype(int) - run[0][-1].image)
    assert image.format == "jpeg" and off.mean() < 2.0 and off.max() < 20
    info = found["/chromadock/camera_info"][-1][1]
    assert (info.width, info.height, info.distortion_model) == (640, 480, "plumb_bob")
    assert list(info.k) == [512, 0, 319.5, 0, 510, 239.5, 0, 0, 1]
    assert list(info.p) == [512, 0, 319.5, 0, 0, 510, 239.5, 0, 0, 0, 1, 0]
    assert list(info.d) == [0.0] * 5


def test_a_second_library_reads_the_same(recorded: Path) -> None:
    first = read(recorded)
    second: Messages = {}
    with AnyReader([recorded]) as bag:
        for connection, logged, data in bag.messages():
            message = bag.deserialize(data, connection.msgtype)
            second.setdefault(connection.topic, []).append((logged, message))
        assert {c.topic: c.msgtype for c in bag.connections} == TOPICS
    assert {topic: len(messages) for topic, messages in first.items()} == {
        topic: len(messages) for topic, messages in second.items()
    }
    for topic, messages in first.items():
        for (time_1, message_1), (time_2, message_2) in zip(messages, second[topic], strict=True):
            assert time_1 == time_2
            assert plain(message_1) == plain(message_2), topic


def test_a_picture_counts_from_the_opening_where_there_is_no_camera(
    tmp_path: Path, run: tuple[list[Frame], list[Detection]]
) -> None:
    before_ns = time.time_ns()
    with open_output(f"mcap:{tmp_path / 'dive.mcap'}") as output:
        after_ns = time.time_ns()
        for frame, detection in zip(*run, strict=True):
            output.write(frame, detection, None)
    first_ns = read(tmp_path / "dive.mcap")["/chromadock/image"][0][0]
    assert before_ns <= first_ns - 3e9 <= after_ns


def test_frames_that_are_not_there_are_counted(
    tmp_path: Path, run: tuple[list[Frame], list[Detection]]
) -> None:
    with Recording(tmp_path / "dive.mcap") as recording:
        for frame, detection in list(zip(*run, strict=True))[::3]:
            recording.write(frame, detection, 0.01)
    told = [m.status[0].values for _, m in read(tmp_path / "dive.mcap")["/diagnostics"]]
    assert [pair.value for v in told for pair in v if pair.key == "dropped"] == list("0246")


@pytest.mark.parametrize(
    ("count", "model"), [(0, "plumb_bob"), (4, "plumb_bob"), (8, "rational_polynomial")]
)
def test_a_lens_has_as_many_coefficients_as_ros_wants(count: int, model: str) -> None:
    camera = type(CAMERA)(640, 480, CAMERA.matrix, np.full(count, 0.01))
    info = camera_info(camera, 0)
    assert info["distortion_model"] == model and len(info["d"]) == max(count, 5)
    assert sum(info["d"]) == pytest.approx(count * 0.01)


def test_results_that_come_late_are_a_warning(
    run: tuple[list[Frame], list[Detection]],
) -> None:
    status = [diagnostics(run[1][-1], age_s, 0, 0)["status"][0] for age_s in (0.1, 0.7)]
    assert [s["level"] for s in status] == [0, 1]
    assert status[1]["message"] == "tracking, results are late"


@pytest.mark.parametrize("fields", [{"dta": "x"}, {}, {"data": "x", "more": 1}])
def test_a_slip_in_a_field_is_no_message(fields: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="std_msgs/msg/String has data"):
        serialised("std_msgs/msg/String", fields)


def test_the_settings_come_back_with_the_files_that_they_name(tmp_path: Path) -> None:
    (tmp_path / "cam.yaml").write_text(CAMERA_YAML)
    settings = VehicleFile(
        camera=CameraKeys(
            source="rtsp://pilot:secret@192.168.2.2/cam?token=1",
            calibration=str(tmp_path / "cam.yaml"),
        ),
        mounting=MountingKeys(pitch_deg=-20.0),
        dock=DockKeys(colour="#0000FF", mapping="contrast"),
    )
    files = RunSetup(settings, CAMERA).files()
    assert files["camera.yaml"].decode() == CAMERA_YAML
    assert not any(b"secret" in content or b"token" in content for content in files.values())
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    again = read_vehicle(tmp_path / "vehicle.toml")
    assert again.mounting == settings.mounting and again.detector == settings.detector
    assert again.dock == settings.dock.model_copy(update={"file": str(tmp_path / "dock.toml")})
    assert again.camera.source == "rtsp://...@192.168.2.2/cam..."


@pytest.mark.parametrize(
    ("lens", "given", "told"),
    [
        ("plumb_bob", [-0.2, 0.05, 0.001, 0.0], [-0.2, 0.05, 0.001, 0.0, 0.0]),
        ("equidistant", [0.1, 0.01, 0.0, 0.0], [0.1, 0.01, 0.0, 0.0]),
        ("equidistant", [], [0.0] * 4),
        ("rational_polynomial", [0.1] * 8, [0.1] * 8),
    ],
)
def test_the_lens_of_a_recording_is_the_cameras(
    lens: str, given: list[float], told: list[float]
) -> None:
    """A fisheye's four coefficients are no plumb_bob's."""
    matrix = np.array([[400.0, 0, 320], [0, 400, 240], [0, 0, 1]])
    fields = camera_info(CameraModel(640, 480, matrix, np.array(given), lens=lens), 0)
    assert (fields["distortion_model"], fields["d"]) == (lens, told)


def test_settings_written_are_read_as_the_same(tmp_path: Path) -> None:
    odd = VehicleFile(camera=CameraKeys(source='a "quoted" \\ väg\n'), mounting=MountingKeys())
    for settings in (VehicleFile(), odd):
        (tmp_path / "v.toml").write_text(as_toml(settings), encoding="utf-8")
        assert read_vehicle(tmp_path / "v.toml") == settings


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


def drained(descriptor: int) -> None:
    while os.read(descriptor, 1 << 20):
        pass


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


LAYOUT = Path(__file__).resolve().parents[2] / "docs" / "foxglove_layout.json"


def test_the_layout_for_foxglove_shows_what_is_recorded(recorded: Path) -> None:
    """Each panel is placed once, and what it shows has messages with such a field."""
    layout = json.loads(LAYOUT.read_text())
    placed = leaves(layout["layout"])
    assert sorted(placed) == sorted(layout["configById"])
    assert {name.partition("!")[0] for name in placed} >= {
        "Image", "3D", "DiagnosticStatusPanel", "Plot"
    }  # fmt: skip
    found = read(recorded)
    named = set(re.findall(r'"(/[a-z_/]+)[".]', LAYOUT.read_text()))
    assert named <= set(found) and len(named) == 5
    plots = layout["configById"]["Plot!chromadock"]["paths"]
    for topic, *fields in (path["value"].split(".") for path in plots):
        value = found[topic][0][1]
        for field in fields:
            value = getattr(value, field)
        assert isinstance(value, float)
    status = found["/diagnostics"][0][1].status[0]
    panel = layout["configById"]["DiagnosticStatusPanel!chromadock"]
    assert (status.hardware_id, status.name) == (panel["selectedHardwareId"], panel["selectedName"])
    assert '"frame:camera_optical_frame"' in LAYOUT.read_text()


def leaves(node: Any) -> list[str]:
    """Panels of a layout's tree."""
    if isinstance(node, str):
        return [node]
    return [*leaves(node["first"]), *leaves(node["second"])]
