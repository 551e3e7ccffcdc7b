"""The parts of the node that need no ROS: settings, cameras, attitudes, what is told and when."""

from __future__ import annotations

import math
import re
import runpy
import sys
import threading
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
import yaml
from filmed_approach import CAMERA, CAMERA_YAML, FPS, frames

from chromadock import CameraModel, Detector, DockGeometry
from chromadock.errors import ChromadockError
from chromadock.mounting import Mounting
from chromadock.ros.fields import Fields
from chromadock.ros.image import camera_info
from chromadock.ros_node import finder as finding
from chromadock.ros_node.calibration import described_camera, description_of
from chromadock.ros_node.finder import Finder, Seen, TopicNames
from chromadock.ros_node.health import GRACE_S, PERIOD_S, SILENCE_S, Health
from chromadock.ros_node.imu import Attitudes
from chromadock.ros_node.inbox import Inbox
from chromadock.ros_node.outputs import KINDS, NAV2_POSE, POSE, TF, outputs
from chromadock.ros_node.parameters import TAKEN, NodeKeys, effective, read_parameters
from chromadock.sources import Frame
from chromadock.track.attitude import Attitude

ROS2 = Path(__file__).resolve().parents[3] / "ros2" / "chromadock_ros"
NAMES = TopicNames("/image", "/camera_info")
S = 10**9


def message(value: Any) -> Any:
    """Fields as an object, as rclpy has them."""
    if isinstance(value, dict):
        return SimpleNamespace(**{name: message(one) for name, one in value.items()})
    return value


