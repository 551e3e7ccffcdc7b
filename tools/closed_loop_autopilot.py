"""The other end of the vehicle's MAVLink output in the closed loop: a boat, by pymavlink."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field

from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mavlink

ATTITUDE_HZ = 25


@dataclass
class Heard:
    """What came: ``targets`` arrival, stamp (both of the monotonic clock, seconds) and distance
    (metres) of each LANDING_TARGET; ``counts`` of all messages by name."""

    targets: list[tuple[float, float, float]] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)


class Autopilot:
    """Sends heartbeats and a level attitude, and keeps what it hears, until it is stopped."""

    def __init__(self, port: int) -> None:
        self.heard = Heard()
        self._link = mavutil.mavlink_connection(
            f"udpout:127.0.0.1:{port}", source_system=1, source_component=1
        )
        self._booted_s = time.monotonic()
        self._stop = threading.Event()
        self._threads = [threading.Thread(target=work) for work in (self._send, self._receive)]
        for thread in self._threads:
            thread.start()

    def stop(self) -> None:
        """End it."""
        self._stop.set()
        for thread in self._threads:
            thread.join()
        self._link.close()

    def _send(self) -> None:
        number = 0
        while not self._stop.wait(1 / ATTITUDE_HZ):
            ms = round((time.monotonic() - self._booted_s) * 1000)
            if number % ATTITUDE_HZ == 0:
                self._link.mav.heartbeat_send(
                    mavlink.MAV_TYPE_SURFACE_BOAT,
                    mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
                    0, 0, mavlink.MAV_STATE_ACTIVE,
                )  # fmt: skip
            self._link.mav.attitude_send(ms, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            number += 1

    def _receive(self) -> None:
        while not self._stop.is_set():
            message = self._link.recv_match(blocking=True, timeout=0.2)
            if message is None:
                continue
            now_s, name = time.monotonic(), message.get_type()
            self.heard.counts[name] = self.heard.counts.get(name, 0) + 1
            if name == "LANDING_TARGET":
                self.heard.targets.append((now_s, message.time_usec / 1e6, message.distance))
