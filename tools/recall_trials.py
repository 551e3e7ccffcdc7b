"""What a detector makes of one drawn scene, or of one photograph that shows no dock."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from limit import standing_out

from chromadock import CameraModel, Detection, Detector, DockGeometry
from chromadock.choices import MAPPINGS
from chromadock.variety import Backdrops, Scene, Truth, draw, render
from chromadock.variety.backdrops import read
from chromadock.variety.cameras import camera_model
from chromadock.variety.docks import dock_geometry, matched
from chromadock.variety.picture import through_jpeg

NEAR_PX = 3.0
NEAR_SHARE = 0.005
"""Of the frame's width: a marker is where it is within this or NEAR_PX, whichever is more."""
PLACE_SHARE = 0.05
"""Of the range: a dock is where it is within this."""
REENCODED = (None, 90, 75)
"""Ways to look at a photograph: as it is, and as JPEG of these qualities."""

Row = dict[str, Any]


@lru_cache(maxsize=32)
def _detector(
    method: str, camera: str, offset: tuple[float, float], dock: str, width: float, mapping: str
) -> Detector:
    """One for each calibration and dock of a process."""
    model, geometry = camera_model(camera, offset), dock_geometry(dock, width)
    return Detector(model, geometry, method=method, mapping=mapping, independent=True)


@lru_cache(maxsize=64)
def _plain_detector(method: str, width: int, height: int, mapping: str) -> Detector:
    """One for photographs of unknown cameras."""
    camera, dock = CameraModel.nominal(width, height), DockGeometry.default()
    return Detector(camera, dock, method=method, mapping=mapping, independent=True)


def scene_trial(
    method: str,
    index: int,
    seed: int,
    backdrops: Backdrops,
    fixed: dict[str, str | float],
    save: Path | None = None,
) -> Row:
    """Draw, render and look at one scene: its factors and what came of it.

    Parameters
    ----------
    save : where to write the picture of a dock that is missed, wrong or not there.
    """
    cv2.setNumThreads(1)
    scene = draw(index, seed, backdrops, **fixed)
    frame, truth = render(scene)
    shown = "rectangle" if truth.dock is None else scene.dock
    detector = _detector(method, scene.camera, scene.offset, shown, scene.width_m, scene.mapping)
    seen = detector.process(frame, 0.0)
    row = scene.factors() | judged(seen, truth)
    if truth.dock is not None:
        hue = seen.marker.hue_deg
        dark, _ = render(replace(scene, radiance=0.0))
        row["standing_out"] = standing_out(frame, truth.camera, truth.pixels, hue, dark)
    if save is not None and not row["recalled"] and (truth.dock is not None or seen.found):
        cv2.imwrite(str(save / f"{seed}-{index}.png"), _marked(frame, truth, seen, scene))
    return row | {"frame_width": frame.shape[1]}


def judged(seen: Detection, truth: Truth) -> Row:
    """What came of it; of no dock, whether one was found all the same."""
    row: Row = {
        "found": seen.found,
        "evidence": seen.evidence,
        "total_ms": seen.timing_ms["total"],
        "recalled": False,
        "wrong": seen.found and truth.dock is None,
        "standing_out": False,
        "apart_px": None,
        "place_error": None,
    }
    if truth.dock is None or not seen.found or seen.markers is None or seen.pose is None:
        return row
    found = np.array([p for p in seen.markers.values() if p is not None], np.float64)
    apart = np.linalg.norm(matched(truth.pixels, found) - truth.pixels, axis=1).max()
    error = float(np.linalg.norm(seen.pose.t - truth.t) / np.linalg.norm(truth.t))
    near = max(NEAR_PX, NEAR_SHARE * truth.camera.width)
    row["recalled"] = bool(apart < near) and error < PLACE_SHARE
    row["wrong"] = error >= PLACE_SHARE
    return row | {"apart_px": float(apart), "place_error": error}


def photograph(path: Path) -> np.ndarray:
    """(H, W, 3) uint8 BGR, at least 640 wide: a camera's own frames are seldom smaller."""
    picture = np.ascontiguousarray(read(path)[..., ::-1])
    high, wide = picture.shape[:2]
    if wide >= 640:
        return picture
    return np.asarray(cv2.resize(picture, (640, round(640 * high / wide))), np.uint8)


def photograph_trial(method: str, path: Path) -> list[Row]:
    """One photograph without a dock, for each mapping, as it is and as JPEG once more."""
    cv2.setNumThreads(1)
    picture = photograph(path)
    rows = []
    for quality in REENCODED:
        frame = picture if quality is None else through_jpeg(picture, quality, "4:2:0")
        for mapping in MAPPINGS:
            seen = _plain_detector(method, *frame.shape[1::-1], mapping).process(frame, 0.0)
            way = {"photograph": path.name, "mapping": mapping, "jpeg_quality": quality}
            rows.append(way | {"found": seen.found, "evidence": seen.evidence})
    return rows


def _marked(frame: np.ndarray, truth: Truth, seen: Detection, scene: Scene) -> np.ndarray:
    """The frame with the true places in white, the found in black, and what was drawn."""
    shown = frame.copy()
    for pixels, colour in ((truth.pixels, (255, 255, 255)), (_places(seen), (0, 0, 0))):
        for x, y in pixels:
            cv2.circle(shown, (round(16 * x), round(16 * y)), 16 * 14, colour, 1, cv2.LINE_AA, 4)
    words = (
        f"{scene.dock} {scene.distance_m:g} m, {scene.build}, {scene.colour} {scene.mapping}, "
        f"{scene.daylight}, {'found elsewhere' if seen.found else 'not found'}"
    )
    cv2.putText(shown, words, (6, shown.shape[0] - 8), 0, 0.45, (255, 255, 255), 1, cv2.LINE_AA)
    return shown


def _places(seen: Detection) -> list[tuple[float, float]]:
    return [p for p in (seen.markers or {}).values() if p is not None]
