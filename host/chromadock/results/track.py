"""What the track says of the dock at one moment."""

from __future__ import annotations

from dataclasses import dataclass

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class TrackedPose:
    """``T_camera_dock`` by all frames together: the dock in the camera frame (OpenCV).

    ``t`` in metres; ``q_wxyz`` a unit quaternion that turns dock axes into camera axes;
    ``covariance`` 6 x 6 by rows, as that of ``pose.Pose``; ``weight`` 0..1: how probable this
    pose is, among those that the markers leave open.
    """

    t: Vector
    q_wxyz: tuple[float, float, float, float]
    covariance: tuple[float, ...]
    weight: float


@dataclass(frozen=True, slots=True)
class Track:
    """The dock at ``time_s``, by the frames up to it.

    ``state``: one of ``track.states.STATES``.  ``pose``: while the dock is tracked, and after that,
    for as long as its place is known well enough (``track.states``: the most doubt), else None;
    ``alternative``: the next likeliest, until the data have decided.  ``velocity``
    m/s and ``turn_rate`` rad/s: of the dock as seen by a camera that does not turn, and of the
    camera, both in camera axes.  ``age_s``: since the dock was last measured; None before it was.
    """

    state: str
    time_s: float
    pose: TrackedPose | None = None
    alternative: TrackedPose | None = None
    velocity: Vector | None = None
    turn_rate: Vector | None = None
    age_s: float | None = None
