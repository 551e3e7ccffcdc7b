"""The table of docs/robust.md: one dock, one camera, one brightness, on 17 photographs.

Markers are composited on the photographs of ../shared/data (tests/robust_composites.py); the
same seed makes the same frames.  A dock is recalled if every marker is within NEAR_PX; the true
pose is covered if it lies in the 95% region of either of the two poses.  ``limit`` is the share
of frames in which every marker is MIN_SNR times the local noise or more at its true place: about
what one frame allows.  False docks are counted on all photographs as they are, and, to know the
rate below one in 43, also mirrored left to right and looked at for the other mappings' colours.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path

import cv2
import numpy as np
from limit import standing_out
from step import ROOT
from told import told_poses

sys.path.insert(0, str(ROOT / "tests"))
from robust_composites import CAMERA, DOCK, compose, read

from chromadock import Detection, Detector
from chromadock.choices import MAPPINGS
from chromadock.rotation import matrix_from_quaternion

PHOTOGRAPHS = ROOT.parent / "shared" / "data" / "transdec"
DISTANCES_M = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
FRAMES = 204  # each of the 17 backgrounds twelve times
NEAR_PX = 3.0
COVERED = 12.59  # chi-square with six degrees of freedom, 95%


@dataclass(frozen=True, slots=True)
class Trial:
    """What a detector made of one composite; errors are of a recalled dock."""

    range_m: float
    found: bool
    recalled: bool
    standing_out: bool
    range_error: float = np.nan
    attitude_error_deg: float = np.nan
    covered: bool | None = None
    total_ms: float = np.nan


def backgrounds() -> list[Path]:
    """The photographs without anything that could be a dock's."""
    return sorted((PHOTOGRAPHS / "backgrounds").glob("*.jpg"))


@cache
def detector(method: str, mapping: str = "ternary") -> Detector:
    """One a process."""
    cv2.setNumThreads(1)
    return Detector(CAMERA, DOCK, method=method, mapping=mapping, independent=True)


def trial(method: str, range_m: float, seed: int, index: int) -> Trial:
    """Compose one frame and look at it."""
    files = backgrounds()
    rng = np.random.default_rng([seed, round(1000 * range_m), index])
    scene = compose(read(files[index % len(files)]), range_m, rng)
    seen = detector(method).process(scene.frame_bgr, 0.0)
    total_ms = seen.timing_ms["total"]
    stands_out = standing_out(scene.frame_bgr, CAMERA, scene.pixels, seen.marker.hue_deg)
    if not seen.found or seen.markers is None or seen.pose is None:
        return Trial(range_m, False, False, stands_out, total_ms=total_ms)
    apart = [
        np.hypot(*np.subtract(seen.markers[name], pixel))
        for name, pixel in zip(DOCK.names, scene.pixels, strict=True)
    ]
    if max(apart) >= NEAR_PX:
        return Trial(range_m, True, False, stands_out, total_ms=total_ms)
    turn = matrix_from_quaternion(seen.pose.q_wxyz).T @ scene.R
    cosine = np.clip((np.trace(turn) - 1) / 2, -1, 1)
    return Trial(
        range_m,
        True,
        True,
        stands_out,
        range_error=float(np.linalg.norm(seen.pose.t) / np.linalg.norm(scene.t) - 1),
        attitude_error_deg=float(np.degrees(np.arccos(cosine))),
        covered=_covered(seen, scene.R, scene.t),
        total_ms=total_ms,
    )


def _covered(seen: Detection, R: np.ndarray, t: np.ndarray) -> bool | None:
    """Whether the truth lies in the region of either pose; None without a covariance."""
    poses = told_poses(seen)
    return bool(min(pose.distance(R, t) for pose in poses) < COVERED) if poses else None


def false_docks(method: str, photograph: Path) -> list[tuple[str, bool, bool]]:
    """Mapping, mirrored and found, each way to look at one photograph."""
    frame = read(photograph)
    ways = product(MAPPINGS, (False, True))
    return [
        (mapping, mirrored, _found(method, mapping, frame[:, ::-1] if mirrored else frame))
        for mapping, mirrored in ways
    ]


def _found(method: str, mapping: str, frame_bgr: np.ndarray) -> bool:
    return detector(method, mapping).process(np.ascontiguousarray(frame_bgr), 0.0).found


def table(trials: list[Trial]) -> Iterator[str]:
    """One line a distance."""
    yield "distance  frames  recall  limit  wrong  range error  attitude error  covered  median ms"
    for range_m in sorted({t.range_m for t in trials}):
        here = [t for t in trials if t.range_m == range_m]
        good = [t for t in here if t.recalled]
        wrong = sum(t.found and not t.recalled for t in here)
        off = np.median([abs(t.range_error) for t in good]) if good else np.nan
        turned = np.median([t.attitude_error_deg for t in good]) if good else np.nan
        known = [t.covered for t in good if t.covered is not None]
        covered = f"{np.mean(known):7.3f}" if known else "      -"
        total_ms = np.median([t.total_ms for t in here])
        yield (
            f"{range_m:6.1f} m  {len(here):6d}  {len(good) / len(here):6.3f}"
            f"  {np.mean([t.standing_out for t in here]):5.3f}  {wrong:5d}"
            f"  {100 * off:9.2f} %  {turned:9.1f} deg  {covered}  {total_ms:9.2f}"
        )


def main(
    method: str, frames: int | None, seed: int, jobs: int, distances: list[float] | None
) -> int:
    """Print the table and the false docks; exit status 3 without photographs."""
    if not PHOTOGRAPHS.is_dir():
        print(f"no photographs: {PHOTOGRAPHS.relative_to(ROOT.parent)} is missing", file=sys.stderr)
        return 3
    with ProcessPoolExecutor(jobs) as pool:
        work = list(product(distances or DISTANCES_M, range(frames or FRAMES)))
        trials = [pool.submit(trial, method, d, seed, i) for d, i in work]
        print(f"method {method}, seed {seed}")
        for line in table([job.result() for job in trials]):
            print(line)
        files = sorted(PHOTOGRAPHS.glob("*/*.jpg"))
        looks = [pool.submit(false_docks, method, f) for f in files]
        seen = [(f, look) for f, job in zip(files, looks, strict=True) for look in job.result()]
    plain = [f.stem for f, look in seen if look == ("ternary", False, True)]
    every = sum(found for _, (_, _, found) in seen)
    print(f"false docks: {len(plain)} on {len(files)} photographs {' '.join(plain)}")
    print(f"             {every} of {len(seen)} with those mirrored and the other mappings")
    return 0
