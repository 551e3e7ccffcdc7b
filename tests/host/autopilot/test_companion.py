"""The manners of a MAVLink component, message by message, without any wire."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v10 import common as mavlink1
from pymavlink.dialects.v20 import common as mavlink

from chromadock import method
from chromadock.autopilot.companion import (
    ASK_AGAIN_S,
    MAVLINK1_S,
    PATIENCE_S,
    SILENCE_S,
    Companion,
    status_text,
)
from chromadock.autopilot.receivers import PX4, ROVER, SUB

ARDUPILOT, BOAT, SUBMARINE = 3, mavlink.MAV_TYPE_SURFACE_BOAT, mavlink.MAV_TYPE_SUBMARINE


def sent(message: Any, system: int = 7, component: int = 1) -> Any:
    """As it comes from somebody."""
    data = message.pack(mavlink.MAVLink(None, system, component))
    return mavlink.MAVLink(None).parse_char(data)


def heartbeat(vehicle: int = BOAT, autopilot: int = ARDUPILOT, **sender: int) -> Any:
    return sent(mavlink.MAVLink_heartbeat_message(vehicle, autopilot, 0, 0, 4, 3), **sender)


def heartbeat1(system: int = 7) -> Any:
    old = mavlink1.MAVLink_heartbeat_message(BOAT, ARDUPILOT, 0, 0, 4, 3)
    return mavlink.MAVLink(None).parse_char(old.pack(mavlink1.MAVLink(None, system, 1)))


def companion(receiver: Any = ROVER, speaks_first: bool = False) -> Companion:
    return Companion(receiver, "udpin:0.0.0.0:1", 0.0, speaks_first)


def met(receiver: Any = ROVER, vehicle: int = BOAT) -> Companion:
    """One that has heard its vehicle, system 7."""
    one = companion(receiver)
    one.heard(heartbeat(vehicle), 0.5)
    one.due(0.5)
    return one


def names(messages: list[Any]) -> list[str]:
    return [message.get_type() for message in messages]


def command(number: int, value: float, system: int = 7, component: int = 191) -> Any:
    values = [value] + [0.0] * 6
    return sent(
        mavlink.MAVLink_command_long_message(system, component, number, 0, *values), 255, 190
    )


def test_nothing_is_said_before_the_vehicle() -> None:
    one = companion()
    assert one.due(0.0) == one.due(5.0) == [] and not one.present(5.0)
    assert one.system == 1


def test_to_a_router_that_waits_only_the_heartbeat_goes_first() -> None:
    one = companion(speaks_first=True)
    said = [names(one.due(k / 10)) for k in range(25)]
    assert [k for k, what in enumerate(said) if what] == [0, 10, 20]
    assert {name for what in said for name in what} == {"HEARTBEAT"} and not one.present(2.5)


def test_it_takes_the_vehicles_system_and_says_what_it_is_once_a_second() -> None:
    one = met()
    assert one.system == 7 and one.present(0.6) and not one.notices
    said = [m for k in range(5, 45) for m in one.due(0.1 * k + 1.0)]
    beats = [m for m in said if m.get_type() == "HEARTBEAT"]
    assert len(beats) == 4
    assert (beats[0].type, beats[0].autopilot) == (
        mavlink.MAV_TYPE_ONBOARD_CONTROLLER,
        mavlink.MAV_AUTOPILOT_INVALID,
    )


@pytest.mark.parametrize(
    ("vehicle", "autopilot"),
    [
        (mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID),
        (mavlink.MAV_TYPE_ONBOARD_CONTROLLER, mavlink.MAV_AUTOPILOT_INVALID),
        (mavlink.MAV_TYPE_GIMBAL, ARDUPILOT),
        (mavlink.MAV_TYPE_ADSB, mavlink.MAV_AUTOPILOT_INVALID),
    ],
)
def test_ground_stations_and_gimbals_are_no_vehicles(vehicle: int, autopilot: int) -> None:
    one = companion()
    one.heard(heartbeat(vehicle, autopilot), 0.5)
    assert not one.present(0.6)


def test_a_vehicle_that_is_not_the_receivers_is_named_once() -> None:
    one = companion()
    for k in range(3):
        one.heard(heartbeat(SUBMARINE), 0.5 + k)
    assert len(one.notices) == 1
    assert one.notices[0].startswith("udpin:0.0.0.0:1: the vehicle says MAV_TYPE_SUBMARINE (12)")
    assert "ignores LANDING_TARGET" in one.notices[0] and "receiver=ardusub" in one.notices[0]


def test_a_second_vehicle_on_the_link_is_not_taken_for_the_first() -> None:
    one = met()
    one.heard(heartbeat(system=9), 1.0)
    assert one.system == 7
    # After the first has fallen silent it is.
    one.heard(heartbeat(system=9), 0.6 + SILENCE_S)
    assert one.system == 9


def test_a_vehicle_by_mavlink_1_alone_is_refused_in_one_line() -> None:
    one = companion()
    for k in range(12):
        one.heard(heartbeat1(), 1.0 + k)
        said = names(one.due(1.0 + k))
        assert said == ["HEARTBEAT"]  # which makes an autopilot that can change to MAVLink 2
        assert not one.present(1.0 + k)
        assert len(one.notices) == (k >= MAVLINK1_S)
    assert "MAVLink 1" in one.notices[0] and "SERIALn_PROTOCOL" in one.notices[0]


def test_a_vehicle_that_changes_to_mavlink_2_on_hearing_us_is_told() -> None:
    one = companion()
    one.heard(heartbeat1(), 1.0)
    one.heard(heartbeat(), 2.0)
    assert one.present(2.1) and not one.notices
    # And is not any more when it falls back, as after its restart, until it changes again.
    one.heard(heartbeat1(), 3.0)
    assert not one.present(3.1)
    one.heard(heartbeat(), 4.0)
    assert one.present(4.1) and not one.notices


def test_silence_is_told_once_and_so_is_its_end() -> None:
    one = met()
    for k in range(20):
        one.due(1.0 + k)
    assert [line.split(": ", 1)[1] for line in one.notices] == [
        "no heartbeat for 5 s: nothing is sent"
    ]
    assert not one.present(7.0)
    one.notices.clear()
    one.heard(heartbeat(), 30.0)
    one.heard(heartbeat(), 31.0)
    assert list(one.notices) == ["udpin:0.0.0.0:1: heard the vehicle, system 7"]
    assert one.present(31.1)


def test_nobody_at_all_is_told_once_after_a_while() -> None:
    one = companion()
    for k in range(30):
        one.due(float(k))
        assert len(one.notices) == (k >= PATIENCE_S)
    assert "check the address" in one.notices[0]


def test_a_port_that_failed_is_told_once_and_when_the_vehicle_is_heard_again() -> None:
    one = met()
    for k in range(4):
        one.failed("Connection refused", 2.0 + k)
    assert len(one.notices) == 1 and "Connection refused" in one.notices[0]
    assert not one.present(6.0) and one.due(6.0) == []
    one.notices.clear()
    one.heard(heartbeat(), 7.0)
    assert list(one.notices) == ["udpin:0.0.0.0:1: heard the vehicle, system 7"]


def test_timesync_is_answered_by_our_clock_in_nanoseconds() -> None:
    one = met()
    (answer,) = one.heard(sent(mavlink.MAVLink_timesync_message(0, 123_456)), 2.5)
    assert (answer.tc1, answer.ts1) == (2_500_000_000, 123_456)
    # An answer to somebody else's is none to us.
    assert one.heard(sent(mavlink.MAVLink_timesync_message(5, 123_456)), 2.5) == []


def test_a_ping_is_answered_to_its_sender_and_an_answer_is_not() -> None:
    one = met()
    (answer,) = one.heard(sent(mavlink.MAVLink_ping_message(99, 5, 0, 0), 255, 190), 2.5)
    assert (answer.time_usec, answer.seq) == (99, 5)
    assert (answer.target_system, answer.target_component) == (255, 190)
    assert one.heard(sent(mavlink.MAVLink_ping_message(99, 5, 7, 191), 255, 190), 2.5) == []


@pytest.mark.parametrize("component", [191, 0])
@pytest.mark.parametrize(
    ("number", "value"),
    [
        (mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION),
        (mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1),
    ],
)
def test_it_says_who_it_is_when_asked(component: int, number: int, value: float) -> None:
    ack, version = met().heard(command(number, value, component=component), 2.0)
    assert (ack.command, ack.result) == (number, mavlink.MAV_RESULT_ACCEPTED)
    assert (ack.target_system, ack.target_component) == (255, 190)
    assert version.capabilities == mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    assert bytes(version.middleware_custom_version)[::-1].hex() == method.DIGEST


def test_other_commands_are_refused_if_they_are_ours_and_else_passed_over() -> None:
    one, arm = met(), mavlink.MAV_CMD_COMPONENT_ARM_DISARM
    (ack,) = one.heard(command(arm, 1), 2.0)
    assert (ack.command, ack.result) == (arm, mavlink.MAV_RESULT_UNSUPPORTED)
    assert one.heard(command(arm, 1, component=0), 2.0) == []
    assert one.heard(command(arm, 1, component=1), 2.0) == []
    asked = mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION
    assert one.heard(command(*asked, component=1), 2.0) == []
    assert one.heard(command(*asked, system=8), 2.0) == []


def attitude(ms: int, **sender: int) -> Any:
    return sent(mavlink.MAVLink_attitude_message(ms, 0.1, 0.2, 0.3, 0, 0, 0), **sender)


def test_the_vehicle_is_asked_for_its_attitude_and_px4_for_its_position_too() -> None:
    for receiver, wanted in ((SUB, [30]), (PX4, [30, 32])):
        one = companion(receiver)
        one.heard(heartbeat(SUBMARINE, receiver.autopilot), 0.5)
        asked = [m for m in one.due(0.5) if m.get_type() == "COMMAND_LONG"]
        assert [(m.command, m.param1, m.param2) for m in asked] == [
            (mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, 50_000) for number in wanted
        ]
        assert {(m.target_system, m.target_component) for m in asked} == {(7, 1)}


def test_it_is_asked_again_only_where_too_little_comes() -> None:
    def asks(period_s: float) -> int:
        one, count, next_s = met(SUB, SUBMARINE), 0, 0.5
        for k in range(200):
            now_s = 0.5 + k / 10
            one.heard(heartbeat(SUBMARINE), now_s)
            while next_s <= now_s:
                one.heard(attitude(round(next_s * 1000)), next_s)
                next_s += period_s
            count += names(one.due(now_s)).count("COMMAND_LONG")
        return count

    assert asks(0.05) == asks(0.1) == 0
    assert asks(0.25) == 3 == int(20 / ASK_AGAIN_S) - 1


def test_an_attitude_that_does_not_come_is_named_where_nothing_goes_without_it() -> None:
    for receiver, vehicle, missed in ((SUB, SUBMARINE, True), (ROVER, BOAT, False)):
        one = met(receiver, vehicle)
        for k in range(100):
            one.heard(heartbeat(vehicle), 0.6 + k / 10)
            one.due(0.6 + k / 10)
        assert bool(one.notices) == missed


def test_an_attitude_that_ceases_is_named_and_named_again_when_it_ceases_again() -> None:
    one = met(SUB, SUBMARINE)
    told = []
    for k in range(600):
        now_s = 0.6 + k / 10
        one.heard(heartbeat(SUBMARINE), now_s)
        if k < 100 or 200 <= k < 300:
            one.heard(attitude(round(now_s * 1000)), now_s)
        one.due(now_s)
        told += [k] * len(one.notices)
        one.notices.clear()
    assert len(told) == 2 and 100 < told[0] < 200 and told[1] > 300


def test_only_the_vehicles_own_attitude_counts() -> None:
    one = met(SUB, SUBMARINE)
    one.heard(attitude(1000, component=154), 1.0)  # a gimbal's
    assert one.telemetry.attitude(1.0) is None
    one.heard(attitude(1000), 1.0)
    got = one.telemetry.attitude(1.0)
    assert got is not None and got.yaw_rad == pytest.approx(0.3)


def test_an_attitude_that_is_no_number_is_passed_over() -> None:
    one, nan = met(SUB, SUBMARINE), float("nan")
    assert one.heard(sent(mavlink.MAVLink_attitude_message(1, nan, 0, 0, 0, 0, 0)), 1.0) == []
    assert one.telemetry.attitude(1.0) is None


def test_the_crews_text_is_plain_information() -> None:
    text = sent(status_text("Chromadock: dock locked, 4.1 m"))
    assert (text.severity, text.text) == (6, "Chromadock: dock locked, 4.1 m")