def headed(stamp_ns: int, frame_id: str = "eye", **fields: Any) -> Any:
    stamp = {"sec": stamp_ns // S, "nanosec": stamp_ns % S}
    return message({"header": {"stamp": stamp, "frame_id": frame_id}, **fields})


def picture_of(frame: Frame, frame_id: str = "eye", start_s: float = 100.0) -> Any:
    height, width, _ = frame.image.shape
    data = frame.image.tobytes()
    stamp_ns = round((start_s + frame.time_s) * S) if start_s else 0
    return headed(
        stamp_ns, frame_id, height=height, width=width, step=3 * width, encoding="bgr8",
        data=np.frombuffer(data, np.uint8),
    )  # fmt: skip


def info(camera: CameraModel = CAMERA, **changes: Any) -> Any:
    fields: Fields = {**camera_info(camera, 0), **changes}
    return message(fields)


def camera_of_info(**changes: Any) -> CameraModel:
    return described_camera(description_of(info(**changes)), "/camera_info")


def finder_of(told: list[str] | None = None, **given: Any) -> Finder:
    tell = (told if told is not None else []).append
    return Finder(read_parameters(given), NAMES, tell)


def test_the_finder_says_what_the_detector_says() -> None:
    finder, detector = finder_of(), Detector(CAMERA, DockGeometry.default())
    finder.camera_info(info())
    for frame in frames(8):
        seen = finder.picture(picture_of(frame), 0)
        there = detector.process(frame.image, frame.time_s)
        assert seen.detection is not None and seen.detection.track is not None
        assert there.track is not None and seen.detection.track.pose == there.track.pose
        sent = dict(outputs(seen.detection, seen.stamp_ns, seen.ids))
        assert {POSE, NAV2_POSE, TF} & sent.keys() == (
            {POSE, NAV2_POSE, TF} if there.track.state == "tracking" else set()
        )
    header = sent[TF]["transforms"][0]["header"]
    stamp_ns = round((100 + 7 / FPS) * S)
    assert header == {"frame_id": "eye", "stamp": {"sec": stamp_ns // S, "nanosec": stamp_ns % S}}


def test_what_is_only_expected_is_not_told() -> None:
    finder = finder_of()
    finder.camera_info(info())
    pictures = frames(9)
    for frame in pictures[:8]:
        finder.picture(picture_of(frame), 0)
    water = Frame(np.full_like(pictures[0].image, (200, 160, 40)), "", 8, pictures[8].time_s)
    seen = finder.picture(picture_of(water), 0)
    assert seen.detection is not None and seen.detection.track is not None
    assert seen.detection.track.state == "tracking" and seen.detection.track.pose is not None
    assert POSE not in dict(outputs(seen.detection, seen.stamp_ns, seen.ids))


def test_another_camera_info_makes_another_camera_and_the_same_keeps_the_track() -> None:
    finder = finder_of()
    wide = CameraModel(640, 480, CAMERA.matrix * [[0.8, 1, 1], [1, 0.8, 1], [1, 1, 1]])
    distances = []
    for frame in frames(16):
        finder.camera_info(info(wide if frame.index >= 8 else CAMERA))
        detection = finder.picture(picture_of(frame), 0).detection
        assert detection is not None and detection.track is not None
        distances.append(detection.track.pose.t[2] if detection.track.pose else None)
    assert distances[7] and distances[15] and distances[8] is None
    assert distances[15] / distances[7] == pytest.approx(0.8, rel=0.05)


def test_a_wrong_camera_info_stops_results_until_it_is_right() -> None:
    finder, frame = finder_of(), frames(1)[0]
    complaint = finder.picture(picture_of(frame), 0).complaint
    assert complaint is not None and "no CameraInfo on /camera_info yet" in complaint
    finder.camera_info(info())
    assert finder.picture(picture_of(frame), 0).complaint is None
    finder.camera_info(info(k=[0.0] * 9))
    assert "not calibrated" in str(finder.picture(picture_of(frame), 0).complaint)
    finder.camera_info(info())
    assert finder.picture(picture_of(frame), 0).complaint is None


def test_a_camera_info_is_looked_at_again_only_where_it_says_something_else(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    looked_at: list[str] = []

    def described(description: Any, topic: str) -> CameraModel:
        looked_at.append(description["distortion_model"])
        return described_camera(description, topic)

    monkeypatch.setattr(finding, "described_camera", described)
    finder, frame = finder_of(), frames(1)[0]
    for lens, complaint in (
        ("plumb_bob", "None"),
        ("kannala", "kannala is not"),
        ("plumb_bob", "None"),
    ):
        for second in range(3):
            message = info(distortion_model=lens)
            message.header.stamp.sec = second
            finder.camera_info(message)
            assert complaint in str(finder.picture(picture_of(frame), 0).complaint)
    assert looked_at == ["plumb_bob", "kannala", "plumb_bob"]


def test_a_calibration_file_needs_no_camera_info(tmp_path: Path) -> None:
    (tmp_path / "cam.yaml").write_text(CAMERA_YAML)
    finder = finder_of(**{"camera.calibration": str(tmp_path / "cam.yaml")})
    assert finder.picture(picture_of(frames(1)[0]), 0).detection is not None


def test_pictures_without_stamp_or_frame_have_those_that_are_told_once() -> None:
    told: list[str] = []
    finder = finder_of(told)
    finder.camera_info(info())
    for frame in frames(2):
        seen = finder.picture(picture_of(frame, "", 0.0), 7 * S + frame.index)
        assert (seen.stamp_ns, seen.ids.camera) == (7 * S + frame.index, "camera_optical_frame")
    assert ["no stamps" in line for line in told] == [True, False]
    assert ["no frame_id" in line for line in told] == [False, True]


def test_the_camera_is_that_of_region_binning_and_lens() -> None:
    roi = message({"x_offset": 160, "y_offset": 80, "width": 320, "height": 240})
    fisheye = {"distortion_model": "equidistant", "d": [0.1, 0.01, 0.0, 0.0]}
    camera = camera_of_info(roi=roi, binning_x=2, binning_y=2, **fisheye)
    assert (camera.width, camera.height, camera.lens) == (160, 120, "equidistant")
    # The middle of the binned pixel is that of four: (319.5 - 160 + 0.5) / 2 - 0.5.
    assert camera.matrix[0].tolist() == pytest.approx([256, 0, 79.5])
    assert camera.matrix[1].tolist() == pytest.approx([0, 255, 79.5])


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"k": [0.0] * 9}, "/camera_info: the camera is not calibrated"),
        ({"width": 0}, "/camera_info: width is 0"),
        ({"distortion_model": "kannala", "d": [0.0] * 4}, "distortion_model kannala is not"),
        ({"d": [0.1] * 3}, "distortion_coefficients has 3 numbers"),
        ({"k": [math.nan] * 9}, "must be a finite number"),
        ({"k": [4.0, 0, 319.5, 0, 4.0, 239.5, 0, 0, 1]}, "far too short for 640x480"),
    ],
)
def test_a_camera_info_that_is_none_is_refused_in_a_line(
    changes: dict[str, Any], line: str
) -> None:
    with pytest.raises(ChromadockError, match=re.escape(line)):
        camera_of_info(**changes)


