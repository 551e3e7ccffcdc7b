"""What the track says of the dock at one moment."""

from __future__ import annotations

from dataclasses import dataclass

from chromadock.rotation import quaternion_from_matrix
from chromadock.track.bank import Hypothesis
from chromadock.track.motion import POSE

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class TrackedPose:
    """``T_camera_dock`` by all frames together: the dock in the camera frame (OpenCV).

    ``t`` in metres; ``q_wxyz`` a unit quaternion that turns dock axes into camera axes;
    ``covariance`` 6 x 6 by rows, as that of ``detection.Pose``; ``weight`` 0..1: how probable this
    pose is, among those that the markers leave open.
    """

    t: Vector
    q_wxyz: tuple[float, float, float, float]
    covariance: tuple[float, ...]
    weight: float

    @classmethod
    def of(cls, hypothesis: Hypothesis) -> TrackedPose:
        """The pose of a hypothesis."""
        state = hypothesis.state
        return cls(
            _vector(state.t.tolist()),
            quaternion_from_matrix(state.R),
            tuple(state.covariance[POSE, POSE].ravel().tolist()),
            hypothesis.weight,
        )


@dataclass(frozen=True, slots=True)
class Track:
    """The dock at ``time_s``, by the frames up to it.

    ``state``: one of ``states.STATES``.  ``pose``: while the dock is tracked, and after that for
    as long as its place is known well enough (``states.MOST_DOUBT_KEPT``), else None;
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

    @classmethod
    def following(
        cls, state: str, time_s: float, hypotheses: tuple[Hypothesis, ...], age_s: float
    ) -> Track:
        """Of a dock that is locked; the first hypothesis leads."""
        first, *others = hypotheses
        return cls(
            state,
            time_s,
            TrackedPose.of(first),
            TrackedPose.of(max(others, key=lambda h: h.weight)) if others else None,
            _vector(first.state.velocity.tolist()),
            _vector(first.state.turn_rate.tolist()),
            age_s,
        )


def _vector(values: list[float]) -> Vector:
    x, y, z = values
    return x, y, z
