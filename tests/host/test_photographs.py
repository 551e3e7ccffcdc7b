"""The paper's method on real photographs: figures, not thresholds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from composites import CAMERA, DOCK, composites

from chromadock import Detector
from chromadock.paper import blobs

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
    recall, error = recall_at(range_m)
    record_property(
        "figure",
        f"method paper, composited at {range_m} m: recall {recall:.2f} "
        f"of {FRAMES_A_DISTANCE} frames, median range error {100 * error:.1f}%",
    )
    assert recall > 0


def test_the_mask_as_printed_loses_near_markers(
    record_property: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(blobs, "_WIDEN", np.ones((1, 1), np.uint8))
    recall, _ = recall_at(1)
    record_property("figure", f"method paper, mask not widened, 1 m: recall {recall:.2f}")
    assert recall < 0.3


def recall_at(range_m: float) -> tuple[float, float]:
    """Share of frames with every marker within 3 px, median relative range error of those."""
    files = sorted((DATA / "backgrounds").glob("*.jpg"))
    assert len(files) == 17
    detector = Detector(CAMERA, DOCK, method="paper", independent=True)
    errors = []
    for seen in composites(files, range_m, FRAMES_A_DISTANCE, seed=int(range_m)):
        detection = detector.process(seen.frame_bgr, 0.0)
        if detection.markers is None or detection.pose is None:
            continue
        apart = [
            np.hypot(*(np.array(detection.markers[name]) - pixel))
            for name, pixel in zip(DOCK.names, seen.pixels, strict=True)
        ]
        if max(apart) < NEAR_PX:
            errors.append(abs(float(np.linalg.norm(detection.pose.t)) / range_m - 1))
    return len(errors) / FRAMES_A_DISTANCE, float(np.median(errors)) if errors else np.nan
