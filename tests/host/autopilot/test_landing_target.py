"""LANDING_TARGET: what is sent to each receiver, and what that makes of it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from autopilot_truth import AHEAD, BEHIND, BELOW, pose_at, tracked, turned
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v10 import common as mavlink1
from pymavlink.dialects.v20 import common as mavlink
from track_truth import CAMERA, DOCK, approach, found

from chromadock import Attitude, Mounting, Track, Tracker
from chromadock.autopilot.frame_messages import frame_messages
from chromadock.autopilot.landing_target import BACK, DOWN, FORWARD, landing_target, plnd_orient
from chromadock.autopilot.receivers import COPTER, PX4, ROVER, SUB
from chromadock.autopilot.understood import understood
from chromadock.autopilot.wire import decoded

GOLDEN = [
    # Dock in true FRD; sent x, y, z; distance; angle_x, angle_y; what true FRD would be read as.
    ((4.0, 0.5, 0.2), (-0.2, 0.5, 4.0), 4.0361, (0.1244, 0.0500), (0.2, 0.5, -4.0)),
    ((2.0, -0.3, -0.4), (0.4, -0.3, 2.0), 2.0616, (-0.1489, -0.1974), None),
    ((10.0, 0.0, 0.0), (0.0, 0.0, 10.0), 10.0, (0.0, 0.0), None),
]
"""For a Rover with PLND_ORIENT 0, by hand from AC_PrecLand.cpp and AP_Math/vector3.cpp."""

coordinate = st.floats(-6, 6)


def xyz(message: Any) -> tuple[float, float, float]:
    return message.x, message.y, message.z


def raw(x: float, y: float, z: float, **changes: Any) -> Any:
    """A message as somebody else may send it, after the wire."""
    fields: dict[str, Any] = {
        "time_usec": 1, "target_num": 0, "frame": mavlink.MAV_FRAME_BODY_FRD, "angle_x": 0.0,
        "angle_y": 0.0, "distance": math.hypot(x, y, z), "size_x": 0.0, "size_y": 0.0,
        "x": x, "y": y, "z": z, "q": (1.0, 0.0, 0.0, 0.0), "type": 3, "position_valid": 1,
    }  # fmt: skip
    return decoded(mavlink.MAVLink_landing_target_message(**{**fields, **changes}))


@pytest.mark.parametrize(("body", "sent", "distance", "angles", "_misread"), GOLDEN)
def test_a_rover_is_told_the_vector_of_a_camera_that_looks_down(
    body: Any, sent: Any, distance: float, angles: Any, _misread: Any
) -> None:
    message = decoded(landing_target(ROVER, 12.5, pose_at(body), AHEAD))
    assert xyz(message) == pytest.approx(sent, abs=1e-6)
    assert message.distance == pytest.approx(distance, abs=1e-4)
    assert (message.angle_x, message.angle_y) == pytest.approx(angles, abs=1e-4)
    assert (message.frame, message.position_valid) == (mavlink.MAV_FRAME_BODY_FRD, 1)
    assert message.time_usec == 12_500_000
    taken = understood(ROVER, message)
    assert taken.place == pytest.approx(body, abs=1e-5)


@pytest.mark.parametrize(("body", "_sent", "_distance", "_angles", "misread"), GOLDEN)
def test_a_rover_misreads_or_drops_true_forward_right_down(
    body: Any, _sent: Any, _distance: float, _angles: Any, misread: Any
) -> None:
    taken = understood(ROVER, raw(*body))
    if misread is None:
        assert not taken.taken and "dropped without a word" in taken.words
    else:
        assert taken.place == pytest.approx(misread, abs=1e-5)


def test_of_a_level_camera_ahead_a_rover_is_told_minus_y_x_z() -> None:
    pose = pose_at((4.0, 0.5, 0.2))
    x, y, z = pose.t
    assert xyz(landing_target(ROVER, 0.0, pose, AHEAD)) == pytest.approx((-y, x, z))


def test_a_camera_behind_needs_plnd_orient_4_and_its_own_vector() -> None:
    body = (-3.0, 0.4, 0.1)
    message = decoded(landing_target(ROVER, 0.0, pose_at(body, BEHIND), BEHIND))
    assert plnd_orient(ROVER, BEHIND) == BACK
    assert xyz(message) == pytest.approx((-0.1, -0.4, 3.0), abs=1e-6)
    assert understood(ROVER, message, BACK).place == pytest.approx(body, abs=1e-5)
    # With the default it would be looked for ahead, mirrored.
    assert understood(ROVER, message, FORWARD).place == pytest.approx((3.0, -0.4, 0.1), abs=1e-5)


def test_a_copter_is_told_true_forward_right_down() -> None:
    body = (0.3, -0.2, 5.0)
    message = decoded(landing_target(COPTER, 0.0, pose_at(body, BELOW), BELOW))
    assert plnd_orient(COPTER, BELOW) == plnd_orient(COPTER, AHEAD) == DOWN
    assert xyz(message) == pytest.approx(body, abs=1e-6)
    assert understood(COPTER, message).place == pytest.approx(body, abs=1e-5)


def test_px4_is_told_where_the_dock_is_on_earth() -> None:
    # Faces east: ahead is east, right is south.
    east = Attitude(0.0, 0.0, math.pi / 2)
    pose = pose_at((4.0, 0.5, 0.2))
    message = decoded(landing_target(PX4, 0.0, pose, AHEAD, east, (10.0, 3.0, 1.0)))
    assert message.frame == mavlink.MAV_FRAME_LOCAL_NED
    assert xyz(message) == pytest.approx((9.5, 7.0, 1.2), abs=1e-5)
    assert understood(PX4, message).place == pytest.approx((9.5, 7.0, 1.2), abs=1e-5)


@pytest.mark.parametrize(
    ("attitude", "position"),
    [
        (None, (0.0, 0.0, 0.0)),
        (Attitude(0.0, 0.0, 0.0), None),
        (Attitude(0.0, 0.0), (0.0, 0.0, 0.0)),
    ],
)
def test_px4_is_told_nothing_without_attitude_yaw_and_position(
    attitude: Any, position: Any
) -> None:
    assert landing_target(PX4, 0.0, pose_at((4, 0, 0)), AHEAD, attitude, position) is None


SIDES = [(AHEAD, FORWARD, (2, 1, 0)), (BEHIND, BACK, (2, 1, 0)), (BELOW, DOWN, (0, 1, 2))]
"""With each, the way it looks, and where in a vector of (aside, aside, along it) the axes are."""


@pytest.mark.parametrize(("mounted", "orient", "axes"), SIDES)
@given(
    st.tuples(coordinate, coordinate, st.floats(0.5, 20)), st.tuples(*[st.integers(-25, 25)] * 3)
)
def test_a_rover_understands_what_is_meant_however_the_camera_is_mounted(
    mounted: Any, orient: int, axes: Any, aside: Any, angles: Any
) -> None:
    body = np.array(aside)[list(axes)] * (-1 if orient == BACK else 1)
    mounting = Mounting(turned(*angles) @ mounted.R_body_camera)
    assert plnd_orient(ROVER, mounting) == orient
    message = decoded(landing_target(ROVER, 0.0, pose_at(body, mounting), mounting))
    assert understood(ROVER, message, orient).place == pytest.approx(body, abs=1e-4)
    # By the angles, which ArduPilot takes where the place is not valid, it is the same.
    by_angles = decoded(_with(message, position_valid=0))
    assert understood(ROVER, by_angles, orient).place == pytest.approx(body, rel=1e-3, abs=1e-3)


def _with(message: Any, **changes: Any) -> Any:
    return mavlink.MAVLink_landing_target_message(
        **{name: changes.get(name, getattr(message, name)) for name in message.fieldnames}
    )


def test_by_mavlink_1_the_dock_would_be_straight_ahead() -> None:
    """Why such a link is refused."""
    x, y, z = -0.2, 0.5, 4.0
    old = mavlink1.MAVLink_landing_target_message(1, 0, 12, 0.0, 0.0, math.hypot(x, y, z), 0, 0)
    data = old.pack(mavlink1.MAVLink(None, 1, 191))
    read = mavlink.MAVLink(None).parse_char(data)
    assert understood(ROVER, read).place == pytest.approx((4.0361, 0.0, 0.0), abs=1e-4)


def test_the_docks_own_attitude_is_told_against_a_vehicle_that_lies_in_it() -> None:
    square = landing_target(ROVER, 0.0, pose_at((4, 0, 0)), AHEAD)
    assert square.q == pytest.approx((1, 0, 0, 0))
    # The camera sees the dock turned by 20 degrees about down, its y.
    R = turned(0, 0, 20)
    about_down = AHEAD.R_body_camera.T @ R @ AHEAD.R_body_camera
    message = landing_target(ROVER, 0.0, pose_at((4, 0, 0), R_camera_dock=about_down), AHEAD)
    half = math.radians(10)
    assert message.q == pytest.approx((math.cos(half), 0, 0, math.sin(half)))
    # On earth a heading of 30 degrees comes on top.
    north = Attitude(0.0, 0.0, math.radians(30))
    message = landing_target(
        PX4, 0.0, pose_at((4, 0, 0), R_camera_dock=about_down), AHEAD, north, (0, 0, 0)
    )
    half = math.radians(25)
    assert message.q == pytest.approx((math.cos(half), 0, 0, math.sin(half)))


def messages(receiver: Any, track: Any, vision: bool = False) -> list[str]:
    attitude = Attitude(0.0, 0.0, 0.3)
    made = frame_messages(receiver, vision, 1.0, track, AHEAD, attitude, (0, 0, 0), 0)
    return [message.get_type() for message in made]


@pytest.mark.parametrize("receiver", [ROVER, COPTER, PX4])
def test_a_frame_that_does_not_measure_the_dock_makes_no_landing_target(receiver: Any) -> None:
    pose = pose_at((4, 0, 0))
    assert messages(receiver, tracked(1.0, pose)) == ["LANDING_TARGET"]
    assert messages(receiver, tracked(1.0, pose, age_s=0.05)) == []


@pytest.mark.parametrize("receiver", [ROVER, COPTER, PX4, SUB])
@pytest.mark.parametrize("state", ["never_seen", "acquiring", "recently_lost", "lost"])
def test_nothing_is_said_unless_the_dock_is_tracked(receiver: Any, state: str) -> None:
    pose = pose_at((4, 0, 0))
    assert messages(receiver, tracked(1.0, pose, state=state), vision=True) == []
    assert messages(receiver, Track("tracking", 1.0), vision=True) == []


def test_each_receiver_gets_its_own_messages() -> None:
    track = tracked(1.0, pose_at((4, 0, 0)))
    vision = "VISION_POSITION_ESTIMATE"
    assert messages(SUB, track, vision=True) == [vision]
    assert messages(ROVER, track, vision=True) == ["LANDING_TARGET", vision]
    assert messages(PX4, track, vision=True) == ["LANDING_TARGET", "ODOMETRY"]
    hidden = tracked(1.0, pose_at((4, 0, 0)), age_s=0.2)
    assert messages(SUB, hidden, vision=True) == [vision]


@given(st.tuples(coordinate, coordinate, coordinate), st.tuples(*[st.integers(-80, 80)] * 3))
def test_px4_understands_what_is_meant_however_the_vehicle_lies(body: Any, angles: Any) -> None:
    roll, pitch, yaw = np.radians(angles).tolist()
    message = landing_target(
        PX4, 0.0, pose_at(body), AHEAD, Attitude(roll, pitch, yaw), (-7.0, 20.0, 3.0)
    )
    on_earth = np.array([-7.0, 20.0, 3.0]) + turned(*angles) @ body
    assert understood(PX4, decoded(message)).place == pytest.approx(on_earth, abs=1e-4)


def test_a_dock_that_is_approached_is_understood_to_be_where_it_is() -> None:
    """From the markers' noisy pixels, by the tracker, the wire and the receiver's rules."""
    tracker, rng, errors = Tracker(DOCK), np.random.default_rng(5), list[float]()
    for k in range(40):
        time_s = k / 10
        track = tracker.update(time_s, tracker.plan(time_s), found(approach(time_s), rng), CAMERA)
        for message in frame_messages(ROVER, False, time_s, track, AHEAD, None, None, 0):
            place = understood(ROVER, decoded(message)).place
            truth = AHEAD.R_body_camera @ approach(time_s)[1]
            errors.append(float(np.linalg.norm(place - truth) / np.linalg.norm(truth)))
    # Locked after 0.1 s or more, and from then on in each frame.
    assert 30 < len(errors) < 40 and max(errors) < 0.05
