"""When the reset counter counts on, and what the crew is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from autopilot_truth import pose_at, tracked, turned
from track_truth import CAMERA, DOCK, NOTHING, approach, found

from chromadock import Track, Tracker
from chromadock.autopilot.lock import Lock
from chromadock.autopilot.pace import Pace

POSE = pose_at((4.0, 0.5, 0.2))
OTHER = pose_at((4.0, 0.5, 0.2), R_camera_dock=turned(0, 30, 0))


def counts(*tracks: Track) -> list[int]:
    lock, numbers = Lock(reset_counter=254), []
    for track in tracks:
        lock = lock.after(track)
        numbers.append(lock.reset_counter)
    return numbers


def test_each_new_lock_counts_on_by_one_within_a_byte() -> None:
    lost = Track("lost", 1.5)
    assert counts(
        Track("never_seen", 0.0), Track("acquiring", 0.5), tracked(1.0, POSE), tracked(1.1, POSE),
        lost, tracked(2.0, POSE), Track("acquiring", 2.5), tracked(3.0, POSE),
    ) == [254, 254, 255, 255, 255, 0, 0, 1]  # fmt: skip


def test_a_dock_that_was_hidden_for_a_moment_is_no_new_lock() -> None:
    hidden = tracked(1.2, POSE, state="recently_lost", age_s=0.5)
    assert counts(tracked(1.0, POSE), hidden, tracked(1.4, POSE)) == [255, 255, 255]


def test_the_step_to_the_other_planar_pose_counts() -> None:
    before = tracked(1.0, POSE, alternative=OTHER)
    after = tracked(1.1, OTHER, alternative=POSE)
    assert counts(before, after, replace(after, time_s=1.2)) == [255, 0, 0]
    # The vehicle may turn as much: it is the same pose where that was no alternative.
    assert counts(tracked(1.0, POSE), tracked(1.1, OTHER)) == [255, 255]


def test_another_dock_in_the_place_of_the_first_counts_and_motion_does_not() -> None:
    near = pose_at((3.0, 0.5, 0.2))
    assert counts(tracked(1.0, POSE), tracked(1.1, near)) == [255, 0]
    # The same step at ten metres a second, which the track had told.
    forward = tracked(1.0, POSE, velocity=(0.0, 0.0, -10.0))
    assert counts(forward, tracked(1.1, near)) == [255, 255]
    # A camera that turns to the right, about its y, sees the dock go to the left.
    turning = tracked(1.0, POSE, turn_rate=(0.0, 2.0, 0.0))
    left = tracked(1.1, pose_at((4.0, -0.3, 0.2)))
    assert counts(turning, left) == [255, 255]
    assert counts(tracked(1.0, POSE), left) == [255, 0]


def test_a_recording_that_begins_again_counts() -> None:
    assert counts(tracked(9.0, POSE), tracked(1.0, POSE), tracked(1.1, POSE)) == [255, 0, 0]


def test_a_dock_that_is_hidden_for_long_is_locked_anew_once() -> None:
    """By the tracker itself, with noise, which flips the pose once at first, from afar."""
    tracker, rng, lock, numbers = Tracker(DOCK), np.random.default_rng(3), Lock(), []
    for k in range(75):
        time_s = k / 10
        seen = NOTHING if 3.0 <= time_s < 6.0 else found(approach(time_s), rng)
        track = tracker.update(time_s, tracker.plan(time_s), seen, CAMERA)
        lock = lock.after(track)
        numbers.append(lock.reset_counter)
    assert numbers[2] == 1 and numbers[5:60] == [2] * 55 and numbers[-1] == 3


def words(*tracks: Track) -> list[str | None]:
    lock, said = Lock(), []
    for track in tracks:
        lock, text = lock.after(track).announcing(track)
        said.append(text)
    return said


def test_the_crew_is_told_once_that_the_dock_is_locked_and_once_that_it_is_lost() -> None:
    far = pose_at((4.1, 0.0, 0.0))
    hidden = tracked(2.0, far, state="recently_lost", age_s=1.0)
    said = words(
        Track("acquiring", 0.0), tracked(1.0, far), tracked(1.1, far), hidden, tracked(2.1, far),
        Track("acquiring", 2.2), tracked(2.3, far), Track("lost", 5.0), Track("lost", 5.1),
        tracked(6.0, far),
    )  # fmt: skip
    locked, lost = "Chromadock: dock locked, 4.1 m", "Chromadock: dock lost"
    assert said == [None, locked, None, None, None, None, None, lost, None, locked]
    assert len(locked) <= 50


def test_no_more_frames_are_told_than_the_rate_in_the_mean() -> None:
    for fps, rate_hz, told in ((30, 15, 150), (20, 15, 150), (25, 10, 100), (8, 15, 80)):
        pace = Pace(rate_hz)
        count = sum(pace.take(100 + k / fps) for k in range(fps * 10))
        assert abs(count - told) <= 1, (fps, rate_hz)


def test_a_pause_of_the_camera_is_not_made_up_for() -> None:
    pace = Pace(10.0)
    assert pace.take(0.0)
    late = [pace.take(5.0 + k / 100) for k in range(20)]
    assert sum(late) == 3 and late[0]


def test_frames_of_a_recording_that_begins_again_are_told() -> None:
    pace = Pace(10.0)
    assert pace.take(50.0) and pace.take(1.0) and not pace.take(1.02)
