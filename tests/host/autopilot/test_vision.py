"""VISION_POSITION_ESTIMATE and ODOMETRY: the vehicle's place by the dock."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from autopilot_truth import AHEAD, BELOW, pose_at, turned
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import common as mavlink

from chromadock import Attitude
from chromadock.autopilot.place import ATTITUDE_ERROR_RAD
from chromadock.autopilot.receivers import COPTER, PX4, ROVER, SUB
from chromadock.autopilot.understood import understood
from chromadock.autopilot.vision import vision_message
from chromadock.autopilot.wire import decoded
from chromadock.track.attitude import attitude_of

GOLDEN = [
    # Dock in true FRD; heading, pitch, roll in degrees; the vehicle from the dock, by hand.
    ((4.0, 0.5, 0.2), (0, 0, 0), (-4.0, -0.5, -0.2)),
    ((4.0, 0.5, 0.2), (90, 0, 0), (0.5, -4.0, -0.2)),
    ((4.0, 0.5, 0.2), (180, 0, 0), (4.0, 0.5, -0.2)),
    # Nose up by 90 degrees: ahead is up, below is ahead.
    ((4.0, 0.5, 0.2), (0, 90, 0), (-0.2, -0.5, 4.0)),
    # Rolled to the right by 90 degrees: right is down, below is left.
    ((4.0, 0.5, 0.2), (0, 0, 90), (-4.0, 0.2, -0.5)),
]


def told(
    receiver: Any, pose: Any, attitude: Attitude, mounting: Any = AHEAD, reset: int = 7
) -> Any:
    return decoded(vision_message(receiver, 12.5, pose, mounting, attitude, reset))


@pytest.mark.parametrize("receiver", [SUB, ROVER, COPTER, PX4])
@pytest.mark.parametrize(("body", "angles", "vehicle"), GOLDEN)
def test_the_vehicle_is_where_the_dock_is_not(
    receiver: Any, body: Any, angles: Any, vehicle: Any
) -> None:
    yaw, pitch, roll = np.radians(angles).tolist()
    message = told(receiver, pose_at(body), Attitude(roll, pitch, yaw))
    if receiver is PX4:
        assert message.time_usec == 12_500_000
        assert (message.frame_id, message.child_frame_id) == (1, 12)
        # Its own heading given back would take the place of its compass.
        assert all(map(math.isnan, message.q))
    else:
        assert message.usec == 12_500_000
        assert (message.roll, message.pitch, message.yaw) == pytest.approx((roll, pitch, yaw))
    assert message.reset_counter == 7
    taken = understood(receiver, message)
    assert taken.what == "vehicle" and taken.place == pytest.approx(vehicle, abs=1e-5)


@given(
    st.tuples(*[st.floats(-9, 9)] * 3),
    st.tuples(st.integers(-179, 179), st.integers(-80, 80), st.integers(-179, 179)),
)
def test_the_dock_stands_at_the_origin_of_the_vehicles_place(body: Any, angles: Any) -> None:
    """However the vehicle lies and the camera looks."""
    R = turned(*angles)
    attitude = attitude_of(R)
    message = told(SUB, pose_at(body, BELOW), attitude, BELOW)
    place = np.array(understood(SUB, message).place)
    np.testing.assert_allclose(place + R @ body, 0, atol=1e-4)


@pytest.mark.parametrize("receiver", [SUB, PX4])
def test_every_number_of_the_covariance_is_one(receiver: Any) -> None:
    """One that is NaN after a first that is not makes ArduPilot's error NaN."""
    message = told(receiver, pose_at((4, 0.5, 0.2)), Attitude(0.1, 0.2, 0.3))
    covariance = message.pose_covariance if receiver is PX4 else message.covariance
    assert len(covariance) == 21 and np.isfinite(covariance).all()
    angles = [covariance[k] for k in (15, 18, 20)]
    assert angles == pytest.approx([math.pi**2 / 3] * 3)


def test_the_error_along_the_sight_is_told_along_the_sight() -> None:
    """The range is known to 0.3 m, the rest to 1 cm; the camera's z is east of a vehicle so."""
    covariance = np.diag([1e-4, 1e-4, 0.09, 0, 0, 0])
    pose = pose_at((5.0, 0.0, 0.0), covariance=covariance)
    message = told(PX4, pose, Attitude(0.0, 0.0, math.pi / 2))
    north, east, down = (message.pose_covariance[k] for k in (0, 6, 11))
    tilted = (5 * ATTITUDE_ERROR_RAD) ** 2
    assert east == pytest.approx(0.09, rel=1e-4)
    assert (north, down) == pytest.approx((1e-4 + tilted, 1e-4 + tilted), rel=1e-4)
    # PX4 takes the axes, ArduPilot their sum: the same 21 numbers.
    assert understood(PX4, message).error_m == pytest.approx(0.3, rel=1e-3)
    same = told(SUB, pose, Attitude(0.0, 0.0, math.pi / 2))
    assert same.covariance == pytest.approx(message.pose_covariance)
    total = math.sqrt(0.09 + 2 * (1e-4 + tilted))
    assert understood(SUB, same).error_m == pytest.approx(total, rel=1e-4)


def test_the_vehicles_motion_and_rates_are_not_told() -> None:
    message = told(PX4, pose_at((5, 0, 0)), Attitude(0, 0, 0))
    assert all(map(math.isnan, (message.vx, message.vy, message.vz)))
    assert all(map(math.isnan, (message.rollspeed, message.pitchspeed, message.yawspeed)))
    assert math.isnan(message.velocity_covariance[0])
    assert (message.estimator_type, message.quality) == (mavlink.MAV_ESTIMATOR_TYPE_VISION, 90)


@given(st.integers(-179, 179), st.integers(-89, 89), st.integers(-179, 179))
def test_roll_pitch_and_yaw_come_back_from_the_rotation(roll: int, pitch: int, yaw: int) -> None:
    angles = np.radians([roll, pitch, yaw])
    attitude = attitude_of(Attitude(*angles.tolist()).R_world_body)
    back = (attitude.roll_rad, attitude.pitch_rad, attitude.yaw_rad)
    assert back == pytest.approx(tuple(angles), abs=1e-6)
