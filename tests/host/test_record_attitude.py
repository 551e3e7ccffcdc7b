"""The vehicle's attitude in a recording: in ROS's axes, and for a replay as the run had it."""

from __future__ import annotations

import itertools
import json
import math
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from autopilot_peer import free_port, udp_peer
from filmed_approach import CAMERA, CAMERA_YAML, detected, frames, picture
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import common as mavlink
from simulation import chromadock
from web_camera import web_camera

from chromadock import Attitude, Detection, Detector, DockGeometry
from chromadock.errors import ChromadockError
from chromadock.output.recording import Recording
from chromadock.output.results import result_record
from chromadock.replay.recorded import read_recorded
from chromadock.ros.attitude import attitude_from_imu, imu
from chromadock.ros.image import compressed_image
from chromadock.sources import open_source

TURNS = st.floats(-math.pi, math.pi)
TOLD = Attitude(0.1, -0.2, 0.3)


def as_message(fields: Any) -> Any:
    """Attributes, as readers of messages have them."""
    if isinstance(fields, dict):
        return SimpleNamespace(**{name: as_message(value) for name, value in fields.items()})
    return fields


@given(TURNS, st.floats(-1.5, 1.5), st.none() | TURNS)
def test_what_was_written_is_read(roll: float, pitch: float, yaw: float | None) -> None:
    told = Attitude(roll, pitch, yaw)
    read = attitude_from_imu(as_message(imu(told, 0)))
    assert (read.yaw_rad is None) == (yaw is None)
    assert read.R_world_body == pytest.approx(told.R_world_body, abs=1e-12)


@pytest.mark.parametrize(
    ("told", "axis", "turn_deg"),
    [
        (Attitude(0.0, 0.0, math.radians(90)), (0, 0, 1), 0.0),  # to the east, ROS's x
        (Attitude(0.0, 0.0, 0.0), (0, 0, 1), 90.0),  # to the north
        (Attitude(0.0, math.radians(20), math.radians(90)), (0, 1, 0), -20.0),  # bow up
        (Attitude(math.radians(20), 0.0, math.radians(90)), (1, 0, 0), 20.0),  # right side down
    ],
)
def test_the_axes_are_those_of_ros(
    told: Attitude, axis: tuple[float, float, float], turn_deg: float
) -> None:
    """REP 103: x forward, y left, z up, against east, north, up; counted by the right hand."""
    q, half = imu(told, 0)["orientation"], math.radians(turn_deg) / 2
    expected = (math.cos(half), *(math.sin(half) * np.array(axis)).tolist())
    assert (q["w"], q["x"], q["y"], q["z"]) == pytest.approx(expected, abs=1e-12)


def test_what_was_not_measured_says_so() -> None:
    """As sensor_msgs/Imu wants it: -1 first in the covariance."""
    fields = imu(Attitude(0.0, 0.0), 5)
    assert fields["angular_velocity_covariance"][0] == -1
    assert fields["linear_acceleration_covariance"][0] == -1
    assert fields["orientation_covariance"][8] > 3  # (radians squared) of any yaw
    assert fields["header"]["frame_id"] == "base_link"


def test_a_frame_of_a_recording_has_the_attitude_that_it_was_looked_at_with(
    tmp_path: Path,
) -> None:
    pictures = frames(4)
    told = [None, TOLD, replace(TOLD, yaw_rad=None), None]
    with Recording(tmp_path / "dive.mcap") as recording:
        for frame, detection, attitude in zip(pictures, detected(pictures), told, strict=True):
            recording.write(replace(frame, attitude=attitude), detection, None)
    with open_source(str(tmp_path / "dive.mcap")) as source:
        read = [frame.attitude for frame in source]
    assert [attitude is None for attitude in read] == [True, False, False, True]
    assert read[1] is not None and read[2] is not None and read[2].yaw_rad is None
    assert (read[1].roll_rad, read[1].pitch_rad, read[1].yaw_rad) == pytest.approx((0.1, -0.2, 0.3))