def imu(stamp_s: float, q_xyzw: tuple[float, ...], known: float = 0.0) -> Any:
    zero = {"x": 0.0, "y": 0.0, "z": 0.0}
    return headed(
        round(stamp_s * S),
        orientation=dict(zip("xyzw", q_xyzw, strict=True)),
        orientation_covariance=[known] + [0.0] * 8,
        angular_velocity=zero,
        angular_velocity_covariance=[0.0] * 9,
    )


def test_an_imus_orientation_is_the_attitude_of_aircraft() -> None:
    """By REP 103: x forward, y left, z up, in east, north, up."""
    half = math.radians(10) / 2
    for q_xyzw, wanted in (
        ((0.0, 0.0, 0.0, 1.0), (0, 0, 90)),  # x to the east
        ((math.sin(half), 0.0, 0.0, math.cos(half)), (10, 0, 90)),  # its right side down
        ((0.0, math.sin(half), 0.0, math.cos(half)), (0, -10, 90)),  # its nose down
        ((0.0, 0.0, math.sin(half), math.cos(half)), (0, 0, 80)),  # to the north of east
    ):
        attitudes = Attitudes()
        attitudes.heard(imu(50.0, q_xyzw))
        found = attitudes.at(round(50.05 * S))
        assert found is not None and found.yaw_rad is not None
        angles = np.degrees([found.roll_rad, found.pitch_rad, found.yaw_rad])
        assert angles.tolist() == pytest.approx(list(wanted), abs=1e-9)


def test_orientations_that_are_none_or_of_another_time_tell_nothing() -> None:
    attitudes = Attitudes()
    attitudes.heard(imu(50.0, (0.0, 0.0, 0.0, 1.0), known=-1.0))
    attitudes.heard(imu(50.0, (0.0, 0.0, 0.0, 0.0)))
    assert attitudes.at(50 * S) is None
    attitudes.heard(imu(50.0, (0.0, 0.0, 0.0, 1.0)))
    assert attitudes.at(50 * S) is not None and attitudes.at(52 * S) is None
    attitudes.heard(imu(10.0, (0.0, 0.0, 0.0, 1.0)))  # a bag that is looped
    assert attitudes.at(10 * S) is not None and attitudes.at(50 * S) is None


def test_the_detector_is_told_the_attitude_and_the_mounting() -> None:
    finder = finder_of(**{"mounting.pitch_deg": 0})
    finder.camera_info(info())
    told, untold = (Detector(CAMERA, DockGeometry.default(), mounting=Mounting()) for _ in range(2))
    half = math.radians(4) / 2
    for frame in frames(6):
        finder.orientation(imu(100 + frame.time_s, (math.sin(half), 0.0, 0.0, math.cos(half))))
        seen = finder.picture(picture_of(frame), 0).detection
        attitude = Attitude(math.radians(4), 0.0, math.radians(90))
        with_it = told.process(frame.image, frame.time_s, attitude)
        without = untold.process(frame.image, frame.time_s)
    poses = [one.track.pose for one in (seen, with_it, without) if one and one.track]
    covariances = [np.array(pose.covariance) for pose in poses if pose]
    assert np.allclose(covariances[0], covariances[1], rtol=1e-6)
    assert not np.allclose(covariances[0], covariances[2], rtol=1e-3)


