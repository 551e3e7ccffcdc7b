"""All that is told about one frame."""

from __future__ import annotations

from chromadock.autopilot.landing_target import landing_target
from chromadock.autopilot.receivers import Receiver
from chromadock.autopilot.vision import vision_message
from chromadock.autopilot.wire import Message
from chromadock.mounting import Mounting
from chromadock.results.track import Track, Vector
from chromadock.track.attitude import Attitude


def frame_messages(
    receiver: Receiver,
    vision: bool,
    time_s: float,
    track: Track,
    mounting: Mounting,
    attitude: Attitude | None,
    position: Vector | None,
    reset_counter: int,
) -> list[Message]:
    """The messages about a track at ``time_s``, empty unless it is ``tracking``.

    LANDING_TARGET only of a frame that measured the dock: the receiver's own filter coasts on the
    accelerometers, better than a prediction of ours would, and must see the dock missing.  The
    vehicle's position, where ``vision`` says so, through hidden moments too, by the prediction
    with its grown covariance: without one for 300 ms ArduPilot takes the source for dead.

    Parameters
    ----------
    time_s : of the frame, seconds, on the clock of all messages of the link.
    track : that of the frame.
    attitude, position : the vehicle's then, where they are known; see ``landing_target``.
    reset_counter : see ``lock.Lock``.
    """
    messages: list[Message] = []
    if track.state != "tracking" or track.pose is None:
        return messages
    if receiver.landing_target and track.age_s == 0.0:
        target = landing_target(receiver, time_s, track.pose, mounting, attitude, position)
        if target is not None:
            messages.append(target)
    if vision and attitude is not None and attitude.yaw_rad is not None:
        messages.append(
            vision_message(receiver, time_s, track.pose, mounting, attitude, reset_counter)
        )
    return messages
