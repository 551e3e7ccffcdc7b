"""What a receiver makes of a message, by the rules of its own firmware.

Written from the receivers' sources and not from what is sent, so that it can be held against it: in
the tests, and in a dry run, which says in words what the autopilot will believe.  Each rule names
its source; ``docs/autopilot.md`` has them in one table.  None was run on an autopilot.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from pymavlink.dialects.v20 import common as mavlink

from chromadock.autopilot.landing_target import BACK, DOWN, FORWARD
from chromadock.autopilot.receivers import RECEIVERS, Receiver
from chromadock.autopilot.wire import Message
from chromadock.results.track import Vector

VISO_POS_M_NSE = 0.2
"""Metres: the least error of a visual position in ArduPilot, as that parameter stands there."""

MOST_ERROR_M = 100.0
"""The most that it takes an error for."""

_BODY = (("ahead", "behind"), ("right", "left"), ("below", "above"))
_NED = (("north", "south"), ("east", "west"), ("below", "above"))
_LEAST_M = 0.05
"""What rounds to nothing in a message of one digit."""


@dataclass(frozen=True, slots=True)
class Understood:
    """``place`` (x, y, z), metres: of the ``dock`` in the vehicle's axes (forward, right, down), or
    of the ``dock`` or the ``vehicle`` in north, east, down from ``origin``; None where nothing is
    taken, and ``words`` then say why.  ``error_m``: standard deviation that the receiver believes;
    None where it does not say.
    """

    what: str
    words: str
    place: Vector | None = None
    error_m: float | None = None

    @property
    def taken(self) -> bool:
        """Whether the receiver uses the message at all."""
        return self.place is not None


def understood(receiver: Receiver, message: Message, orient: int | None = None) -> Understood:
    """What ``receiver`` takes from ``message``, which has been on the wire.

    Parameters
    ----------
    message : as ``wire.decoded`` gives it.
    orient : the autopilot's PLND_ORIENT; its default, 0 for a Rover and 25 for others, where None.
    """
    kind = message.get_type()
    rule = _RULES.get((receiver.name, kind))
    if rule is None:
        return _nothing(f"{receiver.name} ignores {kind}")
    if orient is None:
        orient = FORWARD if receiver.name == "ardupilot-rover" else DOWN
    return rule(message, orient)


def _ardupilot_landing_target(message: Message, orient: int) -> Understood:
    """AC_PrecLand_MAVLink::handle_msg (2b30683d), AC_PrecLand::retrieve_los_meas and
    construct_pos_meas_using_rangefinder (01c6d5da)."""
    if message.position_valid == 1:
        # Newer firmware takes MAV_FRAME_LOCAL_FRD (20) as well.
        if message.frame != mavlink.MAV_FRAME_BODY_FRD:
            return _nothing(f"dropped: frame {message.frame}, it says 'Plnd: Frame not supported'")
        if not message.distance > 0:
            return _nothing("dropped without a word: the distance is not more than 0")
        line = _scaled((message.x, message.y, message.z), 1 / message.distance)
    else:
        line = (-math.tan(message.angle_y), math.tan(message.angle_x), 1.0)
        line = _scaled(line, 1 / math.hypot(*line))
        if not message.distance > 0:
            return _nothing("a direction without a distance: a rangefinder would be needed")
    if orient != DOWN:
        x, y, z = line
        line = (z, y, -x)  # Vector3::rotate(ROTATION_PITCH_90)
        if orient == BACK:
            x, y, z = line
            line = (-x, -y, z)  # ROTATION_YAW_180
    approach: Vector = {FORWARD: (1.0, 0.0, 0.0), BACK: (-1.0, 0.0, 0.0)}.get(
        orient, (0.0, 0.0, 1.0)
    )
    if not sum(a * b for a, b in zip(line, approach, strict=True)) > 0:
        return _nothing("dropped without a word: it is not on the side that the camera looks to")
    place = _scaled(line, message.distance)
    return Understood("dock", f"dock {_spoken(place, _BODY)}", place)


def _px4_landing_target(message: Message, _orient: int) -> Understood:
    """MavlinkReceiver::handle_message_landing_target (PX4-Autopilot#17354)."""
    if message.position_valid:
        if message.frame != mavlink.MAV_FRAME_LOCAL_NED:
            return _nothing(
                f"dropped: 'landing target: coordinate frame {message.frame} unsupported'"
            )
        place = (message.x, message.y, message.z)
        return Understood("dock", f"dock, from the local origin: {_spoken(place, _NED)}", place)
    return _nothing("taken for an IR-LOCK's: a direction below the vehicle; no distance is read")


def _ardupilot_vision(message: Message, _orient: int) -> Understood:
    """GCS_MAVLINK::handle_vision_position_estimate and AP_VisualOdom_MAV::handle_pose_estimate."""
    error_m = _ardupilot_error(message.covariance)
    return _vehicle((message.x, message.y, message.z), error_m)


def _ardupilot_odometry(message: Message, _orient: int) -> Understood:
    """GCS_MAVLINK::handle_odometry: these two frames exactly, others return without a word."""
    frames = (message.frame_id, message.child_frame_id)
    if frames != (mavlink.MAV_FRAME_LOCAL_FRD, mavlink.MAV_FRAME_BODY_FRD):
        return _nothing(f"dropped without a word: frames {frames[0]} and {frames[1]}")
    error_m = _ardupilot_error(message.pose_covariance)
    return _vehicle((message.x, message.y, message.z), error_m)


def _ardupilot_error(covariance: list[float]) -> float:
    """posErr: the sum of the variances' root, unless the first is NaN, between its bounds."""
    if math.isnan(covariance[0]):
        return VISO_POS_M_NSE
    total = covariance[0] + covariance[6] + covariance[11]
    if math.isnan(total):
        return math.nan
    return min(max(math.sqrt(total), VISO_POS_M_NSE), MOST_ERROR_M)


def _px4_vision(message: Message, _orient: int) -> Understood:
    """MavlinkReceiver::handle_message_vision_position_estimate."""
    return _vehicle((message.x, message.y, message.z), _px4_error(message.covariance))


def _px4_odometry(message: Message, _orient: int) -> Understood:
    """MavlinkReceiver::handle_message_odometry."""
    place = (message.x, message.y, message.z)
    if not all(map(math.isfinite, place)):
        return _nothing("no position: it is not finite")
    if message.frame_id not in (mavlink.MAV_FRAME_LOCAL_NED, mavlink.MAV_FRAME_LOCAL_FRD):
        return _nothing(f"frame {message.frame_id} is not one that a camera here would give")
    if message.estimator_type not in (
        mavlink.MAV_ESTIMATOR_TYPE_UNKNOWN,
        mavlink.MAV_ESTIMATOR_TYPE_VISION,
        mavlink.MAV_ESTIMATOR_TYPE_VIO,
    ):
        return _nothing(f"dropped: 'ODOMETRY: estimator_type {message.estimator_type} unsupported'")
    return _vehicle(place, _px4_error(message.pose_covariance))


def _px4_error(covariance: list[float]) -> float:
    """The largest of the axes: it takes each one's variance by itself."""
    return math.sqrt(max(covariance[0], covariance[6], covariance[11]))


def _vehicle(place: Vector, error_m: float) -> Understood:
    if math.isnan(error_m):
        return _nothing("the error is not a number: one of the variances is NaN but not the first")
    words = f"vehicle, from the dock: {_spoken(place, _NED)}; to {error_m:.2f} m"
    return Understood("vehicle", words, place, error_m)


def _nothing(why: str) -> Understood:
    return Understood("", why)


def _scaled(vector: Vector, factor: float) -> Vector:
    x, y, z = vector
    return x * factor, y * factor, z * factor


def _spoken(place: Vector, axes: tuple[tuple[str, str], ...]) -> str:
    """``4.0 m ahead, 0.5 m right, 0.2 m below``."""
    words = [
        f"{abs(value):.1f} m {names[value < 0]}"
        for value, names in zip(place, axes, strict=True)
        if not abs(value) < _LEAST_M
    ]
    return ", ".join(words) or "here"


_Rule = Callable[[Message, int], Understood]
_RULES: dict[tuple[str, str], _Rule] = {
    ("px4", "LANDING_TARGET"): _px4_landing_target,
    ("px4", "VISION_POSITION_ESTIMATE"): _px4_vision,
    ("px4", "ODOMETRY"): _px4_odometry,
    # Sub has no AC_PrecLand (ArduSub/GCS_MAVLink_Sub.h, 04dc0b71).
    ("ardupilot-rover", "LANDING_TARGET"): _ardupilot_landing_target,
    ("ardupilot-copter", "LANDING_TARGET"): _ardupilot_landing_target,
    **{
        (name, "VISION_POSITION_ESTIMATE"): _ardupilot_vision
        for name, receiver in RECEIVERS.items()
        if name != "px4"
    },
    **{(name, "ODOMETRY"): _ardupilot_odometry for name in RECEIVERS if name != "px4"},
}
"""By receiver and message; what is not here is ignored."""
