"""Who can be told where the dock is, and which messages each of them listens to.

What an autopilot does with a message is not what the message's definition says: each firmware has
axes and conditions of its own (docs/autopilot.md has them with their sources).  So the user names
the receiver, not a frame.
"""

from __future__ import annotations

from dataclasses import dataclass

from pymavlink.dialects.v20 import common as mavlink

_MULTICOPTERS = frozenset(
    {
        mavlink.MAV_TYPE_QUADROTOR,
        mavlink.MAV_TYPE_COAXIAL,
        mavlink.MAV_TYPE_HELICOPTER,
        mavlink.MAV_TYPE_HEXAROTOR,
        mavlink.MAV_TYPE_OCTOROTOR,
        mavlink.MAV_TYPE_TRICOPTER,
        mavlink.MAV_TYPE_DODECAROTOR,
        mavlink.MAV_TYPE_DECAROTOR,
        mavlink.MAV_TYPE_GENERIC_MULTIROTOR,
    }
)
_VTOLS = frozenset(range(mavlink.MAV_TYPE_VTOL_DUOROTOR, mavlink.MAV_TYPE_VTOL_RESERVED5 + 1))


@dataclass(frozen=True, slots=True)
class Receiver:
    """One kind of autopilot.

    Attributes
    ----------
    name
        What the user writes.
    landing_target
        Whether it uses LANDING_TARGET; ArduSub drops it without a word.
    vision
        The message by which it takes its own position from a camera.
    vision_by_default
        Whether that is sent unless the user says otherwise: where it is the only way, or does no
        harm beside another source of position.
    autopilot, vehicles
        MAV_AUTOPILOT and the MAV_TYPEs of its heartbeat; any type where there are none.
    absolute
        Whether its LANDING_TARGET is the dock's place in the vehicle's local frame.
    """

    name: str
    landing_target: bool
    vision: str
    vision_by_default: bool
    autopilot: int
    vehicles: frozenset[int]
    absolute: bool = False

    @property
    def needs_attitude(self) -> bool:
        """Whether it is told nothing at all without the vehicle's attitude."""
        return not self.landing_target or self.absolute


_ARDUPILOT, _PX4 = mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA, mavlink.MAV_AUTOPILOT_PX4

ROVER = Receiver(
    "ardupilot-rover",
    landing_target=True,
    vision="VISION_POSITION_ESTIMATE",
    vision_by_default=False,
    autopilot=_ARDUPILOT,
    vehicles=frozenset({mavlink.MAV_TYPE_GROUND_ROVER, mavlink.MAV_TYPE_SURFACE_BOAT}),
)
COPTER = Receiver(
    "ardupilot-copter",
    landing_target=True,
    vision="VISION_POSITION_ESTIMATE",
    vision_by_default=False,
    autopilot=_ARDUPILOT,
    # A QuadPlane calls itself a fixed wing or a VTOL.
    vehicles=_MULTICOPTERS | _VTOLS | {mavlink.MAV_TYPE_FIXED_WING},
)
SUB = Receiver(
    "ardusub",
    landing_target=False,
    vision="VISION_POSITION_ESTIMATE",
    vision_by_default=True,
    autopilot=_ARDUPILOT,
    vehicles=frozenset({mavlink.MAV_TYPE_SUBMARINE}),
)
PX4 = Receiver(
    "px4",
    landing_target=True,
    vision="ODOMETRY",
    vision_by_default=True,
    autopilot=_PX4,
    vehicles=frozenset(),
    absolute=True,
)

RECEIVERS = {receiver.name: receiver for receiver in (SUB, ROVER, COPTER, PX4)}
"""By the name that the user writes."""


def misfit(receiver: Receiver, mav_type: int, autopilot: int) -> str | None:
    """What is wrong where a vehicle's heartbeat is not one of this receiver, in one line.

    Parameters
    ----------
    mav_type, autopilot : MAV_TYPE and MAV_AUTOPILOT of the heartbeat.

    Returns
    -------
    None where all is well.
    """
    if _fits(receiver, mav_type, autopilot):
        return None
    says = f"the vehicle says {_name('MAV_TYPE', mav_type)} of {_name('MAV_AUTOPILOT', autopilot)}"
    better = _fitting(mav_type, autopilot)
    if better is None:
        return f"{says}, receiver={receiver.name} is for another: messages may be misread"
    reason = ""
    if better is SUB and receiver.landing_target:
        reason = ", which ignores LANDING_TARGET"
    return f"{says}{reason}, receiver={receiver.name} is for another: give receiver={better.name}"


def _fitting(mav_type: int, autopilot: int) -> Receiver | None:
    """The receiver that such a vehicle is."""
    fitting = (r for r in RECEIVERS.values() if _fits(r, mav_type, autopilot))
    return next(fitting, None)


def _fits(receiver: Receiver, mav_type: int, autopilot: int) -> bool:
    known = not receiver.vehicles or mav_type in receiver.vehicles
    return known and autopilot == receiver.autopilot


def _name(enum: str, value: int) -> str:
    """``MAV_TYPE_SUBMARINE (12)``."""
    entry = mavlink.enums[enum].get(value)
    return f"{enum} {value}" if entry is None else f"{entry.name} ({value})"
