"""What ground stations and other hosts of MAVLink send, and what a dock makes of it."""

from __future__ import annotations

import struct

import pytest
from rig import Rig, parameter_set

from chromadock import dialect
from chromadock.link.commands import command_long
from chromadock.parameter_table import PARAMETERS

LED, RAW = dialect.MAV_CMD_DOCK_LED, dialect.DOCK_LED_RAW
STATUS = dialect.MAVLINK_MSG_ID_DOCK_STATUS
ACCEPTED, UNSUPPORTED = dialect.MAV_RESULT_ACCEPTED, dialect.MAV_RESULT_UNSUPPORTED


def as_bytes(name: str, value: int, kind: int) -> dialect.MAVLink_message:
    """PARAM_SET with the integer's own bytes."""
    (number,) = struct.unpack("<f", struct.pack("<i", value))
    return dialect.MAVLink_param_set_message(50, 1, name.encode(), number, kind)


def value_of(rig: Rig, name: str) -> float:
    """The next answer about a parameter."""
    return float(rig.wait("PARAM_VALUE", lambda m: m.param_id == name).param_value)


@pytest.mark.parametrize(
    "kind",
    [dialect.MAV_PARAM_TYPE_UINT8, dialect.MAV_PARAM_TYPE_INT16, dialect.MAV_PARAM_TYPE_INT32],
)
def test_an_integer_is_set_by_its_bytes_and_by_a_float(rig: Rig, kind: int) -> None:
    """Each is answered in its own way."""
    rig.send(as_bytes("LED_LIMIT", 100, kind))
    answer = rig.wait("PARAM_VALUE", lambda m: m.param_id == "LED_LIMIT")
    assert answer.param_type == dialect.MAV_PARAM_TYPE_INT32
    assert struct.pack("<f", answer.param_value) == struct.pack("<i", 100)
    rig.send(dialect.MAVLink_param_set_message(50, 1, b"LED_LIMIT", 90.0, kind))
    assert value_of(rig, "LED_LIMIT") == 90


def test_mavsdk_reads_integers_and_others_floats(rig: Rig) -> None:
    request = dialect.MAVLink_param_request_read_message(50, 1, b"WINDOW_MS", -1)
    for system, kind in ((245, dialect.MAV_PARAM_TYPE_INT32), (255, dialect.MAV_PARAM_TYPE_REAL32)):
        rig.wire.write(rig.pack(request, system, 190))
        answer = rig.wait("PARAM_VALUE", lambda m: m.param_id == "WINDOW_MS")
        assert answer.param_type == kind


def test_parameters_with_types_of_their_own_are_listed_and_set(rig: Rig) -> None:
    rig.send(dialect.MAVLink_param_ext_request_list_message(50, 1))
    values = {}
    while len(values) < len(PARAMETERS):
        value = rig.wait("PARAM_EXT_VALUE")
        values[value.param_id] = value.param_type
    assert values["LED_LIMIT"] == dialect.MAV_PARAM_EXT_TYPE_INT32
    assert values["LED_M_RG"] == dialect.MAV_PARAM_EXT_TYPE_REAL32
    for limit, result in (
        (100, dialect.PARAM_ACK_ACCEPTED),
        (300, dialect.PARAM_ACK_VALUE_UNSUPPORTED),
    ):
        data = struct.pack("<i", limit)
        kind = dialect.MAV_PARAM_EXT_TYPE_INT32
        rig.send(dialect.MAVLink_param_ext_set_message(50, 1, b"LED_LIMIT", data, kind))
        assert rig.wait("PARAM_EXT_ACK").param_result == result
    assert rig.dock.parameter("LED_LIMIT") == 100


def test_a_command_carried_by_a_tunnel_is_not_obeyed(rig: Rig) -> None:
    inner = rig.pack(command_long(LED, RAW, 1, 2, 3))
    payload = [*inner, *[0] * (128 - len(inner))]
    tunnel = dialect.MAVLink_tunnel_message(1, 1, 0, len(inner), payload)
    before = rig.dock.status()
    rig.wire.write(rig.pack(tunnel, 1, 1))
    after = rig.dock.status()
    assert after.led_mode == dialect.DOCK_LED_AUTO
    assert after.link_faults == before.link_faults


