"""That `make bench` measures what it says; never how fast."""

from __future__ import annotations

import json
from dataclasses import asdict
from io import StringIO
from pathlib import Path
from typing import Any

import bench
import bench_ratios
import bench_tables
import budgets
import cv2
import numpy as np
import pytest
from bench_memory import LongRun, long_runs
from bench_peers import SETTINGS, mask_of, peer_ratios
from bench_ratios import by_cost, detector_ratios, one_thread, ratio, totals, tracked_ratios
from bench_scenes import LARGER, VGA, docks, enlarged, photographs, plain_water
from rich.console import Console
from rich.table import Table

from chromadock import Detector, DockGeometry

STAGES = {
    "robust": {"colour", "response", "peaks", "search", "pose"},
    "paper": {"colour", "mask", "blobs", "constellation", "pose"},
}


def printed(table: Table) -> str:
    text = StringIO()
    Console(file=text, width=160).print(table)
    return text.getvalue()


@pytest.mark.parametrize("method", STAGES)
def test_a_scene_has_a_ratio_and_one_for_each_stage_which_sum_up_to_it(method: str) -> None:
    ratios = detector_ratios({"water": plain_water()}, method, rounds=2)
    assert set(ratios) == {"water"} | {f"water/{stage}" for stage in STAGES[method]}
    parts = [value for name, value in ratios.items() if "/" in name]
    assert sum(parts) == pytest.approx(ratios["water"], abs=0.01)
    assert min(parts) >= 0 and totals(ratios) == {"water": ratios["water"]}


def test_with_the_track_the_mean_and_the_longest_are_over_the_blurs(monkeypatch: Any) -> None:
    """By a clock that the blur moves on by 2 and a frame by 8, but every tenth by 28."""
    now, turns = [0.0], iter(range(1000))

    def takes(seconds: float) -> None:
        now[0] += seconds

    class Tracked:
        def __init__(self, *_: Any) -> None: ...

        def process(self, *_: Any) -> None:
            takes(28 if next(turns) % 10 == 0 else 8)

    monkeypatch.setattr(bench_ratios.time, "process_time", lambda: now[0])
    monkeypatch.setattr(bench_ratios.cv2, "GaussianBlur", lambda *_: takes(2))
    monkeypatch.setattr(bench_ratios, "Detector", Tracked)
    assert tracked_ratios({"water": plain_water()}, frames=100) == {"water": (5.0, 14.0)}


def test_with_the_track_a_real_detector_has_ratios() -> None:
    mean, longest = tracked_ratios({"water": plain_water()}, frames=3)["water"]
    assert 0 < mean <= longest


def test_a_ratio_is_the_works_time_over_the_blurs(monkeypatch: Any) -> None:
    """By a clock that the blur moves on by 2 and the work by 7, but once by 100."""
    now, turns = [0.0], iter(range(1000))

    def takes(seconds: float) -> None:
        now[0] += seconds

    monkeypatch.setattr(bench_ratios.time, "process_time", lambda: now[0])
    monkeypatch.setattr(bench_ratios.cv2, "GaussianBlur", lambda *_: takes(2))
    with one_thread():
        assert cv2.getNumThreads() == 1
        assert ratio(plain_water(), lambda: takes(100 if next(turns) == 20 else 7)) == 3.5


def test_scenes_are_ordered_by_their_own_cost() -> None:
    ratios = {"a": 3.0, "a/pose": 9.0, "b": 2.0, "b/pose": 1.0, "c": 4.0}
    assert by_cost(ratios) == ["b", "a", "c"]


def test_frames_have_the_sizes_that_they_are_named_by() -> None:
    assert plain_water().shape == (VGA[1], VGA[0], 3)
    frames = bench.larger_frames(plain_water())
    assert len(frames) == 2 * len(LARGER)
    for name, frame in frames.items():
        width, height = map(int, name.split()[-1].split("x"))
        assert frame.shape == (height, width, 3)
        assert frame.dtype == np.uint8
        assert bench.limit_of(name) in (budgets.BLUR_RATIO, budgets.BLUR_RATIO_WORST)


