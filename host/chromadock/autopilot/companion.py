"""A well-behaved MAVLink component: what it says of itself, and what it answers.

No input, no output, no clock: messages and times come in, messages go out.  Who it is follows from
the vehicle: the same system, component ONBOARD_COMPUTER (191), never a ground station, whose
silence or presence an autopilot acts upon.  Nothing but its own heartbeat is said before the
vehicle's was heard, by MAVLink 2: by MAVLink 1 the place in a LANDING_TARGET would be missing, and
the dock be taken for straight ahead.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from pymavlink.dialects.v20 import common as mavlink

from chromadock import method
from chromadock.autopilot.history import Telemetry
from chromadock.autopilot.receivers import Receiver, misfit
from chromadock.autopilot.wire import MAVLINK1_START, Message
from chromadock.errors import ChromadockError
from chromadock.track.attitude import Attitude

COMPONENT = mavlink.MAV_COMP_ID_ONBOARD_COMPUTER
USUAL_SYSTEM = 1
"""Of nearly every vehicle; a heartbeat that must come before the vehicle's own is said from it."""

HEARTBEAT_S = 1.0
SILENCE_S = 5.0
"""Without the vehicle's heartbeat, after which it is not there."""

PATIENCE_S = 10.0
"""For the first heartbeat, before the user is told that there is none."""

MAVLINK1_S = 5.0
"""An autopilot that was set to MAVLink 2 may speak MAVLink 1 until it hears our heartbeat by 2
(ArduPilot: GCS_MAVLINK::packetReceived; PX4: MAV_PROTO_VER 0).  After this it will not any more."""

TELEMETRY_HZ = 20.0
"""What is asked for of the vehicle's own attitude and position."""

ASK_AGAIN_S = 5.0
"""After which too few of them are asked for again: an autopilot may have been restarted."""

_ENOUGH = 0.4
"""Share of what was asked for that will do."""

_MISSING = frozenset({"nobody", "silent", "failed"})
"""What is told of a vehicle that is not heard."""

_NO_VEHICLES = frozenset(
    {
        mavlink.MAV_TYPE_GCS,
        mavlink.MAV_TYPE_ONBOARD_CONTROLLER,
        mavlink.MAV_TYPE_GIMBAL,
        mavlink.MAV_TYPE_ADSB,
        mavlink.MAV_TYPE_CAMERA,
        mavlink.MAV_TYPE_ANTENNA_TRACKER,
    }
)
"""Types of heartbeats that are of no vehicle, even where they name an autopilot."""


@dataclass(frozen=True, slots=True)
class Vehicle:
    """Whose heartbeat was heard."""

    system: int
    component: int


