"""``chromadock ros`` as a process, and a node of rclpy that plays the camera and listens."""

from __future__ import annotations

import contextlib
import json
import re
import shlex
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import yaml
from patience import PATIENCE_S
from ros_processes import PYTHON, Message, Node, Peer, environment, running, stamp_ns
from simulation import chromadock

from chromadock import CameraModel, Detector, DockGeometry
from chromadock.ros.image import camera_info
from chromadock.rotation import matrix_from_quaternion

ROOT = Path(__file__).resolve().parents[3]
PARAMETERS = ROOT / "ros2" / "chromadock_ros" / "config" / "chromadock.yaml"
PAGE = ROOT / "docs" / "ros.md"
COUNT = 8
FRAME_ID = "front_optical_frame"
START_NS = 1_760_000_000_123_456_789
POSE, NAV2, DIAGNOSTICS = "/chromadock/pose", "/detected_dock_pose", "/diagnostics"


@dataclass
class Dive:
    """Simulated frames: their files, stamps and truth."""

    folder: Path
    camera: CameraModel
    stamps_ns: list[int] = field(default_factory=list)
    t: list[list[float]] = field(default_factory=list)
    locked: int = COUNT
    """The first frame in which the dock is tracked."""

    def order(self, k: int, **more: Any) -> Message:
        """Have the peer publish frame ``k``."""
        image = str(self.folder / f"{k:06d}.jpg")
        return {"image": image, "stamp_ns": self.stamps_ns[k], "frame_id": FRAME_ID, **more}


@pytest.fixture(scope="module")
def dive(tmp_path_factory: pytest.TempPathFactory) -> Dive:
    environment(Path())  # skips before the frames are rendered
    from chromadock.cli.simulate import simulate

    folder = tmp_path_factory.mktemp("ros") / "frames"
    simulate("pool", folder, frames=COUNT, set_=["vehicle.distance_m=2"], workers=1)
    dive = Dive(folder, CameraModel.from_yaml(folder / "camera.yaml"))
    detector = Detector(dive.camera, DockGeometry.default())
    for k, line in enumerate((folder / "truth.jsonl").read_text().splitlines()):
        truth = json.loads(line)
        dive.stamps_ns.append(START_NS + round(truth["time_s"] * 1e9))
        dive.t.append(truth["T_camera_dock"]["t"])
        track = detector.process(cv2.imread(str(folder / f"{k:06d}.jpg")), truth["time_s"]).track
        assert track is not None
        tracked = track.state == "tracking" and track.age_s == 0
        assert tracked or k <= dive.locked
        dive.locked = min(dive.locked, k) if tracked else dive.locked
    assert 0 < dive.locked < COUNT - 4
    return dive


def info_of(camera: CameraModel) -> Message:
    """Its CameraInfo, without a header: the peer gives it the picture's."""
    fields = camera_info(camera, 0)
    del fields["header"]
    return fields


def posed(peer: Peer, stamp: int, seconds: float) -> bool:
    """Whether both poses of a picture come within so long."""
    missing = {POSE, NAV2}

    def last(message: Message) -> bool:
        if message["topic"] in missing and stamp_ns(message) == stamp:
            missing.remove(message["topic"])
        return not missing

    return peer.wait(last, seconds) is not None


def play(peer: Peer, dive: Dive, **more: Any) -> None:
    """All frames, each after the pose of the one before it, once there are poses."""
    locked = False
    for k, stamp in enumerate(dive.stamps_ns):
        peer.publish(dive.order(k, **more))
        # Without a pose nothing tells that a picture was looked at: on a busy computer the next one
        # would take its place.
        came = posed(peer, stamp, PATIENCE_S if locked else 3.0 if k >= dive.locked else 1.0)
        # The first picture may be taken before its CameraInfo, and one may be dropped.
        assert came or (not locked and k <= dive.locked + 2), f"no pose of frame {k}"
        assert not came or k >= dive.locked, f"a pose of frame {k}"
        locked = came


def of(topic: str, messages: list[Message]) -> list[Message]:
    return [message for message in messages if message["topic"] == topic]


def complaints(messages: list[Message]) -> list[str]:
    """What diagnostics of level ERROR say."""
    status = [one["status"][0] for one in of(DIAGNOSTICS, messages)]
    return [one["message"] for one in status if one["level"] == [2]]


