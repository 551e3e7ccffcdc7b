"""The closed loop for twelve seconds, and that its judge sees what is wrong."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import closed_loop
import numpy as np
import pytest
from closed_loop import DARK_S, ClosedLoop

RUN_S = 12.0

SECONDS = 20.0
"""Of what the judge is asked about."""
DARK = (SECONDS / 2, SECONDS / 2 + DARK_S)


def test_twelve_seconds_from_the_docks_decision_to_the_autopilot(
    tmp_path: Path, record_property: Any
) -> None:
    if not closed_loop.has_streamer():
        pytest.skip("no GStreamer with RTSP server here")
    # On a computer that runs other tests at the same time.
    run = ClosedLoop(tmp_path, RUN_S, least_hz=2)
    run.run()
    for line in run.figures:
        record_property("figure", f"closed loop: {line}")
    assert run.faults == []
    assert run.autopilot.heard.counts["VISION_POSITION_ESTIMATE"] > 2 * RUN_S
    assert max(frame for _, frame, _ in run.taken) > 20
    assert {which for *_, which in run.taken} == {"lit", "dark"}


def judged(
    tmp_path: Path,
    targets: list[tuple[float, float, float]],
    grown_kib: int = 0,
    goes_out: bool = True,
) -> str:
    """What the judge says of these messages of a dock that stands at 2 m."""
    run = ClosedLoop(tmp_path, SECONDS)
    run.start_s, run.lasted_s, run.processor_s = 0.0, SECONDS, 1.0
    run.memory_kib = [(s, 100_000 + grown_kib * (s > SECONDS / 2)) for s in np.arange(0, SECONDS)]
    times = np.arange(0, SECONDS, 1 / closed_loop.FPS)
    run.taken = [(t, 0, "dark" if DARK[0] <= t < DARK[1] and goes_out else "lit") for t in times]
    run.status = {"frames": 1, "dropped": 0}
    run.autopilot = SimpleNamespace(heard=SimpleNamespace(targets=targets, counts={}))  # type: ignore[assignment]
    for name in ("dive.mcap", "seen.mp4"):
        (tmp_path / name).touch()
    run._judge(np.array([2.0]))
    return "; ".join(run.faults)


def told(but: Any = lambda at_s: True, range_m: float = 2.0) -> list[tuple[float, float, float]]:
    """A message a picture, 50 ms after it, while there is light and where ``but`` lets it."""
    times = np.arange(1, SECONDS - 0.1, 1 / closed_loop.FPS)
    lit = [t for t in times if not DARK[0] <= t < DARK[1] and but(t)]
    return [(t + 0.05, t, range_m) for t in lit]


def test_the_judge_accepts_a_loop_that_is_right(tmp_path: Path) -> None:
    assert judged(tmp_path, told()) == ""


@pytest.mark.parametrize(
    ("targets", "said"),
    [
        ([*told(), (SECONDS / 2 + 3, SECONDS / 2 + 3, 2.0)], "of a dock that is dark"),
        (told(lambda t: t < SECONDS / 2), "not told again once it was lit"),
        (told(lambda t: round(t * closed_loop.FPS) % 5 == 0), "fewer than 5 a second"),
        (told(range_m=2.2), "10 % off"),
    ],
)
def test_the_judge_sees_what_is_wrong(
    tmp_path: Path, targets: list[tuple[float, float, float]], said: str
) -> None:
    assert said in judged(tmp_path, targets)


def test_the_judge_sees_memory_that_grows(tmp_path: Path) -> None:
    assert "memory grew" in judged(tmp_path, told(), closed_loop.MOST_GROWTH_KIB + 1)


def test_the_judge_sees_pictures_that_do_not_follow_the_dock(tmp_path: Path) -> None:
    assert "changed 0 times" in judged(tmp_path, told(), goes_out=False)
