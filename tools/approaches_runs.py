"""Drawn approaches through the detector with its track: one row a run and way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from approaches_frames import Seen, seen
from approaches_pictures import Pictures
from recall_trials import photograph

from chromadock import CameraModel, Detector, DockGeometry
from chromadock.variety import Backdrops, Scene, approach
from chromadock.variety.docks import ORIGINAL_WIDTH_M, dock_geometry

NEAR_M = 5.0
"""From here on a dock that the frame shows whole should be tracked."""

CLEAR = 0.5
"""Attenuation per metre below which water is clear, of a dock as wide as the original."""

HELD_S, HELD_HZ = 3.0, 10.0
SHAKE_PX, NOISE = 3, 2.0
"""Of a photograph that is held before the camera: how long and how often it is looked at, how far
it shakes to either side, and the standard deviation of each frame's own noise, codes."""

Row = dict[str, Any]


def run_trial(
    index: int,
    seed: int,
    backdrops: Backdrops,
    fixed: dict[str, str | float],
    ways: Sequence[bool],
    save: Path | None = None,
) -> list[Row]:
    """One approach, seen by one detector for each way: with the vehicle's attitude or without.

    Parameters
    ----------
    save : where to write pictures of what went wrong.
    """
    cv2.setNumThreads(1)
    detectors: list[Detector] = []
    seens: list[list[Seen]] = [[] for _ in ways]
    pictures = [Pictures(save, f"{seed}-{index}{'-attitude' if w else ''}") for w in ways]
    scene: Scene | None = None
    for scene, moment in approach(index, seed, backdrops, **fixed):
        detectors = detectors or [_detector(scene) for _ in ways]
        for way, detector, frames, saved in zip(ways, detectors, seens, pictures, strict=True):
            attitude = moment.attitude if way else None
            detection = detector.process(moment.frame_bgr, moment.time_s, attitude)
            frames.append(seen(moment, detection, scene.width_m))
            saved.add(moment, detection, frames[-1])
    assert scene is not None
    return [run_row(scene, way, frames) for way, frames in zip(ways, seens, strict=True)]


def _detector(scene: Scene) -> Detector:
    """For the scene's dock; where there is none, for the original one."""
    shown = dock_geometry("rectangle" if scene.dock == "none" else scene.dock, scene.width_m)
    return Detector(scene.camera_model, shown, mapping=scene.mapping)


def run_row(scene: Scene, attitude: bool, frames: list[Seen]) -> Row:
    """A run's factors and figures; shares are of counts, so that runs can be added up.

    ``near``: frames that show all markers nearer than NEAR_M; of them those ``near_tracked``, and
    the others by what the single frame had: ``faint`` nothing, for some marker does not stand out
    of the noise, ``unseen`` nothing though all do, ``elsewhere`` other markers than the dock's,
    ``unlocked`` the right ones before the first lock, ``lost`` after it.
    """
    near = [f for f in frames if f.shown and f.distance_m < NEAR_M]
    tracked = [f for f in frames if f.tracked]
    lock = tracked[0] if tracked else None
    missed = [f for f in near if not f.tracked]
    right = [f for f in missed if f.markers == "right"]
    early = [f for f in right if lock is None or f.time_s < lock.time_s]
    errors = [f.error for f in frames if f.error is not None]
    clearness = scene.mean_attenuation * scene.width_m / ORIGINAL_WIDTH_M
    return scene.factors() | {
        "attitude": attitude,
        "clear": clearness < CLEAR,
        "relative_attenuation": clearness,
        "lock_s": lock.time_s if lock else None,
        "lock_m": lock.distance_m if lock else None,
        "near": len(near),
        "near_tracked": len(near) - len(missed),
        "faint": sum(f.markers == "none" and not f.standing_out for f in missed),
        "unseen": sum(f.markers == "none" and bool(f.standing_out) for f in missed),
        "elsewhere": sum(f.markers == "elsewhere" for f in missed),
        "unlocked": len(early),
        "lost": len(right) - len(early),
        "posed": len(errors),
        "wrong": sum(f.wrong for f in frames),
        "worst": max(errors, default=0.0),
        "tracked": len(tracked),
        "covered": sum(bool(f.covered) for f in tracked),
        "near_found": sum(f.single == "found" for f in near),
        "found": sum(f.single == "found" for f in frames),
        "found_wrong": sum(f.single_wrong for f in frames),
        "frames": [asdict(f) for f in frames],
    }


def still_trial(path: Path, mapping: str) -> Row:
    """A photograph without a dock, held before the camera: fresh noise, and shaking.

    ``locked``: frames in which the track has a pose; ``found``: single frames that found a dock;
    ``evidence``: the most of any, decades.
    """
    cv2.setNumThreads(1)
    picture = photograph(path)
    high, wide = picture.shape[:2]
    detector = Detector(CameraModel.nominal(wide, high), DockGeometry.default(), mapping=mapping)
    rng, noise = np.random.default_rng(0), _noise(high, wide)
    row: Row = {"photograph": path.name, "mapping": mapping, "locked": 0, "found": 0}
    most = 0.0
    for k in range(round(HELD_S * HELD_HZ)):
        right, down = rng.integers(-SHAKE_PX, SHAKE_PX + 1, 2).tolist()
        shift = np.array([[1.0, 0.0, right], [0.0, 1.0, down]])
        moved = cv2.warpAffine(picture, shift, (wide, high), borderMode=cv2.BORDER_REFLECT_101)
        fresh = np.roll(noise, rng.integers(0, high, 2), (0, 1))
        frame = np.clip(moved + fresh, 0, 255).astype(np.uint8)
        detection = detector.process(frame, k / HELD_HZ)
        row["found"] += detection.found
        row["locked"] += detection.track is not None and detection.track.pose is not None
        most = max(most, detection.evidence or 0.0)
    return row | {"evidence": most}


@lru_cache(maxsize=4)
def _noise(high: int, wide: int) -> np.ndarray:
    drawn = np.random.default_rng(99).normal(0, NOISE, (high, wide, 3))
    return np.asarray(drawn.round(), np.int16)
