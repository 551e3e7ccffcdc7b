"""C = numpy, every intermediate value, on random frames and on real photographs."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from comparison import assert_same, c_decision, numpy_decision

from chromadock.choices import MAPPINGS

ROOT = Path(__file__).resolve().parents[2]
PHOTOGRAPHS = ROOT.parent / "shared" / "data" / "transdec"

BATCHES, BATCH = 20, 100  # 2,000 frames
SIZES = [(160, 120), (320, 240), (640, 480), (800, 600), (1280, 720), (1920, 1080), (1600, 1200)]


def to_rgb565(rgb: np.ndarray) -> bytes:
    r, g, b = (rgb[..., c].astype(np.uint16) for c in range(3))
    return ((r >> 3) << 11 | (g >> 2) << 5 | b >> 3).astype(">u2").tobytes()


def random_frame(rng: np.random.Generator) -> np.ndarray:
    """Any size, any content from noise to one colour."""
    if rng.random() < 0.1:
        width, height = SIZES[rng.integers(len(SIZES))]
    else:
        width, height = np.exp(rng.uniform(0, np.log(400), 2)).astype(int)
    flat = rng.integers(0, 256, 3)
    tilt = rng.normal(0, 80, 3) * np.linspace(-1, 1, height)[:, None, None]
    strength = float(rng.choice([0, 4, 40, 300]))
    frame = strength * (rng.random((height, width, 3), np.float32) - 0.5)
    frame += flat + tilt * rng.integers(2)
    return np.clip(frame, 0, 255, out=frame).astype(np.uint8)


@pytest.mark.parametrize("batch", range(BATCHES))
def test_random_frames(batch: int) -> None:
    rng = np.random.default_rng(batch)
    for i in range(BATCH):
        rgb = random_frame(rng)
        height, width = rgb.shape[:2]
        fmt = ("rgb888", "rgb565")[i % 2]
        data = rgb.tobytes() if fmt == "rgb888" else to_rgb565(rgb)
        mapping = MAPPINGS[rng.integers(len(MAPPINGS))]
        call = (data, width, height, fmt, mapping)
        assert_same(c_decision(*call), numpy_decision(*call), f"{batch}/{i} {width}x{height} {fmt}")


def test_the_largest_frame() -> None:
    rgb = np.random.default_rng(1).integers(0, 256, (3840, 5120, 3), dtype=np.uint8)
    for fmt, data in (("rgb888", rgb.tobytes()), ("rgb565", to_rgb565(rgb))):
        call = (data, 5120, 3840, fmt, "ternary")
        assert_same(c_decision(*call), numpy_decision(*call), fmt)


def test_every_photograph() -> None:
    if not PHOTOGRAPHS.is_dir():
        pytest.skip("no photographs: ../shared/data is missing")
    files = sorted(PHOTOGRAPHS.rglob("*.jpg"))
    assert len(files) == 43
    for file in files:
        rgb = cv2.cvtColor(cv2.imread(str(file)), cv2.COLOR_BGR2RGB)
        small = cv2.resize(rgb, (160, 120), interpolation=cv2.INTER_AREA)
        for fmt, image in (("rgb888", rgb), ("rgb565", small)):
            data = image.tobytes() if fmt == "rgb888" else to_rgb565(image)
            call = (data, image.shape[1], image.shape[0], fmt, "ternary")
            assert_same(c_decision(*call), numpy_decision(*call), f"{file.name} {fmt}")
