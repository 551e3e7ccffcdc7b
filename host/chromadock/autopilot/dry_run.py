"""In words, what an autopilot would believe of a frame: nothing is sent."""

from __future__ import annotations

from chromadock.autopilot.frame_messages import frame_messages
from chromadock.autopilot.landing_target import plnd_orient
from chromadock.autopilot.settings import AutopilotSettings
from chromadock.autopilot.understood import understood
from chromadock.autopilot.wire import decoded
from chromadock.mounting import Mounting
from chromadock.results.track import Track, Vector
from chromadock.track.attitude import Attitude


def dry_run(
    settings: AutopilotSettings,
    time_s: float,
    track: Track,
    mounting: Mounting,
    attitude: Attitude | None = None,
    position: Vector | None = None,
) -> list[str]:
    """A line for each message of a frame: ``LANDING_TARGET: dock 4.0 m ahead, 0.5 m right``.

    Not of the pose, but of the message as it would come out at the other end, read by the rules of
    the receiver's own firmware (``understood``), whose parameters are as docs/autopilot.md says.

    Parameters
    ----------
    time_s : of the frame, seconds, any clock.
    track : that of the frame; it makes no line unless it is ``tracking``.
    mounting : how the camera sits in the vehicle.
    attitude, position : the vehicle's then, where they are known; see ``landing_target``.
    """
    receiver = settings.receiver
    messages = frame_messages(
        receiver, settings.vision, time_s, track, mounting, attitude, position, reset_counter=0
    )
    orient = plnd_orient(receiver, mounting)
    lines = [
        f"{message.get_type()}: {understood(receiver, decoded(message), orient).words}"
        for message in messages
    ]
    known = attitude is not None and attitude.yaw_rad is not None
    if track.state == "tracking" and track.pose is not None and not known:
        needing = [receiver.vision] if settings.vision else []
        needing += ["LANDING_TARGET"] if receiver.absolute else []
        lines += [f"{name}: not sent, for want of the vehicle's ATTITUDE" for name in needing]
    return lines
