"""Approaches as data: their file, their table, their figure and one run of a few frames."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import approach
import polars as pl
import pytest
from approach import SCENARIOS, read_approaches, run
from approach_plot import approach_plot
from approach_tables import summaries
from results_approach import approach_section

from chromadock import ChromadockError
from chromadock.track.states import STATES


def row(time_s: float, **changes: Any) -> dict[str, Any]:
    """A frame on the way from 8 to 0.6 m that is tracked well."""
    usual: dict[str, Any] = {
        "scene": "pool",
        "scenario": "nothing else",
        "time_s": time_s,
        "range_m": 8.0 - time_s * 7.4 / 60,
        "markers_seen": 4,
        "contrast": 0.5,
        "frame_state": "found",
        "state": "tracking",
        "measured": True,
        "marker_px": 0.5,
        "place_m": 0.02,
        "attitude_deg": 2.0,
        "within_95": True,
    }
    return {**usual, **changes}


def unseen(time_s: float, **changes: Any) -> dict[str, Any]:
    nowhere = dict.fromkeys(("marker_px", "place_m", "attitude_deg", "within_95"))
    off: dict[str, Any] = {"state": "never_seen", "frame_state": "not_found", "measured": False}
    return row(time_s, **{**off, **nowhere, **changes})


def frames(*rows: dict[str, Any]) -> pl.DataFrame:
    return pl.DataFrame(list(rows), infer_schema_length=None)


def test_the_shipped_scenarios_are_sound_and_all_there() -> None:
    runs = read_approaches(SCENARIOS)
    assert {r.scene_name for r in runs} == {"pool", "lake"}
    assert len(runs) == 2 * len({r.scenario for r in runs}) == 14
    for each in runs:
        scene = each.scene()
        course = scene.motion.course
        assert [course.distance_m(t) for t in (0, 60)] == pytest.approx([8.0, 0.6])
        assert (each.times[0], each.times[-1], len(each.times)) == (0.0, 60.0, 601)
    by_name = {(r.scene_name, r.scenario): r.scene() for r in runs}
    plain = by_name["pool", "nothing else"]
    assert by_name["lake", "a marker out from the start"].works(0.0).sum() == 3
    failing = by_name["pool", "a marker that fails on the way"]
    assert [failing.works(t).sum() for t in (19.9, 20.0)] == [4, 3]
    assert len(by_name["pool", "a buoy of the markers' colour"].bodies) == len(plain.bodies) + 1
    hiding = by_name["lake", "0.5 s of occlusion"].bodies[-1]
    hidden = [round(0.1 * k, 1) for k in range(601) if hiding.there(0.1 * k)]
    assert hidden == [50.0, 50.1, 50.2, 50.3, 50.4]
    assert by_name["lake", "a passing cloud"].ambient.clouds


def test_a_file_with_an_unknown_key_is_refused_in_one_line(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(SCENARIOS.read_text().replace("seconds =", "minutes ="))
    with pytest.raises(ChromadockError, match=r"mine\.toml.*") as refused:
        read_approaches(path)
    assert "\n" not in str(refused.value)


def test_what_a_run_comes_to() -> None:
    rows = [unseen(0.0, contrast=0.05), unseen(0.1), row(0.2), row(0.3, place_m=0.04)]
    rows += [row(0.4, state="recently_lost", measured=False), row(0.5, markers_seen=2)]
    found = summaries(frames(*rows, row(0.6, place_m=0.9)))[0]
    assert (found.visible_s, found.lock_s) == (0.1, 0.2)
    assert found.lock_m == pytest.approx(8.0 - 0.2 * 7.4 / 60)
    assert found.locked == pytest.approx(3 / 4)
    assert found.locked_of_all == pytest.approx(4 / 7)
    assert found.false == 1
    assert found.within_95 == 1.0


def test_a_prediction_that_is_off_is_no_false_lock() -> None:
    found = summaries(frames(row(0.0), row(0.1, measured=False, place_m=0.9)))[0]
    assert found.false == 0


def test_a_run_without_a_lock_is_said_so() -> None:
    rows = frames(
        *(row(0.1 * k) for k in range(5)), *(unseen(0.1 * k, scene="lake") for k in range(5))
    )
    never = summaries(rows)[1]
    assert (never.lock_s, never.locked, never.place) == (None, None, None)
    text = approach_section(rows)
    assert "| lake | nothing else | 0.0 s, 8.00 m | – | – | 0 % | 0 | – | – | – |" in text
    assert "**lake, nothing else**: not locked at all." in text
    assert "pool, nothing else**" not in text


def test_the_figure_has_a_bar_for_each_run_and_all_states() -> None:
    rows = [row(0.1 * k, state=state) for k, state in enumerate(STATES)]
    figure = approach_plot(frames(*rows, *(r | {"scenario": "a buoy"} for r in rows)))
    axes = figure.axes[0]
    assert [t.get_text() for t in axes.get_yticklabels()] == ["nothing else", "a buoy"]
    assert len(axes.collections) == 2 * len(STATES)
    assert [t.get_text() for t in figure.legends[0].get_texts()][: len(STATES)] == [
        s.replace("_", " ") for s in STATES
    ]


def test_a_few_frames_run_for_real(monkeypatch: pytest.MonkeyPatch) -> None:
    """At 2.5 m in the pool: locked within half a second, and where the dock is."""
    first = read_approaches(SCENARIOS)[0]
    near = replace(
        first,
        changes=(*first.changes, {"vehicle.distance_m": 2.5}),
        times=[0.1 * k for k in range(6)],
    )
    found = run(near)
    assert found.columns == list(row(0.0))
    states = found["state"].to_list()
    assert states[0] == "acquiring" and states[-1] == "tracking"
    assert found["frame_state"].to_list().count("found") >= 4
    assert found["place_m"][-1] < 0.05
    assert found["contrast"].min() > 0.1
    assert approach.NEEDED == 3
