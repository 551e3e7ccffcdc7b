"""The paper's method on real photographs: figures, not thresholds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from composites import CAMERA, DOCK, composites

from chromadock import Detector

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "transdec"
FRAMES_A_DISTANCE = 102  # each of the 17 backgrounds six times
NEAR_PX = 3.0

pytestmark = pytest.mark.skipif(
    not DATA.is_dir(), reason="no photographs: ../shared/data is missing"
)


def test_no_photograph_stops_the_detector(record_property: Any) -> None:
    files = sorted((DATA / "distractors").glob("*.jpg"))
    assert len(files) == 26
    detector = Detector(None, DOCK, method="paper", independent=True)
    found = sum(detector.process(cv2.imread(str(f)), 0.0).found for f in files)
    record_property("figure", f"method paper: {found} false docks on {len(files)} real frames")
    assert found < len(files)


@pytest.mark.parametrize("range_m", [1, 2, 3])
def test_recall_of_composited_markers(range_m: int, record_property: Any) -> None:
    files = sorted((DATA / "backgrounds").glob("*.jpg"))
    assert len(files) == 17
    detector = Detector(CAMERA, DOCK, method="paper", independent=True)
    found, errors = 0, []
    for seen in composites(files, range_m, FRAMES_A_DISTANCE, seed=range_m):
        detection = detector.process(seen.frame_bgr, 0.0)
        if not detection.found or detection.markers is None or detection.pose is None:
            continue
        apart = [
            np.hypot(*(np.array(detection.markers[name]) - pixel))
            for name, pixel in zip(DOCK.names, seen.pixels, strict=True)
        ]
        if max(apart) < NEAR_PX:
            found += 1
            errors.append(abs(np.linalg.norm(detection.pose.t) / range_m - 1))
    record_property(
        "figure",
        f"method paper, composited at {range_m} m: recall {found / FRAMES_A_DISTANCE:.2f} "
        f"of {FRAMES_A_DISTANCE} frames, median range error {100 * np.median(errors):.1f}%",
    )
    assert found > 0