def test_an_attitude_that_is_none_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As another program may leave it: no orientation at all."""
    nothing = {"orientation": dict.fromkeys("xyzw", 0.0)}
    monkeypatch.setattr("chromadock.ros.topics.imu", lambda *told: imu(*told) | nothing)
    frame = frames(1)[0]
    with Recording(tmp_path / "dive.mcap") as recording:
        recording.write(replace(frame, attitude=TOLD), detected([frame])[0], None)
    with (
        open_source(str(tmp_path / "dive.mcap")) as source,
        pytest.raises(ChromadockError, match=r"dive\.mcap: /chromadock/attitude: quaternion"),
    ):
        list(source)


def test_a_line_has_the_attitude_and_is_read_with_it_or_without() -> None:
    frame = frames(1)[0]
    detection = detected([frame])[0]
    without = result_record(frame, detection, None)
    line = result_record(replace(frame, attitude=TOLD), detection, None)
    assert line["attitude"] == {"roll_rad": 0.1, "pitch_rad": -0.2, "yaw_rad": 0.3}
    assert {**line, "attitude": None} == {**without, "attitude": None}
    assert "attitude" not in without and without["schema"] == line["schema"] == 1
    assert Detection.from_dict(line) == Detection.from_dict(without)


PERIOD_S = 5.0
PICTURES = 50


def roll_rad(time_s: float) -> float:
    """On its side, by turns of 10 degrees to and fro: so no dock is looked for by itself."""
    return math.radians(90 + 10 * math.sin(2 * math.pi * time_s / PERIOD_S))


@pytest.fixture(scope="module")
def dive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of a vehicle that lies on its side, whose autopilot says so; see ``roll_rad``.

    Its camera codes pictures as the recording does, so that coding them again loses next to
    nothing: a lamp that two smoothings locate equally well would be elsewhere by half a pixel.
    """
    folder = tmp_path_factory.mktemp("dive")
    jpegs = [
        compressed_image(picture(2.0, k, roll_rad(k / PICTURES * PERIOD_S)), 0)["data"]
        for k in range(PICTURES)
    ]
    port = free_port()
    with web_camera(
        lambda: jpegs[round(time.monotonic() / PERIOD_S * PICTURES) % PICTURES]
    ) as address:
        (folder / "cam.yaml").write_text(CAMERA_YAML)
        (folder / "v.toml").write_text(
            f'[camera]\nsource = "{address}"\ncalibration = "cam.yaml"\n[outputs]\n'
            f'record = "dive.mcap"\n'
            f'results = ["mavlink:udpin:127.0.0.1:{port}?receiver=ardupilot-rover"]\n'
        )
        peer, end = udp_peer(port, mavlink.MAV_TYPE_SURFACE_BOAT)
        command = [sys.executable, "-m", "chromadock", "run", "v.toml"]
        with (
            end,
            subprocess.Popen(
                command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
            ) as run,
        ):

            def told(count: int) -> bool:
                peer.roll = roll_rad(time.monotonic())
                return len(peer.named("LANDING_TARGET")) > count

            peer.until(lambda: told(30))
            run.send_signal(signal.SIGINT)
            peer.until(lambda: told(0) and run.poll() is not None)
            assert run.stderr is not None and "Traceback" not in run.stderr.read()
    return folder / "dive.mcap"


def test_a_replay_has_the_attitudes_of_the_run_and_says_the_same(
    dive: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    done = chromadock(capsys, "replay", dive, "--out", tmp_path, "--json")
    assert done.status == 0, done.err
    told = json.loads(done.out)
    assert told["old"]["found"] > 25 and told["old"]["locked"] > 25
    assert (told["not_recorded"], told["state_differs"]) == (0, 0)
    assert told["only_old_locked"] == told["only_new_locked"] == 0
    assert told["place_m"]["median"] < 0.0005
    assert told["place_m"]["largest"] < 0.002  # 0.1 % of 2 m, as JPEG loses
    assert told["attitude_deg"]["largest"] < 0.5
    lines = [json.loads(line) for line in (tmp_path / "frames.jsonl").open()]
    known = [line for line in lines if "attitude" in line]
    assert len(known) >= told["old"]["found"]
    # The picture itself tells the roll: by so much the dock is turned in it.
    off_deg = [
        math.degrees(line["attitude"]["roll_rad"] + 2 * math.atan2(q[3], q[0]))
        for line in known
        if line["pose"] is not None
        for q in [line["pose"]["q_wxyz"]]
    ]
    assert np.median(np.abs(off_deg)) < 1.5


def test_detect_has_them_too_and_without_them_nothing_is_found(dive: Path) -> None:
    recorded = read_recorded(dive, {}).results
    told, alone = (Detector(CAMERA, DockGeometry.default()) for _ in range(2))
    with open_source(str(dive)) as source:
        taken = list(itertools.islice(source, 40))
    for frame in taken:
        before = recorded.at(frame.time_s)
        assert before is not None
        state = told.process(frame.image, frame.time_s, frame.attitude).state
        assert state == before.detection.state
        assert not alone.process(frame.image, frame.time_s).found