class Companion:
    """One link's manners, for messages about ``receiver``.

    Parameters
    ----------
    receiver
        What the user says is there.
    name
        Of the link, for what is told to the user.
    start_s
        Now, seconds; as every time here, by one monotonic clock.
    speaks_first
        Whether its heartbeat must go out before anything was heard: a router that listens on a UDP
        port sends to those that have sent to it.

    Attributes
    ----------
    vehicle
        The one that is told; None while there is none, or only by MAVLink 1.
    telemetry
        Its attitude and position.
    notices
        Lines for the user, oldest first; whoever reads one takes it away.
    """

    def __init__(self, receiver: Receiver, name: str, start_s: float, speaks_first: bool) -> None:
        self.vehicle: Vehicle | None = None
        self.telemetry = Telemetry()
        self.notices: deque[str] = deque()
        self._receiver = receiver
        self._name = name
        self._speaks_first = speaks_first
        self._start_s = start_s
        self._system: int | None = None
        self._heard_s: float | None = None
        self._heartbeat_due_s = start_s
        self._mavlink1_s: float | None = None
        self._told: set[str] = set()
        self._arrivals_s: dict[str, deque[float]] = {
            name: deque(maxlen=round(TELEMETRY_HZ)) for name in _wanted(receiver)
        }
        self._ask_s: float | None = None

    @property
    def system(self) -> int:
        """Its system id: the vehicle's."""
        return USUAL_SYSTEM if self._system is None else self._system

    def present(self, now_s: float) -> bool:
        """Whether there is a vehicle that may be told something."""
        heard_s = self._heard_s
        return self.vehicle is not None and heard_s is not None and now_s - heard_s < SILENCE_S

    def failed(self, reason: str, now_s: float) -> None:
        """The port could not be opened or has gone away: the vehicle must be heard anew."""
        self._tell_once("failed", f"{reason}: it is tried again until the vehicle is heard")
        self.vehicle = self._heard_s = self._mavlink1_s = None
        self._start_s = now_s

    def heard(self, message: Message, now_s: float) -> list[Message]:
        """Take in a message that came at ``now_s``; what is answered."""
        kind = message.get_type()
        if kind == "HEARTBEAT":
            self._heartbeat(message, now_s)
            return []
        if kind == "TIMESYNC":
            return self._timesync(message, now_s)
        if kind == "PING":
            return self._ping(message)
        if kind == "COMMAND_LONG":
            return self._command(message)
        if kind in self._arrivals_s and self._from_vehicle(message):
            self._arrivals_s[kind].append(now_s)
            self._measured(kind, message, now_s)
        return []

    def due(self, now_s: float) -> list[Message]:
        """What is to be said at ``now_s`` without having been asked."""
        self._watch(now_s)
        messages = []
        someone = self._heard_s is not None or self._speaks_first
        if someone and now_s >= self._heartbeat_due_s:
            self._heartbeat_due_s = now_s + HEARTBEAT_S
            messages.append(_own_heartbeat())
        if self.present(now_s) and (self._ask_s is None or now_s >= self._ask_s):
            first, self._ask_s = self._ask_s is None, now_s + ASK_AGAIN_S
            messages += [
                self._interval(number)
                for name, number in _wanted(self._receiver).items()
                if first or not self._enough(name, now_s)
            ]
        return messages

    def _heartbeat(self, message: Message, now_s: float) -> None:
        if not _of_vehicle(message) or not self._ours(message, now_s):
            return
        was_there = self.present(now_s)
        self._system = message.get_srcSystem()
        self._heard_s = now_s
        if message.get_msgbuf()[0] == MAVLINK1_START:
            self.vehicle = None
            self._mavlink1_s = now_s if self._mavlink1_s is None else self._mavlink1_s
            if now_s - self._mavlink1_s >= MAVLINK1_S:
                self._tell_once(
                    "mavlink1",
                    "the vehicle speaks MAVLink 1, which has no place for the dock's position: "
                    "nothing is sent; set SERIALn_PROTOCOL (ArduPilot) or MAV_PROTO_VER (PX4) to 2",
                )
            return
        self._mavlink1_s = None
        self._told.discard("mavlink1")
        self.vehicle = Vehicle(message.get_srcSystem(), message.get_srcComponent())
        if not was_there:
            self._ask_s = None
            if self._told & _MISSING:
                self._told -= _MISSING
                self._say(f"heard the vehicle, system {self.system}")
        wrong = misfit(self._receiver, message.type, message.autopilot)
        if wrong is not None:
            self._tell_once("misfit", wrong)

    def _ours(self, message: Message, now_s: float) -> bool:
        """Whether a vehicle's heartbeat is of the one that is told: the first that was heard, until
        it falls silent."""
        if self._heard_s is None or now_s - self._heard_s >= SILENCE_S:
            return True
        return bool(message.get_srcSystem() == self._system)

    def _from_vehicle(self, message: Message) -> bool:
        sender = (message.get_srcSystem(), message.get_srcComponent())
        vehicle = self.vehicle
        return vehicle is not None and sender == (vehicle.system, vehicle.component)

    def _measured(self, kind: str, m: Message, now_s: float) -> None:
        if kind == "LOCAL_POSITION_NED":
            position, velocity = (m.x, m.y, m.z), (m.vx, m.vy, m.vz)
            self.telemetry.heard_position(m.time_boot_ms, now_s, position, velocity)
            return
        try:
            angles = Attitude(m.roll, m.pitch, m.yaw)
        except ChromadockError:  # no numbers: its filter has not begun
            return
        rates = (m.rollspeed, m.pitchspeed, m.yawspeed)
        self.telemetry.heard_attitude(m.time_boot_ms, now_s, angles, rates)

    def _timesync(self, message: Message, now_s: float) -> list[Message]:
        if message.tc1 != 0:  # an answer, to somebody else's question
            return []
        return [mavlink.MAVLink_timesync_message(tc1=round(now_s * 1e9), ts1=message.ts1)]

    def _ping(self, message: Message) -> list[Message]:
        if (message.target_system, message.target_component) != (0, 0):
            return []
        sender = message.get_srcSystem(), message.get_srcComponent()
        return [mavlink.MAVLink_ping_message(message.time_usec, message.seq, *sender)]

    def _command(self, message: Message) -> list[Message]:
        """Who it is; of other commands that it has none, if it was asked by name."""
        if self._system is None or message.target_system not in (0, self._system):
            return []
        if message.target_component not in (0, COMPONENT):
            return []
        asked = message.command, message.param1
        known = asked in (
            (mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION),
            (mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1),
        )
        if known:
            accepted = mavlink.MAV_RESULT_ACCEPTED
            return [_acknowledged(message, accepted), _version()]
        if message.target_component == COMPONENT:
            return [_acknowledged(message, mavlink.MAV_RESULT_UNSUPPORTED)]
        return []

    def _interval(self, number: int) -> Message:
        """Asks the vehicle for a message, ``TELEMETRY_HZ`` times a second."""
        assert self.vehicle is not None
        return mavlink.MAVLink_command_long_message(
            self.vehicle.system,
            self.vehicle.component,
            mavlink.MAV_CMD_SET_MESSAGE_INTERVAL,
            0,
            number,
            1e6 / TELEMETRY_HZ,
            *[0.0] * 5,
        )

    def _enough(self, name: str, now_s: float) -> bool:
        recent = [arrival_s for arrival_s in self._arrivals_s[name] if now_s - arrival_s < 1.0]
        return len(recent) >= _ENOUGH * TELEMETRY_HZ

    def _watch(self, now_s: float) -> None:
        """Tell the user what is missing."""
        if self._heard_s is None:
            if now_s - self._start_s >= PATIENCE_S:
                self._tell_once(
                    "nobody",
                    "no heartbeat of a vehicle: check the address, and that the autopilot or the "
                    "router sends there",
                )
            return
        if now_s - self._heard_s >= SILENCE_S:
            self._tell_once("silent", f"no heartbeat for {SILENCE_S:.0f} s: nothing is sent")
            return
        for name, arrivals_s in self._arrivals_s.items():
            if arrivals_s and now_s - arrivals_s[-1] < SILENCE_S:
                self._told.discard(name)
            elif self.vehicle is not None and self._needs(name, now_s):
                self._tell_once(
                    name,
                    f"the vehicle sends no {name}, without which receiver={self._receiver.name} "
                    "cannot be told much: check that nothing on the way holds it back",
                )

    def _needs(self, name: str, now_s: float) -> bool:
        asked = self._ask_s is not None and now_s >= self._ask_s - 0.5
        return asked and (name != "ATTITUDE" or self._receiver.needs_attitude)

    def _say(self, words: str) -> None:
        self.notices.append(f"{self._name}: {words}")

    def _tell_once(self, what: str, words: str) -> None:
        if what not in self._told:
            self._told.add(what)
            self._say(words)