@pytest.fixture(scope="module")
def told(dive: Dive, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What the other node heard in each part of a run, and how that ended."""
    folder = tmp_path_factory.mktemp("run")
    water = folder / "water.png"
    water_bgr = np.full((dive.camera.height, dive.camera.width, 3), (200, 160, 40), np.uint8)
    cv2.imwrite(str(water), water_bgr)
    small = folder / "small.png"
    cv2.imwrite(str(small), np.full((120, 160, 3), 90, np.uint8))
    good = info_of(dive.camera)
    parts: dict[str, Any] = {}
    arguments = ["--ros-args", "-r", "image:=/front/image_raw", "-r", "imu:=/front/imu"]
    with running(folder, *arguments) as (node, peer):

        def part(name: str) -> None:
            parts[name], peer.heard = peer.heard, []

        peer.heard = []
        for k in range(50):  # until it is logged, which on a busy computer may take a while
            none = {**good, "k": [0.0] * 9}
            peer.publish(dive.order(0, camera_info=none) | {"stamp_ns": START_NS - 10**9 + k})
            peer.wait(lambda m: m["topic"] == POSE, 0.4)
            if "is not calibrated" in node.said and complaints(peer.heard):
                break
        part("not calibrated")
        play(peer, dive, camera_info=good)
        part("dock")
        for k in range(2):
            later = {"image": str(water), "stamp_ns": START_NS + (20 + k) * 10**8}
            peer.publish(dive.order(0, camera_info=good) | later)
            peer.wait(lambda m: m["topic"] in (POSE, NAV2), 0.3)
        part("no dock")
        peer.publish(dive.order(0) | {"image": str(small), "stamp_ns": START_NS + 3 * 10**9})
        peer.wait(lambda m: bool(complaints([m])))
        part("another size")
        play(peer, dive, camera_info=good)  # from the start, as a bag that is looped
        part("again")
        parts["status"] = node.end()
        parts["said"] = node.said
    return parts


def test_each_frame_of_the_dock_brings_a_pose_with_its_stamp(
    dive: Dive, told: dict[str, Any]
) -> None:
    for part in ("dock", "again"):
        for topic in (POSE, NAV2):
            poses = of(topic, told[part])
            assert len(poses) >= COUNT - dive.locked - 3
            assert [stamp_ns(pose) for pose in poses] == dive.stamps_ns[-len(poses) :]
            assert {pose["header"]["frame_id"] for pose in poses} == {FRAME_ID}


def test_poses_are_those_of_the_simulator(dive: Dive, told: dict[str, Any]) -> None:
    truth = dict(zip(dive.stamps_ns, dive.t, strict=True))
    for pose in of(POSE, told["dock"]):
        place = np.array([pose["pose"]["pose"]["position"][axis] for axis in "xyz"])
        covariance = np.array(pose["pose"]["covariance"]).reshape(6, 6)
        error = place - truth[stamp_ns(pose)]
        assert np.linalg.norm(error) < 0.02 * np.linalg.norm(place)
        assert (np.linalg.eigvalsh(covariance) > 0).all()
        assert abs(error[2]) < 5 * np.sqrt(covariance[2, 2])


def test_nav2_drives_into_the_dock_by_the_parameters_of_the_page(told: dict[str, Any]) -> None:
    """SimpleChargingDock turns a detected pose by setRPY(roll, pitch, yaw), in ROS 2 Kilted and
    before by setEuler, which is the same without a yaw, and drives along +x: the dock's z."""
    [block] = re.findall(r"```yaml\n(.*?)```", PAGE.read_text(), re.DOTALL)
    keys = yaml.safe_load(block)["docking_server"]["ros__parameters"]["chromadock"]
    roll, pitch, yaw = (keys[f"external_detection_rotation_{a}"] for a in ("roll", "pitch", "yaw"))
    assert (roll, pitch, yaw) == (-1.57, 1.57, 0.0)  # its defaults
    about_x = cv2.Rodrigues(np.array([roll, 0.0, 0.0]))[0]
    about_y = cv2.Rodrigues(np.array([0.0, pitch, 0.0]))[0]
    for pose, nav2 in zip(of(POSE, told["dock"]), of(NAV2, told["dock"]), strict=True):
        R_camera_dock, R_detected = (
            matrix_from_quaternion([q[axis] for axis in "wxyz"])
            for q in (pose["pose"]["pose"]["orientation"], nav2["pose"]["orientation"])
        )
        ahead = (R_detected @ about_y @ about_x)[:, 0]
        assert ahead @ R_camera_dock[:, 2] > 0.9999
        assert nav2["pose"]["position"] == pose["pose"]["pose"]["position"]


def test_without_the_dock_nothing_is_told(told: dict[str, Any]) -> None:
    assert not of(POSE, told["no dock"]) and not of(NAV2, told["no dock"])


def test_a_camera_without_a_calibration_is_refused_in_a_line(told: dict[str, Any]) -> None:
    assert not of(POSE, told["not calibrated"])
    assert any("/front/camera_info: the camera is not calibrated" in line
               for line in complaints(told["not calibrated"]))  # fmt: skip
    assert told["said"].count("the camera is not calibrated") == 1
    assert told["said"].count("results are coming again") == 1


def test_pictures_of_another_size_are_refused(told: dict[str, Any]) -> None:
    assert "the frames are 160x120" in complaints(told["another size"])[-1]


def test_diagnostics_tell_how_it_goes(told: dict[str, Any]) -> None:
    status = of(DIAGNOSTICS, told["dock"])[-1]["status"][0]
    assert (status["level"], status["name"]) == ([1], "chromadock: dock")
    assert status["message"].startswith("tracking, results are late")  # by stamps of long ago
    values = {pair["key"]: pair["value"] for pair in status["values"]}
    assert values["track"] == "tracking" and values["dropped"] == "0"
    assert float(values["rate_hz"]) > 0 and float(values["latency_ms"]) > 1e6


def test_it_ends_when_asked_and_has_said_what_it_left_out(told: dict[str, Any]) -> None:
    assert told["status"] == 0
    assert "Traceback" not in told["said"]
    assert told["said"].count("for want of their messages: /tf, /chromadock/detections") == 1
    assert told["said"].count("stamps went back: the track starts anew") == 1


def test_the_vehicles_file_and_a_file_of_parameters_will_do(dive: Dive, tmp_path: Path) -> None:
    vehicle = tmp_path / "vehicle.toml"
    vehicle.write_text(
        f'[camera]\ncalibration = "{dive.folder / "camera.yaml"}"\n[outputs]\nrecord = "x.mcap"\n'
    )
    level = {"orientation": dict(zip("wxyz", (1.0, 0.0, 0.0, 0.0), strict=True))}
    arguments = [
        *("--ros-args", "--params-file", PARAMETERS, "-p", "image_transport:=compressed"),
        *("-p", "camera_frame:=eye", "-r", "image:=/front/image_raw", "-r", "imu:=/front/imu"),
    ]
    with running(tmp_path, vehicle, *arguments, reliability="BEST_EFFORT") as (node, peer):
        play(peer, dive, compressed=True, imu=level)  # no CameraInfo
        assert {pose["header"]["frame_id"] for pose in of(POSE, peer.heard)} == {"eye"}
        assert "camera.source and outputs are not used here" in node.said
        assert node.end(signal.SIGINT) == 0


def commands() -> list[str]:
    """The node's of the page."""
    blocks = re.findall(r"```\n(.*?)```", PAGE.read_text(), re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines()]
    return [line for line in lines if line.startswith(".venv/bin/chromadock ros ")]


def test_the_commands_of_the_page_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    vehicle = tmp_path / "vehicle.toml"
    assert chromadock(capsys, "config", "init", vehicle).status == 0
    beside = {"vehicle.toml": vehicle, str(PARAMETERS.relative_to(ROOT)): PARAMETERS}
    with contextlib.ExitStack() as stack:
        nodes = []
        for k, command in enumerate(commands()):
            _, _, *words = shlex.split(command)
            (tmp_path / str(k)).mkdir()
            node = Node(tmp_path / str(k), *(beside.get(word, word) for word in words))
            nodes.append(stack.enter_context(node))
        end_s = time.monotonic() + PATIENCE_S
        for node in nodes:
            while "looking for the dock in the pictures on /" not in node.said:
                assert node.process.poll() is None and time.monotonic() < end_s, node.said
                time.sleep(0.05)
        assert [node.end() for node in nodes] == [0, 0, 0]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["-p", "dock.mapping:=nope"], "dock.mapping is 'nope': it must be one of ternary"),
        (["--bogus"], "--ros-args: ['--bogus']: write them as"),
    ],
)
def test_a_slip_in_the_arguments_is_a_line(arguments: list[str], line: str, tmp_path: Path) -> None:
    with Node(tmp_path, "--ros-args", *arguments) as node:
        assert node.process.wait(PATIENCE_S) == 2
    assert node.said.count("chromadock: error: ") == 1 and line in node.said
    assert "Traceback" not in node.said


