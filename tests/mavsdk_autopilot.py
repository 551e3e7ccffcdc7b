"""MAVSDK in the place of an autopilot: a program of its own, for its library has threads.

Sends its heartbeat and attitude to a UDP port of this computer, as system 7, and prints each
message that comes as a line of JSON, decoded by MAVSDK: name, system, component, fields.
"""

from __future__ import annotations

import json
import sys
import time

from mavsdk import Configuration, ConnectionResult, Mavsdk
from mavsdk.plugins.mavlink_direct import MavlinkDirect, MavlinkMessage

SYSTEM, COMPONENT = 7, 1
YAW = 1.5707963


def main(port: str) -> None:
    """Run until it is killed."""
    sdk = Mavsdk(Configuration.create_manual(SYSTEM, COMPONENT, True))
    result = sdk.add_any_connection(f"udpout://127.0.0.1:{port}")
    assert result == ConnectionResult.SUCCESS, result
    booted_s = time.monotonic()
    direct = None
    while True:
        time.sleep(0.04)
        systems = [] if direct else sdk.get_systems()
        if systems:
            direct = MavlinkDirect(systems[0])
            direct.subscribe_message("", show)
        if direct:
            direct.send_message(attitude(round((time.monotonic() - booted_s) * 1000)))


def show(message: MavlinkMessage, _data: object) -> None:
    """One line of JSON."""
    sender = message.system_id, message.component_id
    line = json.dumps([message.message_name, *sender, json.loads(message.fields_json)])
    print(line, flush=True)


def attitude(time_boot_ms: int) -> MavlinkMessage:
    """Level, to the east, at rest."""
    rest = {name: 0.0 for name in ("roll", "pitch", "rollspeed", "pitchspeed", "yawspeed")}
    fields = {"time_boot_ms": time_boot_ms, "yaw": YAW, **rest}
    return MavlinkMessage("ATTITUDE", SYSTEM, COMPONENT, 0, 0, json.dumps(fields))


if __name__ == "__main__":
    main(sys.argv[1])
