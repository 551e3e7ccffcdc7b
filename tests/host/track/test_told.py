"""When a dock that is locked has a pose: not before its place is known well enough."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from track_run import Run
from track_truth import CAMERA, DOCK, approach, found, rotation

from chromadock import DockGeometry, Tracker
from chromadock.geometry.pose import Sighting, estimates
from chromadock.look import Found
from chromadock.track.bank import Bank, Hypothesis
from chromadock.track.states import MOST_DOUBT, MOST_ELSEWHERE


def test_a_dock_whose_range_is_not_known_yet_is_locked_without_a_pose() -> None:
    """Locked from afar, where a tenth of a pixel is several per cent of the range."""
    run = Run()
    far = rotation(0, 0, 0), np.array([0.2, 0.1, 30.0])
    states = [run.frame(lambda t, p: found(far, run.rng)).state for _ in range(8)]
    assert states[-1] == "acquiring"
    assert run.tracker.at(run.time_s).pose is None
    near = rotation(0, 12, 0), np.array([0.2, 0.1, 3.0])
    run = Run()
    states = [run.frame(lambda t, p: found(near, run.rng)).state for _ in range(8)]
    assert states[-1] == "tracking"


def test_a_pose_is_told_where_the_origin_is_not_as_sure_as_the_centroid() -> None:
    """Of three markers that leave two attitudes open, far apart, the centroid is at one place and
    a marker at two."""
    told = {}
    for name, shift in (("centroid", DOCK.points[:3].mean(axis=0)), ("marker", DOCK.points[1])):
        three = DockGeometry(DOCK.names[:3], DOCK.points[:3] - shift)
        tracker, rng, told[name] = Tracker(three), np.random.default_rng(2), 0
        for k in range(40):
            seen = found((rotation(0, 25), np.array([0.1, 0.0, 2.0])), rng, names=three.names)
            poses = tuple(pose.about(shift) for pose in seen.estimates)
            told_now = replace(seen, state="found", estimates=poses)
            track = tracker.update(0.1 * k, tracker.plan(0.1 * k), told_now, CAMERA)
            told[name] += track.pose is not None
    assert told["marker"] < told["centroid"]


def test_a_pose_is_told_when_hardly_any_other_place_is_left() -> None:
    """Three markers that stand still, as does the vehicle: nothing but noise decides."""
    three = DockGeometry(DOCK.names[:3], DOCK.points[:3])
    still = rotation(2, 10, 1), np.array([0.2, 0.1, 3.0])
    told = waited = 0
    for seed in range(6):
        tracker, rng = Tracker(three), np.random.default_rng(seed)
        for k in range(60):
            seen = found(still, rng, names=three.names)
            track = tracker.update(0.1 * k, tracker.plan(0.1 * k), seen, CAMERA)
            locked = tracker._memory.locked
            if locked is None:
                continue
            bank = locked.bank.about(tracker._judged)
            if track.pose is not None:
                assert bank.elsewhere <= MOST_ELSEWHERE
                told += 1
                break
            waited += bank.doubt <= MOST_DOUBT
    assert told >= 3 and waited > 0


def test_frames_that_share_their_errors_do_not_make_three_markers_sure(
    record_property: Any,
) -> None:
    """Three places fit with any error in common: after many frames the range is still unsure."""
    three = DockGeometry(DOCK.names[:3], DOCK.points[:3])
    R, t = rotation(5, 25), np.array([0.1, 0.0, 2.5])
    inside = []
    for seed in range(16):
        rng = np.random.default_rng(seed)
        shared = rng.normal(0, 0.3, (3, 2))
        tracker = Tracker(three)
        for k in range(60):
            at = CAMERA.project(three.points @ R.T + t) + shared + rng.normal(0, 0.02, (3, 2))
            poses = estimates(Sighting(three.points, at, np.full(3, 0.1), CAMERA))
            markers = dict(zip(three.names, map(tuple, at.tolist()), strict=True))
            seen = Found(
                "found", 0.0, markers=markers, estimates=poses, evidence=9.0, sigma_px=(0.1,) * 3
            )
            tracker.update(0.1 * k, tracker.plan(0.1 * k), seen, CAMERA)
        locked = tracker._memory.locked
        assert locked is not None
        place = t + R @ three.centre
        states = [h.state for h in locked.bank.hypotheses]
        square = min(
            (s.t - place) @ np.linalg.solve(s.covariance[:3, :3], s.t - place) for s in states
        )
        inside.append(square < 7.81)
    share = float(np.mean(inside))
    record_property(
        "figure", f"track: three markers that share their errors, the place is right in {share:.2f}"
    )
    assert share >= 0.8


def test_a_frame_of_the_least_likely_pose_alone_is_not_told() -> None:
    """As where a marker leaves the picture and a lamp stands near where another pose has it."""
    run = Run()
    run.frames(2.0, run.dock)
    memory = run.tracker._memory
    assert memory.locked is not None
    first = memory.locked.bank.hypotheses[0].state
    R, t = first.R, first.t + np.array([-1.2, 0.3, 0.0])
    other = replace(first, R=R, t=t, velocity=np.zeros(3))
    bank = Bank((Hypothesis(first, 0.95), Hypothesis(other, 0.05)))
    run.tracker._memory = replace(memory, locked=replace(memory.locked, bank=bank))
    there = R, t - R @ run.tracker._centre
    track = run.frame(lambda time_s, plan: found(there, run.rng))
    assert track.pose is None and track.state == "acquiring"
    after = run.tracker._memory.locked
    assert after is not None and after.measured_s == memory.locked.measured_s
    track = run.frames(0.3, run.dock)[-1]
    assert track.pose is not None  # and what was right is found again
    assert track.pose.t == pytest.approx(approach(run.time_s - 0.1)[1], abs=0.15)
