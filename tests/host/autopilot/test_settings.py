"""The output's address as the user writes it, and who is at its other end."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import common as mavlink

from chromadock import ChromadockError
from chromadock.autopilot.receivers import COPTER, PX4, RECEIVERS, ROVER, SUB, misfit
from chromadock.autopilot.settings import Address, AutopilotSettings

BY_PATH = "/dev/serial/by-path/usb-0:1.0-port0"

GOOD = {
    "udpin:0.0.0.0:14555": Address("udpin", "0.0.0.0", 14555),
    "udpout:192.168.2.2:14550": Address("udpout", "192.168.2.2", 14550),
    "tcp:blueos.local:5760": Address("tcp", "blueos.local", 5760),
    "/dev/ttyUSB0:921600": Address("serial", "/dev/ttyUSB0", 921600),
    "/dev/ttyAMA0": Address("serial", "/dev/ttyAMA0", 115200),
    BY_PATH: Address("serial", BY_PATH, 115200),
    f"{BY_PATH}:57600": Address("serial", BY_PATH, 57600),
}

BAD = {
    "udpout:127.0.0.1:14550?receiver=ardusub": "not a MAVLink output",
    "mavlink:udpout:127.0.0.1:14550": "no receiver",
    "mavlink:udpout:127.0.0.1:14550?receiver=": "unknown receiver",
    "mavlink:udpout:127.0.0.1:14550?receiver=ardupilot": "unknown receiver ardupilot",
    "mavlink:udpout:127.0.0.1?receiver=px4": "no address",
    "mavlink:udpout:127.0.0.1:0?receiver=px4": "no address",
    "mavlink:udpout:127.0.0.1:65536?receiver=px4": "no address",
    "mavlink:udpout:127.0.0.1:x?receiver=px4": "no address",
    "mavlink:udpout::14550?receiver=px4": "no address",
    "mavlink:udpout:::1:14550?receiver=px4": "no address",
    "mavlink:udp:127.0.0.1:14550?receiver=px4": "no address",
    "mavlink:?receiver=px4": "nothing is no address",
    "mavlink:/dev/ttyUSB0:9?receiver=px4": "'9' bits a second",
    "mavlink:/dev/ttyUSB0:?receiver=px4": "write /dev/ttyUSB0:115200",
    "mavlink:udpin:0.0.0.0:14555?receiver=px4&rate_hz=4.9": "rate_hz is 4.9: it must be 5 to 20",
    "mavlink:udpin:0.0.0.0:14555?receiver=px4&rate_hz=21": "5 to 20",
    "mavlink:udpin:0.0.0.0:14555?receiver=px4&rate_hz=fast": "5 to 20",
    "mavlink:udpin:0.0.0.0:14555?receiver=px4&rate_hz=nan": "5 to 20",
    "mavlink:udpin:0.0.0.0:14555?receiver=px4&rate_hz": "rate_hz has no value",
    "mavlink:udpin:0.0.0.0:14555?receiver=px4&receiver=ardusub": "receiver is there twice",
    "mavlink:udpin:0.0.0.0:14555?receiver=px4&hz=10": "unknown setting hz",
    "mavlink:udpin:0.0.0.0:14555?receiver=px4&vision=yes": "vision is yes: it must be on or off",
    "mavlink:udpin:0.0.0.0:14555?receiver=ardusub&vision=off": "leaves nothing to send",
}


@pytest.mark.parametrize("address", GOOD)
def test_an_address_is_taken_apart_and_put_together_again(address: str) -> None:
    settings = AutopilotSettings.parse(f"mavlink:{address}?receiver=ardusub")
    assert settings.address == GOOD[address]
    assert (settings.receiver, settings.rate_hz) == (SUB, 15.0)
    again = AutopilotSettings.parse(f"mavlink:{settings.address}?rate_hz=5&receiver=px4")
    assert (again.address, again.receiver, again.rate_hz) == (settings.address, PX4, 5.0)


@pytest.mark.parametrize("text", BAD)
def test_what_cannot_be_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(ChromadockError) as error:
        AutopilotSettings.parse(text)
    words = str(error.value)
    assert words.startswith(f"{text}: ") and BAD[text] in words and "\n" not in words


def test_a_position_is_sent_where_it_is_the_only_way_or_does_no_harm() -> None:
    parsed = {
        name: AutopilotSettings.parse(f"mavlink:/dev/ttyUSB0?receiver={name}").vision
        for name in RECEIVERS
    }
    assert parsed == {
        "ardusub": True, "px4": True, "ardupilot-rover": False, "ardupilot-copter": False
    }  # fmt: skip
    on = AutopilotSettings.parse("mavlink:/dev/ttyUSB0?receiver=ardupilot-rover&vision=on")
    off = AutopilotSettings.parse("mavlink:/dev/ttyUSB0?receiver=px4&vision=off")
    assert (on.vision, off.vision) == (True, False)


FITTING = [
    (SUB, mavlink.MAV_TYPE_SUBMARINE, 3), (ROVER, mavlink.MAV_TYPE_GROUND_ROVER, 3),
    (ROVER, mavlink.MAV_TYPE_SURFACE_BOAT, 3), (COPTER, mavlink.MAV_TYPE_HEXAROTOR, 3),
    (COPTER, mavlink.MAV_TYPE_VTOL_QUADROTOR, 3), (PX4, mavlink.MAV_TYPE_QUADROTOR, 12),
    (PX4, mavlink.MAV_TYPE_SUBMARINE, 12),
]  # fmt: skip


@pytest.mark.parametrize(("receiver", "vehicle", "autopilot"), FITTING)
def test_a_vehicle_that_fits_is_no_news(receiver, vehicle: int, autopilot: int) -> None:
    assert misfit(receiver, vehicle, autopilot) is None


MISFITS = [
    (ROVER, mavlink.MAV_TYPE_SUBMARINE, 3, "MAV_TYPE_SUBMARINE (12)", "receiver=ardusub"),
    (COPTER, mavlink.MAV_TYPE_SUBMARINE, 3, "ignores LANDING_TARGET", "receiver=ardusub"),
    (SUB, mavlink.MAV_TYPE_SURFACE_BOAT, 3, "MAV_TYPE_SURFACE_BOAT", "receiver=ardupilot-rover"),
    (SUB, mavlink.MAV_TYPE_SUBMARINE, 12, "MAV_AUTOPILOT_PX4", "receiver=px4"),
    (PX4, mavlink.MAV_TYPE_QUADROTOR, 3, "ARDUPILOTMEGA", "receiver=ardupilot-copter"),
    (PX4, 250, 99, "MAV_TYPE 250 of MAV_AUTOPILOT 99", "may be misread"),
]


@pytest.mark.parametrize(("receiver", "vehicle", "autopilot", "what", "mend"), MISFITS)
def test_a_vehicle_that_does_not_fit_is_named_with_the_receiver_that_does(
    receiver, vehicle: int, autopilot: int, what: str, mend: str
) -> None:
    words = misfit(receiver, vehicle, autopilot)
    assert words is not None and what in words and mend in words and "\n" not in words
