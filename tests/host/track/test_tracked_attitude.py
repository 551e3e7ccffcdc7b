"""What the vehicle's attitude does to the track, and which attitudes are none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from track_run import Run, nothing
from track_truth import CAMERA, DOCK, found

from chromadock import Attitude, ChromadockError, Tracker


def test_the_vehicles_attitude_turns_the_prediction() -> None:
    """It begins to turn right at once; the bearing goes left with it, though nothing was seen."""
    run = Run()
    for _ in range(20):
        run.frame(lambda time_s, plan: found((np.eye(3), np.array([0, 0, 4.0])), run.rng),
                  Attitude(0.0, 0.0, 0.0))  # fmt: skip
    tracks = [run.frame(nothing, Attitude(0.0, 0.0, 0.04 * (k + 1))) for k in range(4)]
    assert tracks[-1].pose is not None
    bearing = np.arctan2(tracks[-1].pose.t[0], tracks[-1].pose.t[2])
    assert bearing == pytest.approx(-0.16, abs=0.12)


def test_motion_and_the_heading_tell_the_two_poses_apart(record_property: Any) -> None:
    """Passing a far dock: the wrong pose would have it turn as the vehicle moves on."""
    right = {}
    for heading in (None, 0.0):
        turns = []
        for seed in range(8):
            tracker, rng = Tracker(DOCK), np.random.default_rng(seed)
            for k in range(61):
                pose = (np.eye(3), np.array([1.2 - 0.04 * k, 0.1, 6.0]))
                track = tracker.update(
                    0.1 * k, tracker.plan(0.1 * k), found(pose, rng), CAMERA,
                    Attitude(0.0, 0.0, heading),
                )  # fmt: skip
            assert track.pose is not None
            turns.append(abs(np.degrees(2 * np.arcsin(track.pose.q_wxyz[2]))))
        right[heading] = sum(t < 8 for t in turns)
    record_property(
        "figure",
        f"track: passing at 6 m, the right pose in {right[0.0]} of 8 runs with the heading, "
        f"{right[None]} without",
    )
    assert right[0.0] == 8
    assert right[0.0] >= right[None]


@pytest.mark.parametrize("angles", [(np.nan, 0.0, None), (0.0, np.inf, None), (0.0, 0.0, np.nan)])
def test_an_attitude_that_is_no_number_is_refused(angles: tuple[float, float, float]) -> None:
    with pytest.raises(ChromadockError, match="radians"):
        Attitude(*angles)


def test_an_attitude_in_degrees_is_refused() -> None:
    with pytest.raises(ChromadockError, match="radians, not degrees"):
        Attitude(2.0, -12.0)
    assert Attitude(0.0, 0.0, 400.0).yaw_rad == 400.0  # a yaw may be counted on
