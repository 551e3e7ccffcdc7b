"""A control thread asks where the dock is while another thread is at a frame."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from track_truth import CAMERA, DOCK, NOTHING, approach, found

from chromadock import Attitude, Track, Tracker
from chromadock.look import Found
from chromadock.track.bank import Bank
from chromadock.track.candidate import Candidate
from chromadock.track.sight import Sight

STEPS = [
    (Bank, "after"), (Bank, "facing"), (Bank, "turning"), (Bank, "seen"), (Bank, "doubting"),
    (Candidate, "locked"), (Candidate, "looked_for"), (Sight, "worth"),
]  # fmt: skip
"""What ``Tracker.update`` calls on its way: at each of them the other thread may get its turn."""


def course(k: int) -> tuple[float, Found]:
    """Acquired, tracked, out of sight, found again, lost; and the recording starts anew."""
    rng = np.random.default_rng(k)
    if k < 40:
        time_s = k / 10
        seen = NOTHING if 20 <= k < 26 else found(approach(time_s), rng)
        return time_s, seen
    time_s = (k - 40) / 10
    return time_s, found(approach(time_s), rng)


def test_whoever_asks_meanwhile_gets_the_track_before_the_frame_or_after_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tracker, answers = Tracker(DOCK), list[Track]()
    asking, later_s = False, 0.0

    with ThreadPoolExecutor(1) as control:

        def interrupted(step: Callable[..., Any]) -> Callable[..., Any]:
            def then(*args: Any) -> Any:
                nonlocal asking
                if asking:
                    asking = False  # the other thread's own steps are not interrupted
                    answers.append(control.submit(tracker.at, later_s).result())
                    asking = True
                return step(*args)

            return then

        for owner, name in STEPS:
            monkeypatch.setattr(owner, name, interrupted(getattr(owner, name)))
        asked, states = 0, set[str]()
        for k in range(50):
            time_s, seen = course(k)
            later_s = time_s + 0.15
            plan, before = tracker.plan(time_s), tracker.at(later_s)
            asking = True
            tracker.update(time_s, plan, seen, CAMERA, Attitude(0.0, 0.0, 0.001 * k))
            asking = False
            after = tracker.at(later_s)
            assert all(answer in (before, after) for answer in answers), f"in frame {k}"
            states.add(after.state)
            asked += len(answers)
            answers.clear()
    assert asked > 100
    assert states == {"never_seen", "acquiring", "tracking", "recently_lost"}
