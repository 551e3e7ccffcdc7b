from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from track_run import HZ, Run, Seen, nothing
from track_truth import CAMERA, DOCK, NOTHING, Pose, approach, found, rotation

from chromadock import Attitude, DockGeometry, Tracker
from chromadock.geometry.pose import lever
from chromadock.look import Found
from chromadock.rotation import matrix_from_quaternion
from chromadock.track.candidate import (
    GIVEN_UP_S,
    LOCK_EVIDENCE,
    LOCK_FRAMES,
    PATIENT_EVIDENCE,
    PATIENT_FRAMES,
    PATIENT_SPAN_S,
)
from chromadock.track.plan import FULL_SEARCH_S, MAX_PRIORS, Plan
from chromadock.track.states import (
    KEPT_S,
    STATES,
    TRACKING_S,
    state_of,
)
from chromadock.track.tracker import KEEP_EVIDENCE


def elsewhere(pose: Pose, evidence: float = LOCK_EVIDENCE + 1) -> Seen:
    rng = np.random.default_rng(7)
    return lambda time_s, plan: found(pose, rng, evidence)


GHOST = (rotation(0, -5), np.array([-1.2, 0.4, 6.0]))


@pytest.fixture
def run() -> Iterator[Run]:
    yield Run()


AGES = (None, 0.0, TRACKING_S, TRACKING_S + 0.01, KEPT_S, KEPT_S + 0.01)


@pytest.mark.parametrize(
    ("age_s", "candidate", "seen"), list(product(AGES, (False, True), (False, True)))
)
def test_the_state_follows_from_what_is_known(
    age_s: float | None, candidate: bool, seen: bool
) -> None:
    state = state_of(age_s, candidate, seen)
    assert state in STATES
    if age_s is not None and age_s <= KEPT_S:
        assert state == ("tracking" if age_s <= TRACKING_S else "recently_lost")
    elif candidate:
        assert state == "acquiring"
    else:
        assert state == ("lost" if seen else "never_seen")


def test_a_dock_is_locked_within_a_fraction_of_a_second(run: Run) -> None:
    tracks = run.frames(0.5, run.dock)
    assert [t.state for t in tracks] == ["acquiring"] * (LOCK_FRAMES - 1) + ["tracking"] * 3
    assert all((t.pose is None) == (t.state == "acquiring") for t in tracks)
    _, t = approach(0.4)
    assert tracks[-1].pose is not None and tracks[-1].velocity is not None
    assert tracks[-1].pose.t == pytest.approx(t, abs=0.15)
    assert tracks[-1].age_s == 0


def test_a_dock_passes_through_all_states(run: Run) -> None:
    states = [t.state for t in run.frames(0.3, nothing)]
    states += [t.state for t in run.frames(1.0, run.dock)]
    states += [t.state for t in run.frames(KEPT_S + 1, nothing)]
    states += [t.state for t in run.frames(0.5, run.dock)]
    order = [s for s, before in zip(states, [None, *states[:-1]], strict=True) if s != before]
    assert order == [
        "never_seen", "acquiring", "tracking", "recently_lost", "lost", "acquiring", "tracking",
    ]  # fmt: skip


def test_evidence_of_like_frames_does_not_add_up(run: Run) -> None:
    rng = np.random.default_rng(1)
    weak: Seen = lambda time_s, plan: found(approach(time_s), rng, PATIENT_EVIDENCE - 0.1)  # noqa: E731
    assert {t.state for t in run.frames(5, weak)} == {"acquiring"}
    assert run.frame(run.dock).state == "tracking"


def test_less_evidence_takes_more_frames(run: Run) -> None:
    rng = np.random.default_rng(1)
    fair: Seen = lambda time_s, plan: found(approach(time_s), rng, LOCK_EVIDENCE - 0.1)  # noqa: E731
    states = [t.state for t in run.frames(PATIENT_SPAN_S + 1, fair)]
    assert len(states) > PATIENT_FRAMES
    first = round(PATIENT_SPAN_S * HZ)
    assert states == ["acquiring"] * first + ["tracking"] * (len(states) - first)


def test_what_is_a_dock_in_every_third_frame_only_is_none(run: Run) -> None:
    looks = iter(range(1000))

    def flickering(time_s: float, plan: Plan) -> Found:
        return run.dock(time_s, plan) if next(looks) % 3 == 0 else NOTHING

    assert not any(t.pose for t in run.frames(5, flickering))


def test_one_frame_of_high_evidence_is_no_lock(run: Run) -> None:
    run.frame(run.dock)
    assert [t.state for t in run.frames(GIVEN_UP_S + 0.2, nothing)][-1] == "never_seen"