def test_a_transform_goes_into_rclpys_message(tmp_path: Path) -> None:
    """That of TF is all of TFMessage, whose package is not to be had here."""
    script = """
from geometry_msgs.msg import TransformStamped
from chromadock.results.track import TrackedPose
from chromadock.ros.header import FrameIds
from chromadock.ros.pose import transforms
from chromadock.ros_node.filled import filled
pose = TrackedPose((1.0, 2.0, 3.0), (0.5, 0.5, -0.5, 0.5), (), 1.0)
fields = transforms(pose, 5_000_000_007, FrameIds("eye", "station"))["transforms"][0]
message = filled(TransformStamped, fields)
t, q = message.transform.translation, message.transform.rotation
print(message.header.stamp.sec, message.header.stamp.nanosec, message.header.frame_id,
      message.child_frame_id, t.x, t.y, t.z, q.w, q.x, q.y, q.z)
"""
    environ = environment(tmp_path)
    done = subprocess.run([str(PYTHON), "-c", script], env=environ, capture_output=True, text=True)
    wanted = "5 7 eye station 1.0 2.0 3.0 0.5 0.5 -0.5 0.5\n"
    assert done.stdout == wanted, done.stderr


def test_without_ros_a_line_says_how_to_get_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "rclpy", None)
    done = chromadock(capsys, "ros", "--ros-args", "-r", "image:=/camera/image_raw")
    assert done.status == 2
    assert re.search(r"ROS 2 cannot be loaded \(.*rclpy.*\): source /opt/ros/", done.err)
