"""Who speaks MAVLink to this computer."""

from __future__ import annotations

import select
import socket
import time
from collections.abc import Iterator

from pymavlink.dialects.v20 import common as mavlink

from chromadock.autopilot.receivers import RECEIVERS, misfit
from chromadock.doctor.finding import Finding

PORTS = (14550, 14555, 14551, 14540)
"""UDP ports that routers and autopilots send to."""

LISTEN_S = 5.0

_Heard = dict[tuple[int, int, int], tuple[int, int]]


def heartbeats(ports: tuple[int, ...] = PORTS, seconds: float = LISTEN_S) -> Iterator[Finding]:
    """The vehicles that are heard, each with the output that would tell it."""
    heard, busy = _listened(ports, seconds)
    for port in busy:
        yield Finding(
            "warning", "autopilot", f"UDP port {port} is taken by another program, not listened to"
        )
    for (port, system, _), (kind, autopilot) in sorted(heard.items()):
        receiver = next(
            (name for name, r in RECEIVERS.items() if misfit(r, kind, autopilot) is None), None
        )
        who = f"system {system} on UDP port {port}"
        if receiver is None:
            yield Finding("warning", "autopilot", f"{who}: no receiver of ours fits its kind")
        else:
            yield Finding(
                "ok",
                "autopilot",
                f"{who}: tell it with --out 'mavlink:udpin:0.0.0.0:{port}?receiver={receiver}'",
            )
    if not heard:
        numbers = ", ".join(str(port) for port in ports if port not in busy)
        yield Finding(
            "warning",
            "autopilot",
            f"no heartbeat within {seconds:g} s on UDP ports {numbers}: make an endpoint to this "
            "computer (BlueOS: Autopilot Endpoints, UDP client), or leave it if there is none",
        )


def _listened(ports: tuple[int, ...], seconds: float) -> tuple[_Heard, list[int]]:
    """Type and autopilot of each vehicle by port, system and component; ports that are taken."""
    ends: dict[socket.socket, int] = {}
    busy = []
    for port in ports:
        end = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            end.bind(("", port))
        except OSError:
            end.close()
            busy.append(port)
            continue
        ends[end] = port
    parsers = {end: mavlink.MAVLink(None) for end in ends}
    for parser in parsers.values():
        parser.robust_parsing = True
    heard: _Heard = {}
    until_s = time.monotonic() + seconds
    while ends and (left_s := until_s - time.monotonic()) > 0:
        for end in select.select(list(ends), [], [], left_s)[0]:
            for message in parsers[end].parse_buffer(end.recv(65536)) or ():
                vehicle = message.get_type() == "HEARTBEAT" and (
                    message.autopilot != mavlink.MAV_AUTOPILOT_INVALID
                )
                if vehicle:
                    key = (ends[end], message.get_srcSystem(), message.get_srcComponent())
                    heard[key] = (message.type, message.autopilot)
    for end in ends:
        end.close()
    return heard, busy