def test_docks_in_other_places_each_time_are_none(run: Run) -> None:
    rng = np.random.default_rng(2)
    for _ in range(40):
        place = (
            rotation(0, 0),
            np.array([rng.uniform(-2, 2), rng.uniform(-1, 1), rng.uniform(4, 8)]),
        )
        assert run.frame(elsewhere(place)).state == "acquiring"


def test_the_same_picture_again_is_no_new_measurement(run: Run) -> None:
    """A camera that hangs: neither is a dock locked, nor a lock kept."""
    still = found(approach(0.0), run.rng)
    assert not any(t.pose for t in run.frames(0.9, lambda time_s, plan: still))
    run.frames(1.0, run.dock)
    still = found(approach(run.time_s), run.rng)
    states = [t.state for t in run.frames(KEPT_S + 0.5, lambda time_s, plan: still)]
    assert states[0] == "tracking" and states[-1] == "lost"


def test_half_a_second_of_occlusion_does_not_lose_the_dock(run: Run) -> None:
    run.frames(2.0, run.dock)
    hidden = run.frames(0.5, nothing)
    assert {t.state for t in hidden} == {"tracking", "recently_lost"}
    _, t = approach(run.time_s - 1 / HZ)
    assert hidden[-1].pose is not None
    assert hidden[-1].pose.t == pytest.approx(t, abs=0.15)
    ages = [t.age_s for t in hidden]
    assert ages == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5])
    assert run.frame(run.dock).state in (
        "tracking",
        "recently_lost",
    )  # a full search may come first
    assert run.frame(run.dock).state == "tracking"


def test_a_marker_that_goes_out_does_not_lose_the_dock(run: Run) -> None:
    run.frames(2.0, run.dock)
    three = DOCK.names[1:]

    def partial(time_s: float, plan: Plan) -> Found:
        return found(approach(time_s), run.rng, 3.5, three) if plan.priors else NOTHING

    tracks = run.frames(4.0, partial)
    assert {t.state for t in tracks} == {"tracking"}
    _, t = approach(run.time_s - 1 / HZ)
    assert any(
        np.allclose(p.t, t, atol=0.05) for p in (tracks[-1].pose, tracks[-1].alternative) if p
    )


def test_while_a_dock_is_tracked_the_frame_is_searched_about_it(run: Run) -> None:
    first = run.tracker.plan(0.0)
    assert first.everywhere and first.incomplete and not first.priors
    run.frames(1.0, run.dock)
    plans: list[Plan] = []
    run.frames(5.0, lambda time_s, plan: (plans.append(plan), run.dock(time_s, plan))[1])
    full = sum(p.everywhere for p in plans)
    assert 5.0 / FULL_SEARCH_S - 2 <= full <= 5.0 / FULL_SEARCH_S + 1
    assert all(bool(p.priors) != p.everywhere for p in plans)
    assert all(len(p.priors) <= MAX_PRIORS and not p.incomplete for p in plans)
    guided = run.tracker.plan(run.time_s)
    guided = guided if guided.priors else plans[-1]
    assert any(p.distance(*approach(run.time_s)) < 25 for p in guided.priors)


def test_expectations_grow_vaguer_while_nothing_is_seen(run: Run) -> None:
    run.frames(2.0, run.dock)
    widths = []
    for _ in range(8):
        plan = run.tracker.plan(run.time_s)
        if plan.priors:
            widths.append(np.sqrt(np.diag(plan.priors[0].covariance)[:3]).max())
        run.frame(nothing)
    assert len(widths) >= 3
    assert widths == sorted(widths) and widths[-1] > 2 * widths[0]


def test_a_wrong_lock_is_left_for_a_dock_that_stands_out_more(run: Run) -> None:
    ghost = elsewhere(GHOST)
    run.frames(1.0, ghost)
    locked = run.tracker.at(run.time_s)
    assert locked.pose is not None and locked.pose.t == pytest.approx(GHOST[1], abs=0.3)

    def both(time_s: float, plan: Plan) -> Found:
        return run.dock(time_s, plan) if plan.everywhere else ghost(time_s, plan)

    tracks = run.frames(PATIENT_SPAN_S + 2, both)
    assert tracks[-1].pose is not None
    assert tracks[-1].pose.t == pytest.approx(approach(run.time_s - 1 / HZ)[1], abs=0.15)
    # From its rival's second frame on, two searches of the whole frame later, it is not told.
    until = round((FULL_SEARCH_S + 0.2) * HZ)
    told = [t.pose for t in tracks[until:] if t.pose is not None]
    assert all(pose.t != pytest.approx(GHOST[1], abs=0.5) for pose in told)
    assert len(told) >= HZ
    assert {t.state for t in tracks} == {"tracking", "acquiring"}


