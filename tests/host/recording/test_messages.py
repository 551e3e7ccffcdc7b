"""What is in a recording, by two readers from elsewhere."""

from __future__ import annotations

import dataclasses
import json
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from filmed_approach import CAMERA, FPS
from recorded_dive import COUNT, Messages, open_output, read
from rosbags.highlevel import AnyReader

from chromadock import CameraModel
from chromadock.output.recording import Recording
from chromadock.results.detection import Detection
from chromadock.ros.diagnostics import diagnostics
from chromadock.ros.image import camera_info
from chromadock.ros.topics import TOPICS
from chromadock.ros.types import serialised
from chromadock.sources import Frame


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