def _wanted(receiver: Receiver) -> dict[str, int]:
    """Messages of the vehicle that are listened to, with their ids."""
    wanted = {"ATTITUDE": mavlink.MAVLINK_MSG_ID_ATTITUDE}
    if receiver.absolute:
        wanted["LOCAL_POSITION_NED"] = mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED
    return wanted


def _of_vehicle(message: Message) -> bool:
    return message.autopilot != mavlink.MAV_AUTOPILOT_INVALID and message.type not in _NO_VEHICLES


def _own_heartbeat() -> Message:
    return mavlink.MAVLink_heartbeat_message(
        mavlink.MAV_TYPE_ONBOARD_CONTROLLER,
        mavlink.MAV_AUTOPILOT_INVALID,
        0,
        0,
        mavlink.MAV_STATE_ACTIVE,
        3,
    )


def status_text(words: str) -> Message:
    """At most 50 letters that every ground station shows to the crew."""
    return mavlink.MAVLink_statustext_message(mavlink.MAV_SEVERITY_INFO, words.encode())


def _acknowledged(command: Message, result: int) -> Message:
    return mavlink.MAVLink_command_ack_message(
        command.command,
        result,
        target_system=command.get_srcSystem(),
        target_component=command.get_srcComponent(),
    )


def _version() -> Message:
    digest = list(bytes.fromhex(method.DIGEST)[::-1])
    nothing = [0] * 8
    return mavlink.MAVLink_autopilot_version_message(
        capabilities=mavlink.MAV_PROTOCOL_CAPABILITY_MAVLINK2,
        flight_sw_version=0,
        middleware_sw_version=0,
        os_sw_version=0,
        board_version=0,
        flight_custom_version=nothing,
        # Low byte first, as the dock says it of itself.
        middleware_custom_version=digest,
        os_custom_version=nothing,
        vendor_id=0,
        product_id=0,
        uid=0,
    )