def test_the_led_parameter_ends_a_test(rig: Rig) -> None:
    rig.dock.led_raw(9, 9, 9)
    assert rig.dock.status().led_mode == RAW
    rig.send(parameter_set("LED_MODE", 0))
    assert value_of(rig, "LED_MODE") == 0
    assert rig.dock.status().led_mode == dialect.DOCK_LED_AUTO


def test_a_command_with_a_place_is_obeyed(rig: Rig) -> None:
    rig.send(dialect.MAVLink_command_int_message(50, 1, 0, LED, 0, 0, RAW, 9, 9, 9, 0, 0, 0))
    assert rig.wait("COMMAND_ACK", lambda m: m.command == LED).result == ACCEPTED
    assert rig.dock.status().led_mode == RAW


def test_questions_about_what_it_does_not_have_are_no_faults(rig: Rig) -> None:
    before = rig.dock.status().link_faults
    for number in (300, 397):
        assert rig.command(dialect.MAV_CMD_REQUEST_MESSAGE, number) == UNSUPPORTED
    rig.send(dialect.MAVLink_param_request_read_message(50, 1, b"SYSID_THISMAV", -1))
    rig.text("SYSID_THISMAV: no such parameter")
    assert rig.dock.status().link_faults == before


def test_an_interval_is_set_and_told(rig: Rig) -> None:
    assert rig.command(dialect.MAV_CMD_SET_MESSAGE_INTERVAL, STATUS, 100_000) == ACCEPTED
    rig.send(command_long(dialect.MAV_CMD_GET_MESSAGE_INTERVAL, STATUS))
    assert rig.wait("MESSAGE_INTERVAL").interval_us == 100_000
    assert rig.command(dialect.MAV_CMD_SET_MESSAGE_INTERVAL, STATUS, 0) == ACCEPTED


@pytest.mark.parametrize(
    ("number", "value"),
    [(dialect.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1), (dialect.MAV_CMD_PREFLIGHT_STORAGE, 2)],
)
def test_a_reboot_or_reset_of_every_system_is_not_for_the_dock(
    rig: Rig, number: int, value: float
) -> None:
    rig.dock.set_parameter("WINDOW_MS", 900)  # which a reset would set to its default
    before = rig.dock.status().time_boot_ms
    order = command_long(number, value)
    order.target_system = order.target_component = 0
    rig.send(order)
    assert rig.dock.parameter("WINDOW_MS") == 900
    assert rig.dock.status().time_boot_ms >= before


def test_a_list_as_version_1_of_mavlink_asks_for_it_is_answered(rig: Rig) -> None:
    request = dialect.MAVLink_param_request_list_message(50, 1)
    packed = request.pack(dialect.MAVLink(None, 255, 190), force_mavlink1=True)
    assert packed[0] == 0xFE
    rig.wire.write(bytes(packed))
    rig.wait("PARAM_VALUE", lambda m: m.param_index == len(PARAMETERS) - 1)


def test_packets_of_a_snapshot_are_sent_again(rig: Rig) -> None:
    rig.dock.snapshot()
    assert rig.command(dialect.MAV_CMD_DOCK_SNAPSHOT) == ACCEPTED
    picture = rig.wait("DATA_TRANSMISSION_HANDSHAKE")
    last = rig.wait("ENCAPSULATED_DATA", lambda m: m.seqnr == picture.packets - 1)
    assert picture.jpg_quality > 0
    wanted = (picture.jpg_quality, picture.packets - 1, 1)
    assert rig.command(dialect.MAV_CMD_DOCK_SNAPSHOT, *wanted) == ACCEPTED
    assert bytes(rig.wait("ENCAPSULATED_DATA").data) == bytes(last.data)
