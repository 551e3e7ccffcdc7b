from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from chromadock.demo.loop import COUNT


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    out = tmp_path_factory.mktemp("demo")
    run = subprocess.run(
        [sys.executable, "-m", "chromadock", "demo", "--out", str(out)],
        capture_output=True,
        text=True,
        check=True,
    )
    return out, run.stdout


def test_the_demo_writes_its_three_files_and_nothing_else(demo: tuple[Path, str]) -> None:
    out, _ = demo
    assert sorted(p.name for p in out.iterdir()) == ["frames.jsonl", "overlay.mp4", "overview.png"]


def test_the_dock_is_found_and_both_sides_follow_the_water(demo: tuple[Path, str]) -> None:
    out, printed = demo
    frames = [json.loads(line) for line in (out / "frames.jsonl").read_text().splitlines()]
    assert len(frames) == COUNT
    found = [f for f in frames if f["found"]]
    assert len(found) > 0.8 * len(frames)
    assert f"found in {len(found)} of {len(frames)}" in printed
    errors = [
        np.linalg.norm(np.array(f["pose"]["t"]) - f["truth"]["T_camera_dock"]["t"])
        / np.linalg.norm(f["truth"]["T_camera_dock"]["t"])
        for f in found
    ]
    assert np.median(errors) < 0.01
    for f in frames:
        apart = (f["dock"]["hue_deg"] - f["marker"]["hue_deg"] + 180) % 360 - 180
        assert abs(apart) < 10
    pool = [f for f in frames if f["place"] == "pool"]
    lake = [f for f in frames if f["place"] == "lake"]
    assert all(190 < f["background"]["hue_deg"] < 230 for f in pool)
    assert all(60 < f["background"]["hue_deg"] < 130 for f in lake)
    assert pool[-1]["dock"]["hue_deg"] - lake[-1]["dock"]["hue_deg"] > 90


def test_the_video_and_the_page_can_be_opened(demo: tuple[Path, str]) -> None:
    out, _ = demo
    video = cv2.VideoCapture(str(out / "overlay.mp4"))
    assert video.get(cv2.CAP_PROP_FRAME_COUNT) == COUNT
    assert video.read()[0]
    page = cv2.imread(str(out / "overview.png"))
    assert page.shape[1] > 1000
