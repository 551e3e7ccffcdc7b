"""What comes over the wire beside good messages, and from others."""

from __future__ import annotations

import random
import time

import pytest
from rig import DARK, Rig, parameter_read, parameter_set
from wire import Wire

from chromadock import dialect
from chromadock.errors import ChromadockError
from chromadock.link import Connection
from chromadock.link.commands import command_long

LED = dialect.MAV_CMD_DOCK_LED
RAW = dialect.DOCK_LED_RAW
WINDOW = "WINDOW_MS"


def is_value(name: str):
    return lambda m: m.get_type() == "PARAM_VALUE" and m.param_id == name


def window(rig: Rig) -> float:
    return rig.dock.parameter(WINDOW)


def test_heartbeats_come_once_a_second(rig: Rig) -> None:
    rig.wait("HEARTBEAT")
    times = []
    for _ in range(2):
        rig.wait("HEARTBEAT")
        times.append(time.monotonic())
    assert times[1] - times[0] == pytest.approx(1.0, abs=0.3)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_garbage_before_a_message_costs_nothing_else(rig: Rig, seed: int) -> None:
    noise = random.Random(seed).randbytes(3000)
    rig.wire.write(noise + rig.pack(parameter_set(WINDOW, 500 + seed)))
    # A false start in the noise may hold what follows until the line is silent.
    assert rig.wait("PARAM_VALUE", lambda m: m.param_id == WINDOW).param_value == 500 + seed


def test_garbage_of_start_bytes_holds_nothing_up_for_long(rig: Rig) -> None:
    rig.wire.write(b"\xfd" * 500 + rig.pack(parameter_set(WINDOW, 700)))
    assert rig.wait("PARAM_VALUE", lambda m: m.param_id == WINDOW).param_value == 700


@pytest.mark.parametrize("kept", [1, 9, 10, 15, 30])
def test_half_a_message_costs_only_itself(rig: Rig, kept: int) -> None:
    half = rig.pack(parameter_set(WINDOW, 111))[:kept]
    rig.wire.write(half + rig.pack(parameter_set("REPORT_HZ", 9)))
    assert rig.wait("PARAM_VALUE", lambda m: m.param_id == "REPORT_HZ").param_value == 9
    assert window(rig) == 2000


def test_a_message_in_single_bytes_is_understood(rig: Rig) -> None:
    for byte in rig.pack(parameter_set(WINDOW, 800)):
        rig.wire.write(bytes([byte]))
        rig.wire.written()
    assert rig.wait("PARAM_VALUE", lambda m: m.param_id == WINDOW).param_value == 800


def test_text_between_messages_is_passed_over(rig: Rig) -> None:
    text = b"ets Jul 29 2019 12:21:46\r\n"
    rig.wire.write(
        text.join(
            rig.pack(m)
            for m in (
                parameter_set(WINDOW, 900),
                parameter_set("REPORT_HZ", 4),
                parameter_set("LED_LIMIT", 99),
            )
        )
    )
    rig.wait("PARAM_VALUE", lambda m: m.param_id == "LED_LIMIT")
    values = rig.dock.parameters()
    assert (values[WINDOW], values["REPORT_HZ"], values["LED_LIMIT"]) == (900, 4, 99)


def test_every_single_damaged_byte_is_noticed(rig: Rig) -> None:
    good = rig.pack(parameter_set(WINDOW, 333))
    before = rig.dock.status()
    for place in range(len(good)):
        damaged = bytearray(good)
        damaged[place] ^= 0x55
        # The good message behind it must come through, and only it may act.
        rig.wire.write(bytes(damaged) + rig.pack(parameter_read("MAPPING")))
        heard = rig.heard_until(is_value("MAPPING"))
        assert not any(is_value(WINDOW)(m) for m in heard), f"byte {place}"
    assert window(rig) == 2000
    assert rig.dock.status().link_faults > before.link_faults


@pytest.mark.parametrize(("system", "component"), [(51, 1), (1, 1), (50, 2), (255, 190)])
def test_messages_to_others_are_not_obeyed(rig: Rig, system: int, component: int) -> None:
    led = command_long(LED, RAW, 0, 0, 0)
    led.target_system, led.target_component = system, component
    others = [
        led,
        parameter_set(WINDOW, 555, system, component),
        parameter_read("REPORT_HZ", system, component),
        dialect.MAVLink_param_request_list_message(system, component),
    ]
    rig.send(*others, parameter_read("MAPPING"))
    heard = rig.heard_until(is_value("MAPPING"))
    kinds = [m.get_type() for m in heard]
    assert "COMMAND_ACK" not in kinds
    assert kinds.count("PARAM_VALUE") == 1
    assert window(rig) == 2000
    assert list(rig.dock.status().duty) != DARK


def test_messages_to_all_are_answered_but_change_nothing(rig: Rig) -> None:
    rig.send(parameter_set(WINDOW, 600, 0, 0), parameter_read(WINDOW, 0, 0))
    assert rig.wait("PARAM_VALUE", lambda m: m.param_id == WINDOW).param_value == 2000


def test_the_dock_s_own_address_as_sender_is_not_obeyed(rig: Rig) -> None:
    rig.wire.write(rig.pack(parameter_set(WINDOW, 444), system=50, component=1))
    assert window(rig) == 2000


def test_two_hosts_take_turns(rig: Rig) -> None:
    first, second = (255, 190), (1, 191)
    pieces = []
    for red in (10, 20):
        pieces.append(rig.pack(command_long(LED, RAW, red, 0, 0), *first))
        pieces.append(rig.pack(parameter_set(WINDOW, 1000 + red), *second))
        pieces.append(rig.pack(command_long(31999), *second))
    rig.wire.write(b"".join(pieces))
    heard = rig.heard_until(lambda m: is_value(WINDOW)(m) and m.param_value == 1020)
    acks = [m for m in heard if m.get_type() == "COMMAND_ACK"]
    accepted, unsupported = dialect.MAV_RESULT_ACCEPTED, dialect.MAV_RESULT_UNSUPPORTED
    assert [(m.command, m.result, m.target_system, m.target_component) for m in acks] == 2 * [
        (LED, accepted, *first),
        (31999, unsupported, *second),
    ]
    rig.dock.led_raw(20, 0, 0)
    assert window(rig) == 1020


def test_an_unknown_command_is_answered_so(rig: Rig) -> None:
    before = list(rig.dock.status().duty)
    assert rig.command(31999, 1, 2, 3) == dialect.MAV_RESULT_UNSUPPORTED
    assert list(rig.dock.status().duty) == before


def test_a_message_that_nobody_here_reads_is_passed_over(rig: Rig) -> None:
    stranger = dialect.MAVLink_manual_control_message(50, 1, 2, 3, 4, 5)
    rig.send(stranger, parameter_set(WINDOW, 650))
    assert rig.wait("PARAM_VALUE", lambda m: m.param_id == WINDOW).param_value == 650


def test_the_port_is_ours_alone(rig: Rig, url: str) -> None:
    with pytest.raises(ChromadockError, match=r"in use by another program"):
        Connection(url)
    assert window(rig) == 2000


def test_both_directions_are_in_the_log(rig: Rig, wire: Wire) -> None:
    question = rig.pack(parameter_read("LED_GAMMA"))
    rig.wire.write(question)
    rig.wait("PARAM_VALUE", is_value("LED_GAMMA"))
    lines = wire.log.read_text().splitlines()
    assert any(line.endswith("> " + question.hex()) for line in lines[-20:])
    assert any(" < " in line and b"LED_GAMMA".hex() in line for line in lines[-20:])