def test_an_enlarged_photograph_is_not_distorted() -> None:
    round_spot = np.zeros((480, 640, 3), np.uint8)
    cv2.circle(round_spot, (320, 240), 60, (255, 255, 255), -1)
    x, y = np.where(enlarged(round_spot, (1280, 720))[..., 0].T > 127)
    assert np.ptp(x) == pytest.approx(np.ptp(y), abs=2)
    assert x.mean() == pytest.approx(639.5, abs=1) and y.mean() == pytest.approx(359.5, abs=1)


def test_all_photographs_are_measured_at_vga() -> None:
    found = photographs()
    if not found:
        pytest.skip("no photographs: ../shared/data is missing")
    assert len(found) == 43
    assert {frame.shape for frame in found.values()} == {(480, 640, 3)}


def test_composited_docks_are_there_to_be_found() -> None:
    scenes = docks(plain_water())
    assert set(scenes) == {"dock at 2 m", "dock at 5 m"}
    assert found(scenes["dock at 2 m"]) is not None


def test_peers_have_a_ratio_or_are_named_as_missing() -> None:
    frame = plain_water()
    peers, missing = peer_ratios(frame, rounds=1)
    assert "SimpleBlobDetector" in peers
    assert set(SETTINGS) == set(peers) | {line.split(":")[0] for line in missing}
    assert min(peers.values()) > 0


def test_the_blob_detector_is_given_the_mask_with_the_markers() -> None:
    scene = docks(plain_water())["dock at 2 m"]
    mask, markers = mask_of(scene), found(scene)
    assert mask.dtype == np.uint8 and set(np.unique(mask)) == {0, 255}
    assert markers is not None
    assert all(mask[round(y), round(x)] for x, y in markers.values())
    assert np.count_nonzero(mask) < 0.1 * mask.size


def found(frame: np.ndarray) -> dict[str, tuple[float, float]] | None:
    return Detector(None, DockGeometry.default(), independent=True).process(frame, 0.0).markers


def test_the_tables_show_every_figure_and_colour_those_over_budget() -> None:
    ratios = {"water": 6.25, "water/colour": 1.5, "dock": 7.5, "dock/pose": 2.5}
    rows = [("water", "plain water", 5), ("dock", "a dock", 8), ("dock", "again", None)]
    text = printed(bench_tables.ratios_table("times a blur", ratios, rows))
    for part in ("times a blur", "plain water", "colour", "pose", "6.25", "1.50", "7.50", "2.50"):
        assert part in text
    assert bench_tables.judged(6.25, 5, "6.25") == "[red]6.25[/red]"
    assert bench_tables.judged(6.25, 8, "6.25") == bench_tables.judged(6.25, None, "6.25")
    text = printed(bench_tables.peers_table("dock", 7.5, {"blob_log": 300.0}))
    assert "7.50" in text and "300.00" in text and SETTINGS["blob_log"] in text
    text = printed(bench_tables.long_runs_table({"alone": LongRun(10_000, 80.0, 81.0, 90.5)}))
    assert "10,000" in text and "80.0" in text and "81.0" in text and "90.5" in text


def test_the_result_is_written_whole(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr(bench, "RESULT", tmp_path / "out" / "bench.json")
    monkeypatch.setattr(bench, "ROOT", tmp_path)
    bench.write({"host": {"peers": {"blob_log": 3.0}}})
    assert json.loads(bench.RESULT.read_text()) == {"host": {"peers": {"blob_log": 3.0}}}
    assert [path.name for path in bench.RESULT.parent.iterdir()] == ["bench.json"]


def test_memory_does_not_grow_with_the_frames(record_property: Any) -> None:
    runs = long_runs(500)
    assert set(runs) == {"independent", "in sequence"}
    for kind, run in runs.items():
        figure = f"{run.settled_mib:.1f} to {run.end_mib:.1f} MiB resident"
        record_property("figure", f"300 more VGA frames, {kind}: {figure}")
        assert asdict(run)["frames"] == 500
        assert 10 < run.settled_mib <= run.largest_mib < budgets.RESIDENT_MIB
        assert run.end_mib - run.settled_mib < budgets.GROWTH_MIB
