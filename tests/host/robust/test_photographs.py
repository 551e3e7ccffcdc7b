"""The robust method on real photographs; tools/recall.py prints the whole table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from robust_composites import CAMERA, DOCK, composites, read

from chromadock.colour.background import background_colour
from chromadock.colour.marker import marker_hue
from chromadock.colour.working_image import smooth, working_image
from chromadock.look import Found, Look
from chromadock.method import HUE_RANGE
from chromadock.robust.frame.layout import FINE_CELL
from chromadock.robust.frame.response import HUES, respond
from chromadock.robust.method import RobustMethod
from chromadock.robust.weigh.chroma import SPREAD
from chromadock.robust.weigh.shape import focal_px
from chromadock.stopwatch import Stopwatch

DATA = Path(__file__).resolve().parents[4] / "shared" / "data" / "transdec"
FRAMES_A_DISTANCE = 34  # each of the 17 backgrounds twice
NEAR_PX = 3.0
OFFSET_STEP = HUE_RANGE // HUES
SEED = 3
# What 34 frames can be held to: three misses beyond the targets at 204.
LEAST_RECALL = {1.0: 0.9, 2.0: 0.9, 4.0: 0.8, 5.0: 0.45}

pytestmark = pytest.mark.skipif(
    not DATA.is_dir(), reason="no photographs: ../shared/data is missing"
)


def look(method: RobustMethod, frame: np.ndarray, off: int = 0) -> Found:
    seen = background_colour(smooth(working_image(np.ascontiguousarray(frame[..., ::-1]))))
    hue = (marker_hue(seen, "ternary") + off) % HUE_RANGE
    return method.find(Look(frame, seen, hue, CAMERA), Stopwatch())


def test_at_most_one_photograph_is_taken_for_a_dock(record_property: Any) -> None:
    files = sorted(DATA.glob("*/*.jpg"))
    assert len(files) == 43
    method = RobustMethod(DOCK)
    found = [f.stem for f in files if look(method, read(f)).state == "found"]
    record_property("figure", f"method robust: {len(found)} false docks on {len(files)} frames")
    assert len(found) <= 1


@pytest.mark.parametrize("range_m", list(LEAST_RECALL))
def test_recall_of_composited_markers(range_m: float, record_property: Any) -> None:
    files = sorted((DATA / "backgrounds").glob("*.jpg"))
    assert len(files) == 17
    method, errors = RobustMethod(DOCK), []
    for scene in composites(files, range_m, FRAMES_A_DISTANCE, SEED):
        found = look(method, scene.frame_bgr)
        if found.markers is None or found.pose is None:
            continue
        apart = [
            np.hypot(*np.subtract(found.markers[name], pixel))
            for name, pixel in zip(DOCK.names, scene.pixels, strict=True)
        ]
        if max(apart) < NEAR_PX:
            errors.append(abs(float(np.linalg.norm(found.pose.t)) / range_m - 1))
    recall, error = len(errors) / FRAMES_A_DISTANCE, float(np.median(errors))
    record_property(
        "figure",
        f"method robust, composited at {range_m:g} m: recall {recall:.2f} "
        f"of {FRAMES_A_DISTANCE} frames, median range error {100 * error:.2f}%",
    )
    assert recall >= LEAST_RECALL[range_m]
    assert error < 0.01


def test_half_a_step_of_hue_off_a_dock_is_still_found(record_property: Any) -> None:
    files, method = sorted((DATA / "backgrounds").glob("*.jpg")), RobustMethod(DOCK)
    scenes = list(composites(files, 3.0, len(files), SEED))
    for off in (-OFFSET_STEP // 2, OFFSET_STEP // 2):
        seen = [look(method, scene.frame_bgr, off) for scene in scenes]
        recall = float(np.mean([f.state == "found" for f in seen]))
        record_property(
            "figure",
            f"method robust, composited at 3 m, {off * 360 / HUE_RANGE:+.0f} degrees of hue off: "
            f"recall {recall:.2f} of {len(scenes)} frames",
        )
        assert recall >= 0.9


@pytest.mark.parametrize("off", [0, OFFSET_STEP // 2])
def test_markers_at_3_m_have_one_chroma_whatever_hue_is_looked_for(off: int) -> None:
    files = sorted((DATA / "backgrounds").glob("*.jpg"))
    spreads = []
    for scene in composites(files, 3.0, len(files), SEED):
        seen = background_colour(
            smooth(working_image(np.ascontiguousarray(scene.frame_bgr[..., ::-1])))
        )
        hue = (marker_hue(seen, "ternary") + off) % HUE_RANGE
        response = respond(scene.frame_bgr, hue, focal_px(CAMERA))
        column, row = np.floor((scene.pixels + 0.5) / FINE_CELL).astype(np.intp).T
        added = response.added_at(response.layout.at(1, row, column))
        spreads.append(response.chroma(added).std(axis=0, ddof=1))
    assert np.median(spreads) < SPREAD