def test_the_newest_picture_wins_and_those_before_it_are_counted() -> None:
    inbox = Inbox()
    for k in range(3):
        inbox.picture(k)
        inbox.orientation(k)
    arrived = inbox.take(0.0)
    assert (arrived.picture, arrived.orientations, inbox.dropped) == (2, (0, 1, 2), 2)
    assert inbox.take(0.0).picture is None
    threading.Timer(0.05, inbox.picture, (3,)).start()
    assert inbox.take(20.0).picture == 3
    inbox.fail(OSError("gone"))
    with pytest.raises(OSError, match="gone"):
        inbox.take(0.0)


def status(fields: Fields | None) -> tuple[int, str] | None:
    if fields is None:
        return None
    one = fields["status"][0]
    return one["level"], one["message"]


def test_diagnostics_come_each_second_and_at_each_change() -> None:
    logged: list[str] = []
    finder, frame = finder_of(), frames(1)[0]
    health = Health("/image", logged.append, 0.0)
    assert status(health.told(0, S, 0.0)) == (0, "no pictures yet")
    assert health.told(0, S, 0.1) is None
    bad = finder.picture(picture_of(frame), 0)
    health.seen(bad, 0.01, 0.2)
    assert status(health.told(0, S, 0.2)) == (2, bad.complaint)
    assert health.told(0, S, 0.2 + PERIOD_S - 0.01) is None and not logged
    assert health.told(0, S, 0.2 + PERIOD_S) is not None and logged == [bad.complaint]
    finder.camera_info(info())
    for k in range(5):
        health.seen(finder.picture(picture_of(frame), 0), 0.01, 1.5 + 0.1 * k)
    told = health.told(3, S, 1.9)
    assert status(told) == (0, "acquiring") and logged[1:] == ["results are coming again"]
    values = {pair["key"]: pair["value"] for pair in told["status"][0]["values"]} if told else {}
    assert (values["rate_hz"], values["dropped"], values["latency_ms"]) == ("10.0", "3", "10.0")
    silent = health.told(3, S, 1.9 + SILENCE_S + 0.1)
    assert status(silent) == (2, "no pictures on /image: start the camera's driver, or remap image "
                                 "to it")  # fmt: skip


def test_a_complaint_of_a_moment_is_not_logged() -> None:
    logged: list[str] = []
    health = Health("/image", logged.append, 0.0)
    ids = finder_of().picture(picture_of(frames(1)[0]), 0).ids
    for now_s, complaint in ((0.0, "x"), (GRACE_S / 2, None), (GRACE_S, "x"), (1.9 * GRACE_S, "x")):
        health.seen(Seen(S, ids, complaint=complaint), 0.0, now_s)
        health.told(0, S, now_s)
    assert not logged


def test_parameters_go_before_the_vehicles_file(tmp_path: Path) -> None:
    vehicle = tmp_path / "vehicle.toml"
    vehicle.write_text('[dock]\nmapping = "contrast"\ncolour = "#00FF00"\n')
    given = {"dock.colour": "white", "mounting.pitch_deg": -20, "use_sim_time": True}
    settings = read_parameters(given, vehicle)
    assert (settings.vehicle.dock.mapping, settings.vehicle.dock.colour) == ("contrast", "white")
    values = effective(settings)
    assert values["mounting.pitch_deg"] == -20.0 and values["vehicle"] == str(vehicle)
    assert "mounting.pitch_deg" not in effective(read_parameters({"vehicle": str(vehicle)}))


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"dock.colr": "white"}, "parameter dock.colr: there is none of that name: choose from "),
        ({"camera.source": "0"}, "parameter camera.source: there is none of that name"),
        ({"publish_tf": "yes"}, "parameters: publish_tf is 'yes': it must be true or false"),
        ({"mounting.pitch_deg": 200.0}, "mounting.pitch_deg is 200.0: it must be -180 to 180"),
    ],
)
def test_a_slip_in_a_parameter_is_a_line(given: dict[str, Any], line: str) -> None:
    with pytest.raises(ChromadockError, match=re.escape(line)):
        read_parameters(given)


