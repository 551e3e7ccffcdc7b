"""The track's result: what the user gets of a bank of hypotheses."""

from __future__ import annotations

from chromadock.results.track import Track, TrackedPose, Vector
from chromadock.rotation import quaternion_from_matrix
from chromadock.track.bank import Hypothesis
from chromadock.track.motion import POSE


def following(state: str, time_s: float, hypotheses: tuple[Hypothesis, ...], age_s: float) -> Track:
    """Of a dock that is locked; the first hypothesis leads."""
    first, *others = hypotheses
    return Track(
        state,
        time_s,
        tracked_pose(first),
        tracked_pose(max(others, key=lambda h: h.weight)) if others else None,
        _vector(first.state.velocity.tolist()),
        _vector(first.state.turn_rate.tolist()),
        age_s,
    )


def tracked_pose(hypothesis: Hypothesis) -> TrackedPose:
    """The pose of a hypothesis."""
    state = hypothesis.state.as_told
    return TrackedPose(
        _vector(state.t.tolist()),
        quaternion_from_matrix(state.R),
        tuple(state.covariance[POSE, POSE].ravel().tolist()),
        hypothesis.weight,
    )


def _vector(values: list[float]) -> Vector:
    x, y, z = values
    return x, y, z
