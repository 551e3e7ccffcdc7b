"""What each receiver accepts, rejects and understands: a table, each row with its source.

Read from the sources named, not run on an autopilot.
"""

from __future__ import annotations

import math
from typing import Any

import pytest
from autopilot_truth import AHEAD, BEHIND, pose_at, tracked
from pymavlink.dialects.v20 import common as mavlink

from chromadock import Attitude
from chromadock.autopilot.dry_run import dry_run
from chromadock.autopilot.receivers import RECEIVERS
from chromadock.autopilot.settings import AutopilotSettings
from chromadock.autopilot.understood import understood
from chromadock.autopilot.wire import decoded

HANDLE = "AC_PrecLand_MAVLink.cpp (2b30683d) handle_msg"
PRECLAND = "AC_PrecLand.cpp (01c6d5da)"
SUB = "ArduSub/GCS_MAVLink_Sub.h (04dc0b71): no handle_landing_target"
PX4_TARGET = "PX4 mavlink_receiver.cpp handle_message_landing_target, PX4-Autopilot#17354"
PX4_ODOMETRY = "PX4 mavlink_receiver.cpp handle_message_odometry"
VISO = "AP_VisualOdom_MAV.cpp handle_pose_estimate, GCS_Common.cpp"
ODOMETRY = "GCS_Common.cpp handle_odometry"

FRD, LOCAL_FRD, NED = 12, 20, 1
ROVER, COPTER, BLUEROV = "ardupilot-rover", "ardupilot-copter", "ardusub"
LIDAR = mavlink.MAV_ESTIMATOR_TYPE_LIDAR
NAN = math.nan


def target(x: float, y: float, z: float, **changes: Any) -> Any:
    fields: dict[str, Any] = {
        "time_usec": 1, "target_num": 0, "frame": FRD, "angle_x": 0.0, "angle_y": 0.0,
        "distance": math.hypot(x, y, z), "size_x": 0.0, "size_y": 0.0, "x": x, "y": y, "z": z,
        "q": (1.0, 0.0, 0.0, 0.0), "type": 3, "position_valid": 1,
    }  # fmt: skip
    return mavlink.MAVLink_landing_target_message(**{**fields, **changes})


def vision(x: float, y: float, z: float, *variances: float) -> Any:
    covariance = [0.0] * 21
    for k, variance in zip((0, 6, 11), variances, strict=True):
        covariance[k] = variance
    return mavlink.MAVLink_vision_position_estimate_message(1, x, y, z, 0, 0, 0, covariance, 0)


def odometry(frame: int, child: int, estimator: int = mavlink.MAV_ESTIMATOR_TYPE_VISION) -> Any:
    return mavlink.MAVLink_odometry_message(
        1, frame, child, -4.0, -0.5, -0.2, (1.0, 0.0, 0.0, 0.0), NAN, NAN, NAN, NAN, NAN, NAN,
        [0.04 if k in (0, 6, 11) else 0.0 for k in range(21)], [NAN] * 21, 0, estimator, 100,
    )  # fmt: skip