@pytest.mark.parametrize("keys", ["independent = true", 'method = "paper"'])
def test_a_vehicle_without_a_track_is_refused(keys: str, tmp_path: Path) -> None:
    (tmp_path / "v.toml").write_text(f"[detector]\n{keys}\n")
    with pytest.raises(ChromadockError, match="only the poses of a track are told to ROS"):
        read_parameters({}, tmp_path / "v.toml")


def test_the_file_of_parameters_has_each_at_its_default() -> None:
    text = (ROS2 / "config" / "chromadock.yaml").read_text()
    text = re.sub(r"(?m)^    # (?=( *)\w+:( |$)(?!vehicle))", "    ", text)
    content = yaml.safe_load(text)["chromadock"]["ros__parameters"]
    flat = {}
    for name, value in content.items():
        if isinstance(value, dict):
            flat.update({f"{name}.{key}": one for key, one in value.items()})
        else:
            flat[name] = value
    defaults = effective(read_parameters({"mounting.yaw_deg": 0.0}))
    assert flat == {name: v for name, v in defaults.items() if name != "vehicle"}


def test_the_page_names_every_topic_and_parameter_with_its_type_or_default() -> None:
    page = (ROS2.parents[1] / "docs" / "ros.md").read_text()
    for topic, kind in KINDS.items():
        assert f"| `{topic}` | {kind.replace('/msg/', '/')} |" in page
    for name, field in NodeKeys.model_fields.items():
        default = f"`{str(field.default).lower()}`" if field.default else "[^`]*"
        assert re.search(rf"\| `{name}` \| ?{default} ?\|", page), name
    for table in TAKEN:
        assert f"`{table}." in page


def test_the_launch_file_starts_the_command_with_its_arguments(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """ROS's launch is not to be had from PyPI: here its classes only keep what they are given."""

    class Kept(SimpleNamespace):
        def __init__(self, *given: Any, **named: Any) -> None:
            super().__init__(given=given, **named)

    for name, classes in {
        "launch": ["LaunchDescription"],
        "launch.actions": ["DeclareLaunchArgument"],
        "launch.substitutions": ["LaunchConfiguration", "PathJoinSubstitution"],
        "launch_ros": [],
        "launch_ros.actions": ["Node"],
        "launch_ros.substitutions": ["FindPackageShare"],
    }.items():
        module = ModuleType(name)
        for one in classes:
            setattr(module, one, type(one, (Kept,), {}))
        monkeypatch.setitem(sys.modules, name, module)
    launched = runpy.run_path(str(ROS2 / "launch" / "chromadock.launch.py"))
    *arguments, node = launched["generate_launch_description"]().given[0]
    assert (node.executable, node.arguments, node.name) == ("chromadock", ["ros"], "chromadock")
    declared = {argument.given[0]: argument.default_value for argument in arguments}
    used = [node.parameters[0], node.parameters[1]["vehicle"], *(to for _, to in node.remappings)]
    assert {one.given[0] for one in used} == declared.keys()
    share, *parts = declared["params"].given[0]
    assert share.given == (ROS2.name,) and (ROS2 / Path(*parts)).is_file()
    assert {"vehicle": ""}.items() <= declared.items()
    read_parameters({"vehicle": declared["vehicle"]})
    for topic, to in node.remappings:
        assert declared[to.given[0]] == topic