def test_what_is_seen_once_beside_a_tracked_dock_does_not_silence_it(run: Run) -> None:
    run.frames(2.0, run.dock)
    ghost, seen = elsewhere(GHOST), []

    def once(time_s: float, plan: Plan) -> Found:
        if plan.everywhere and not seen:
            seen.append(time_s)
            return ghost(time_s, plan)
        return run.dock(time_s, plan)

    assert all(t.state == "tracking" for t in run.frames(1.0, once))
    assert seen


def test_a_wrong_lock_is_left_at_once_for_what_is_a_dock_beyond_comparison(run: Run) -> None:
    ghost, rng = elsewhere(GHOST), np.random.default_rng(3)
    run.frames(1.0, ghost)

    def both(time_s: float, plan: Plan) -> Found:
        strong = found(approach(time_s), rng, 3 * LOCK_EVIDENCE)
        return strong if plan.everywhere else ghost(time_s, plan)

    tracks = run.frames(FULL_SEARCH_S + 2 * LOCK_FRAMES / HZ, both)
    assert tracks[-1].pose is not None
    assert tracks[-1].pose.t == pytest.approx(approach(run.time_s - 1 / HZ)[1], abs=0.15)


def test_what_stands_a_little_like_a_dock_that_went_dark_is_not_taken_for_it(run: Run) -> None:
    """Half as far again: within reach of a vehicle that has manoeuvred since."""
    rng = np.random.default_rng(4)
    run.frames(2.0, lambda time_s, plan: found(approach(time_s), rng, 4 * LOCK_EVIDENCE))
    run.frames(KEPT_S - 3 / HZ, nothing)
    R, t = approach(run.time_s)

    def about(time_s: float, plan: Plan) -> Found:
        return NOTHING if plan.everywhere else found((R, 1.5 * t), rng, LOCK_EVIDENCE + 1)

    assert {track.pose for track in run.frames(1.0, about)} == {None}


def test_a_dock_that_was_dark_is_followed_again_from_its_first_look(run: Run) -> None:
    rng = np.random.default_rng(5)

    def bright(time_s: float, plan: Plan) -> Found:
        return found(approach(time_s), rng, 4 * LOCK_EVIDENCE)

    run.frames(2.0, bright)
    run.frames(KEPT_S - 3 / HZ, nothing)
    assert run.frame(bright).state == "tracking"


def test_a_right_lock_is_kept_beside_something_that_stands_out_now_and_then(run: Run) -> None:
    run.frames(2.0, run.dock)
    ghost, looks = elsewhere(GHOST), 0

    def mostly(time_s: float, plan: Plan) -> Found:
        nonlocal looks
        looks += plan.everywhere
        return ghost(time_s, plan) if plan.everywhere and looks % 3 == 0 else run.dock(time_s, plan)

    for _ in range(30):
        track = run.frame(mostly)
        assert track.pose is not None
        assert track.pose.t == pytest.approx(approach(run.time_s - 1 / HZ)[1], abs=0.2)


def test_specks_where_markers_are_expected_are_not_taken_for_them(run: Run) -> None:
    run.frames(2.0, run.dock)
    off = approach(run.time_s)
    specks = replace(found((off[0], off[1] + [0.05, 0, 0]), run.rng), evidence=KEEP_EVIDENCE - 0.1)
    while not run.tracker.plan(run.time_s).priors:
        run.frame(run.dock)
    assert run.frame(lambda time_s, plan: specks).age_s == pytest.approx(0.1)


def test_a_late_frame_changes_nothing(run: Run) -> None:
    run.frames(2.0, run.dock)
    before = run.tracker.at(5.0)
    for late_s in (0.0, 0.05, 0.6):
        at = run.time_s - 1 / HZ - late_s
        run.tracker.update(at, Plan(), found(approach(at), run.rng), CAMERA)
    assert run.tracker.at(5.0) == before


def test_a_recording_that_starts_again_is_a_new_track(run: Run) -> None:
    run.frames(3.0, run.dock)
    run.time_s = 0.0
    assert run.frame(nothing).state == "never_seen"
    assert run.frames(0.5, run.dock)[-1].state == "tracking"


def test_a_gap_in_time_loses_the_dock(run: Run) -> None:
    run.frames(2.0, run.dock)
    run.time_s += 60
    assert run.frame(nothing).state == "lost"


