from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from chromadock import CameraModel
from chromadock.demo import scene
from chromadock.demo.light import LED_RADIUS_M, SCATTERED_SHARE, add_led, to_encoded, to_linear


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
    assert len(frames) == 180
    found = [f for f in frames if f["found"]]
    assert len(found) > 0.8 * len(frames)
    assert f"found in {len(found)} of {len(frames)}" in printed
    for f in found:
        error = np.linalg.norm(np.array(f["pose"]["t"]) - f["truth"]["t"])
        assert error < 0.05 * np.linalg.norm(f["truth"]["t"])
    for f in frames:
        apart = (f["dock"]["hue_deg"] - f["marker"]["hue_deg"] + 180) % 360 - 180
        assert abs(apart) < 3
    assert frames[0]["background"]["hue_deg"] == pytest.approx(200, abs=3)
    assert frames[-1]["background"]["hue_deg"] < 145
    assert frames[0]["dock"]["hue_deg"] - frames[-1]["dock"]["hue_deg"] > 40


def test_the_video_and_the_page_can_be_opened(demo: tuple[Path, str]) -> None:
    out, _ = demo
    video = cv2.VideoCapture(str(out / "overlay.mp4"))
    assert video.get(cv2.CAP_PROP_FRAME_COUNT) == 180
    assert video.read()[0]
    page = cv2.imread(str(out / "overview.png"))
    assert page.shape[1] > 1000


def test_led_light_falls_with_distance_and_attenuation() -> None:
    """Energy against Beer-Lambert times inverse square, halo included."""

    def energy(range_m: float, c: float) -> float:
        light = np.zeros((301, 301, 3), np.float32)
        add_led(light, (150, 150), np.ones(3, np.float32), range_m, 512, c)
        return float(light[..., 0].sum())

    face = np.pi * (512 * LED_RADIUS_M / 2) ** 2
    assert energy(2, 0) == pytest.approx(face, rel=0.01)
    assert energy(4, 0) == pytest.approx(energy(2, 0) / 4, rel=0.01)
    kept = np.exp(-(1 - SCATTERED_SHARE) * 0.5 * 2)
    assert energy(2, 0.5) == pytest.approx(face * kept, rel=0.02)


def test_each_led_channel_lights_its_own_pixels() -> None:
    for channel in range(3):
        light = np.zeros((41, 41, 3), np.float32)
        colour = np.zeros(3, np.float32)
        colour[channel] = 1
        add_led(light, (20, 20), colour, 1, 512, 0.2)
        assert light[20, 20, channel] > 0
        assert light.sum(axis=(0, 1)).nonzero()[0].tolist() == [channel]


def test_encoding_and_decoding_are_inverse() -> None:
    levels = np.arange(256, dtype=np.uint8)
    assert (to_encoded(to_linear(levels)) == levels).all()


def test_the_scene_puts_lit_markers_where_the_truth_says() -> None:
    from chromadock import DockGeometry

    dock, rng = DockGeometry.default(), np.random.default_rng(0)
    lit = scene.vehicle_frame(3.0, np.array([1, 0, 1], np.float32), dock, rng).astype(int)
    rng = np.random.default_rng(0)
    dark = scene.vehicle_frame(3.0, np.zeros(3, np.float32), dock, rng).astype(int)
    pose = scene.true_pose(3.0)
    camera: CameraModel = scene.VEHICLE_CAMERA
    difference = (lit - dark).sum(axis=2).astype(float)
    for x, y in camera.project(dock.points @ pose.R.T + pose.t):
        x0, y0 = round(x) - 6, round(y) - 6
        patch = difference[y0 : y0 + 13, x0 : x0 + 13]
        ys, xs = np.mgrid[y0 : y0 + 13, x0 : x0 + 13]
        centroid = (patch * xs).sum() / patch.sum(), (patch * ys).sum() / patch.sum()
        assert np.hypot(centroid[0] - x, centroid[1] - y) < 0.3
    assert difference[:100].max() <= 6


def test_the_drift_goes_from_blue_to_green() -> None:
    first, last = scene.water_rgb(0), scene.water_rgb(scene.DURATION_S)
    assert first.argmax() == 2
    assert last.argmax() == 1