TABLE = [
    # Receiver, PLND_ORIENT, message, what is understood, where that is written.
    (ROVER, 0, target(-0.2, 0.5, 4), "4.0 m ahead, 0.5 m right, 0.2 m below", PRECLAND),
    (ROVER, 0, target(4, 0.5, 0.2), "0.2 m ahead, 0.5 m right, 4.0 m above", PRECLAND),
    (ROVER, 0, target(2, -0.3, -0.4), "dropped without a word", PRECLAND),
    (ROVER, 0, target(10, 0, 0), "dropped without a word", PRECLAND),
    (ROVER, 4, target(-0.2, 0.5, 4), "4.0 m behind, 0.5 m left, 0.2 m below", PRECLAND),
    (ROVER, 25, target(0.3, 0.2, 5), "0.3 m ahead, 0.2 m right, 5.0 m below", PRECLAND),
    (ROVER, 0, target(-0.2, 0.5, 4, frame=NED), "Frame not supported", HANDLE),
    (ROVER, 0, target(-0.2, 0.5, 4, frame=8), "Frame not supported", HANDLE),
    (ROVER, 0, target(-0.2, 0.5, 4, distance=0.0), "distance", HANDLE),
    (ROVER, 0, target(-0.2, 0.5, 4, distance=NAN), "distance", HANDLE),
    # Not the angles of the place: they are what counts where it is not valid, 2 or 255 neither.
    (ROVER, 0, target(0, 1, 4, position_valid=0), "dock 4.1 m ahead", HANDLE),
    (ROVER, 0, target(0, 1, 4, position_valid=2), "dock 4.1 m ahead", HANDLE),
    (ROVER, 0, target(0, 0, 0, position_valid=0), "rangefinder", PRECLAND),
    (COPTER, None, target(0.3, 0.2, 5), "0.3 m ahead, 0.2 m right, 5.0 m below", PRECLAND),
    (COPTER, None, target(4, 0.5, -0.2), "dropped without a word", PRECLAND),
    (BLUEROV, None, target(-0.2, 0.5, 4), "ardusub ignores LANDING_TARGET", SUB),
    (
        "px4",
        None,
        target(9.5, 7, 1.2, frame=NED),
        "9.5 m north, 7.0 m east, 1.2 m below",
        PX4_TARGET,
    ),
    ("px4", None, target(4, 0.5, 0.2), "coordinate frame 12 unsupported", PX4_TARGET),
    ("px4", None, target(4, 0.5, 0.2, position_valid=0), "IR-LOCK", PX4_TARGET),
    (
        BLUEROV,
        None,
        vision(-4, -0.5, 0.2, 0, 0, 0),
        "4.0 m south, 0.5 m west, 0.2 m below; to 0.20",
        VISO,
    ),
    (BLUEROV, None, vision(-4, -0.5, -0.2, 0.04, 0.04, 0.01), "to 0.30 m", VISO),
    (BLUEROV, None, vision(-4, -0.5, -0.2, NAN, 0.04, 0.01), "to 0.20 m", VISO),
    (BLUEROV, None, vision(-4, -0.5, -0.2, 0.04, NAN, 0.01), "not a number", VISO),
    (BLUEROV, None, vision(-4, 0, 0, 1e6, 0.0, 0.0), "to 100.00 m", VISO),
    ("px4", None, vision(-4, -0.5, -0.2, 0.04, 0.01, 0.01), "to 0.20 m", PX4_ODOMETRY),
    (BLUEROV, None, odometry(LOCAL_FRD, FRD), "4.0 m south", ODOMETRY),
    (BLUEROV, None, odometry(NED, FRD), "dropped without a word", ODOMETRY),
    (BLUEROV, None, odometry(LOCAL_FRD, 8), "dropped without a word", ODOMETRY),
    (
        "px4",
        None,
        odometry(NED, FRD),
        "4.0 m south, 0.5 m west, 0.2 m above; to 0.20",
        PX4_ODOMETRY,
    ),
    ("px4", None, odometry(LOCAL_FRD, FRD), "4.0 m south", PX4_ODOMETRY),
    ("px4", None, odometry(FRD, FRD), "frame 12", PX4_ODOMETRY),
    ("px4", None, odometry(NED, FRD, LIDAR), "unsupported", PX4_ODOMETRY),
]

DROPPED = ("dropped", "ignores", "rangefinder", "IR-LOCK", "not a number", "frame 12", "distance")
DROPPED += ("Frame not supported", "unsupported")


@pytest.mark.parametrize(("receiver", "orient", "message", "words", "source"), TABLE)
def test_a_receiver_makes_of_a_message_what_its_source_says(
    receiver: str, orient: int | None, message: Any, words: str, source: str
) -> None:
    taken = understood(RECEIVERS[receiver], decoded(message), orient)
    assert words in taken.words, source
    assert taken.taken != any(word in words for word in DROPPED), source


def lines(receiver: str, mounting: Any = AHEAD, body: Any = (4.0, 0.5, 0.2), **known: Any) -> Any:
    settings = AutopilotSettings.parse(f"mavlink:udpin:0.0.0.0:14555?receiver={receiver}")
    return dry_run(settings, 1.0, tracked(1.0, pose_at(body, mounting)), mounting, **known)


def test_a_dry_run_says_in_words_what_the_autopilot_will_believe() -> None:
    east = Attitude(0.0, 0.0, math.pi / 2)
    assert lines("ardupilot-rover") == [
        "LANDING_TARGET: dock 4.0 m ahead, 0.5 m right, 0.2 m below"
    ]
    assert lines("ardusub", attitude=east) == [
        "VISION_POSITION_ESTIMATE: vehicle, from the dock: 0.5 m north, 4.0 m west, 0.2 m above; "
        "to 0.20 m"
    ]
    assert lines("px4", attitude=east, position=(10.0, 3.0, 1.0))[0] == (
        "LANDING_TARGET: dock, from the local origin: 9.5 m north, 7.0 m east, 1.2 m below"
    )
    assert lines("ardupilot-rover", BEHIND, (-3.0, 0.4, 0.0)) == [
        "LANDING_TARGET: dock 3.0 m behind, 0.4 m right"
    ]


def test_a_dry_run_names_what_is_not_sent_for_want_of_an_attitude() -> None:
    missing = "not sent, for want of the vehicle's ATTITUDE"
    assert lines("ardusub") == [f"VISION_POSITION_ESTIMATE: {missing}"]
    assert lines("px4") == [f"ODOMETRY: {missing}", f"LANDING_TARGET: {missing}"]
    assert lines("ardusub", attitude=Attitude(0.0, 0.0)) == lines("ardusub")


def test_a_dry_run_reads_the_message_and_not_the_pose() -> None:
    """Of a pose at the camera itself there would be words; the message is dropped."""
    assert lines("ardupilot-copter", body=(0.0, 0.0, 0.0)) == [
        "LANDING_TARGET: dropped without a word: the distance is not more than 0"
    ]
    assert lines("ardupilot-copter") == [
        "LANDING_TARGET: dock 4.0 m ahead, 0.5 m right, 0.2 m below"
    ]