def test_the_track_can_be_asked_for_any_later_time(run: Run) -> None:
    run.frames(3.0, run.dock)
    last = run.time_s - 1 / HZ
    now = run.tracker.at(last + 0.2)
    assert now.time_s == last + 0.2 and now.age_s == pytest.approx(0.2)
    assert now.pose is not None
    assert now.pose.t == pytest.approx(approach(last + 0.2)[1], abs=0.12)
    assert run.tracker.at(last + TRACKING_S + 0.1).state == "recently_lost"
    assert run.tracker.at(last + KEPT_S + 0.1).state == "lost"
    assert run.tracker.at(last - 1) == run.tracker.at(last)


@pytest.mark.parametrize("shift", [(0.0, -2.0, 0.0), (0.0, 0.0, -1.0), (-2.0, 0.5, 1.0)])
def test_it_does_not_matter_where_the_dock_has_its_origin(shift: tuple[float, ...]) -> None:
    """The same pixels: at each moment the same dock, its covariance carried to the origin.  Only
    whether a pose is told may differ, for how surely the place is known is asked of another point
    of the dock."""
    origin = np.array(shift)
    moved = DockGeometry(DOCK.names, DOCK.points - origin)
    trackers = Tracker(DOCK), Tracker(moved)
    rng = np.random.default_rng(4)
    compared = 0
    for k in range(80):
        time_s = k / HZ
        R, t = approach(time_s)
        names = DOCK.names if k % 7 else DOCK.names[1:]
        seen = found((R, t), rng, names=names) if k % 11 else NOTHING
        attitude = Attitude(0.01 * np.sin(k), 0.0, 0.02 * k)
        tracks, priors = [], []
        for tracker, about in zip(trackers, (np.zeros(3), origin), strict=True):
            plan = tracker.plan(time_s)
            poses = tuple(pose.about(about) for pose in seen.estimates)
            told = replace(seen, estimates=poses)
            priors.append(plan.priors)
            tracks.append(tracker.update(time_s, plan, told, CAMERA, attitude))
        near, far = tracks
        assert near.state == far.state or {near.state, far.state} == {"tracking", "acquiring"}
        for a, b in zip(*priors, strict=True):
            b = b.about(-origin)
            np.testing.assert_allclose(b.t, a.t, atol=1e-6)
            np.testing.assert_allclose(b.covariance, a.covariance, rtol=1e-3, atol=1e-8)
        if near.pose is None or far.pose is None:
            continue
        compared += 1
        for one, other in ((near.pose, far.pose), (near.alternative, far.alternative)):
            assert (one is None) == (other is None)
            if one is None or other is None:
                continue
            assert other.weight == pytest.approx(one.weight, abs=1e-6)
            R = matrix_from_quaternion(other.q_wxyz)
            np.testing.assert_allclose(R, matrix_from_quaternion(one.q_wxyz), atol=1e-6)
            np.testing.assert_allclose(np.array(other.t) - R @ origin, one.t, atol=1e-6)
            J = lever(-R @ origin)
            spread = J @ np.reshape(other.covariance, (6, 6)) @ J.T
            np.testing.assert_allclose(spread.ravel(), one.covariance, rtol=1e-3, atol=1e-9)
    assert compared > 10
    assert near.state == far.state == "tracking"
    assert near.velocity == pytest.approx(far.velocity, abs=1e-6)


@given(
    steps=st.lists(
        st.tuples(st.floats(-3, 5), st.sampled_from(["dock", "ghost", "three", "nothing"])),
        max_size=30,
    )
)
def test_whatever_comes_at_whatever_time_the_track_is_sound(
    steps: list[tuple[float, str]],
) -> None:
    tracker, rng, time_s = Tracker(DOCK), np.random.default_rng(0), 0.0
    for step_s, what in steps:
        time_s += step_s if abs(step_s) > 0.5 else abs(step_s)
        seen = {
            "dock": lambda: found(approach(1.0), rng),
            "ghost": lambda: found(GHOST, rng),
            "three": lambda: found(approach(1.0), rng, 3.0, DOCK.names[:3]),
            "nothing": lambda: NOTHING,
        }[what]()
        track = tracker.update(time_s, tracker.plan(time_s), seen, CAMERA)
        assert track.state in STATES
        assert (track.pose is not None) == (track.state in ("tracking", "recently_lost"))
        if track.pose is not None:
            assert np.isfinite(track.pose.t).all()
            assert 0 < track.pose.weight <= 1
            spread = np.array(track.pose.covariance).reshape(6, 6)
            assert np.linalg.eigvalsh(spread).min() > 0
