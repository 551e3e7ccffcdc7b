"""What the user writes after ``mavlink:``, checked and taken apart."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from chromadock.autopilot.receivers import RECEIVERS, Receiver
from chromadock.errors import ChromadockError

SCHEME = "mavlink:"
FORM = f"{SCHEME}ADDRESS?receiver={'|'.join(RECEIVERS)}"
"""For ``--help`` and for messages."""

ADDRESSES = "udpin:0.0.0.0:14555, udpout:HOST:PORT, tcp:HOST:PORT or /dev/ttyUSB0:115200"
_NETWORKS = ("udpin", "udpout", "tcp")

RATE_HZ = 15.0
RATES_HZ = (5.0, 20.0)
"""Below 5 Hz ArduPilot takes a visual position for dead (it wants one within 300 ms); above 20 Hz
nothing is gained, since the errors of frames so close together are the same."""

BAUD = 115200


@dataclass(frozen=True, slots=True)
class Address:
    """Where the autopilot is: ``kind`` is ``udpin``, ``udpout``, ``tcp`` or ``serial``; ``place``
    a host or a device; ``number`` a port number or bits a second."""

    kind: str
    place: str
    number: int

    def __str__(self) -> str:
        """As the user writes it."""
        words = f"{self.place}:{self.number}"
        return words if self.kind == "serial" else f"{self.kind}:{words}"


@dataclass(frozen=True, slots=True)
class AutopilotSettings:
    """One MAVLink output.

    Attributes
    ----------
    address
        Where the messages go.
    receiver
        What is at the other end.
    rate_hz
        At most so many frames a second are told, 5 to 20.
    vision
        Whether the vehicle's own position by the dock is sent too (the receiver's ``vision``).
    """

    address: Address
    receiver: Receiver
    rate_hz: float
    vision: bool

    @classmethod
    def parse(cls, text: str) -> AutopilotSettings:
        """From ``mavlink:ADDRESS?receiver=NAME[&rate_hz=15][&vision=on|off]``.

        Raises
        ------
        ChromadockError
            In one line: what is wrong, and what may stand there.
        """
        if not text.startswith(SCHEME):
            raise ChromadockError(f"{text}: not a MAVLink output: write {FORM}")
        address, _, query = text.removeprefix(SCHEME).partition("?")
        options = _options(text, query)
        receiver = _receiver(text, options.pop("receiver", None))
        rate_hz = _rate(text, options.pop("rate_hz", None))
        vision = _vision(text, receiver, options.pop("vision", None))
        if options:
            raise ChromadockError(
                f"{text}: unknown setting {next(iter(options))}: "
                "there are receiver, rate_hz and vision"
            )
        return cls(_address(text, address), receiver, rate_hz, vision)


def _options(text: str, query: str) -> dict[str, str]:
    options: dict[str, str] = {}
    for pair in filter(None, query.split("&")):
        name, equals, value = pair.partition("=")
        if not equals or name in options:
            fault = "is there twice" if equals else "has no value"
            raise ChromadockError(f"{text}: {name} {fault}: write it once, as {name}=VALUE")
        options[name] = value
    return options


def _receiver(text: str, name: str | None) -> Receiver:
    if name in RECEIVERS:
        return RECEIVERS[name]
    fault = "no receiver" if name is None else f"unknown receiver {name}"
    raise ChromadockError(f"{text}: {fault}: add ?receiver= and one of {', '.join(RECEIVERS)}")


def _rate(text: str, value: str | None) -> float:
    if value is None:
        return RATE_HZ
    try:
        rate_hz = float(value)
    except ValueError:
        rate_hz = math.nan
    low, high = RATES_HZ
    if not low <= rate_hz <= high:
        raise ChromadockError(f"{text}: rate_hz is {value}: it must be {low:g} to {high:g}")
    return rate_hz


def _vision(text: str, receiver: Receiver, value: str | None) -> bool:
    if value is None:
        return receiver.vision_by_default
    if value not in ("on", "off"):
        raise ChromadockError(f"{text}: vision is {value}: it must be on or off")
    if value == "off" and not receiver.landing_target:
        raise ChromadockError(
            f"{text}: vision=off leaves nothing to send to {receiver.name}: leave it out"
        )
    return value == "on"


def _address(text: str, address: str) -> Address:
    kind, colon, rest = address.partition(":")
    if colon and kind in _NETWORKS:
        host, _, port = rest.rpartition(":")
        if not host or ":" in host or not _whole(port, 1, 65535):
            raise ChromadockError(f"{text}: {address} is no address: write {kind}:HOST:PORT")
        return Address(kind, host, int(port))
    if not address.startswith("/"):
        raise ChromadockError(f"{text}: {address or 'nothing'} is no address: write {ADDRESSES}")
    device, colon, baud = address.rpartition(":")
    # Names below /dev/serial/by-path have colons of their own.
    if not colon or re.search(r"\D", baud):
        return Address("serial", address, BAUD)
    if not _whole(baud, 1200, 4_000_000):
        raise ChromadockError(f"{text}: '{baud}' bits a second cannot be: write {device}:{BAUD}")
    return Address("serial", device, int(baud))


def _whole(digits: str, low: int, high: int) -> bool:
    return bool(re.fullmatch(r"\d{1,9}", digits, re.ASCII)) and low <= int(digits) <= high
