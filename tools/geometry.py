"""How exactly docks of two geometries are located: the tables of docs/geometry.md.

.venv/bin/python tools/geometry.py [--frames N] [--views N] [--seed N] [--jobs N]
    [--only TABLE ...] [--write]

The rectangle and docs/five_marker_dock.toml, each at the same poses.  First by geometry alone:
projected markers with normal errors, and both poses of ``geometry.pose.estimates``: at the
poses of the composites, and straight ahead, where a plane tells its yaw worst.  Then with
markers composited on the photographs of ../shared/data (tests/robust_composites.py), through
the robust detector.  All of it is simulated.  --write puts the tables into the page.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache, partial

import cv2
import numpy as np
from step import ROOT
from told import told_poses

sys.path.insert(0, str(ROOT / "tests"))
from recall_old import COVERED, NEAR_PX, PHOTOGRAPHS, backgrounds
from robust_composites import ATTITUDE_DEG, CAMERA, compose, pose_in_view, read

from chromadock import Detector, DockGeometry
from chromadock.geometry.pose import Estimate, Sighting, estimates
from chromadock.geometry.profile import widened

PAGE = ROOT / "docs" / "geometry.md"
FIVE = ROOT / "docs" / "five_marker_dock.toml"
DOCKS = ("rectangle", "five markers")
RANGES_M = (1.0, 2.0, 3.0, 5.0, 7.0)
AHEAD_M = (5.0,)
NOISE_PX = (0.2, 0.5)
TABLES = ("geometry", "ahead", "photographs")
FRAMES = 102  # each of the 17 backgrounds six times
VIEWS = 500

View = tuple[np.ndarray, np.ndarray, np.ndarray]

# The tables stand in the page between two such lines.
BEGIN, END = "<!-- printed by tools/geometry.py: {} -->", "<!-- end -->"

HEADER = (
    "| dock | range | {} | position error, median / 95% | attitude error, median / 95% "
    "| wrong branch | in the 95% region |\n|---|---|---|---|---|---|---|"
)


@dataclass(frozen=True, slots=True)
class Errors:
    """Of the better fitting pose: metres, degrees; whether the other is nearer the truth in
    attitude; whether the truth is in the 95% region of either."""

    position_m: float
    attitude_deg: float
    wrong_branch: bool
    covered: bool


@cache
def dock(name: str) -> DockGeometry:
    """One of DOCKS."""
    return DockGeometry.default() if name == DOCKS[0] else DockGeometry.from_toml(FIVE)


@cache
def detector(name: str) -> Detector:
    """One a process."""
    cv2.setNumThreads(1)
    return Detector(CAMERA, dock(name), method="robust", independent=True)


def errors(poses: Sequence[Estimate], R: np.ndarray, t: np.ndarray) -> Errors:
    """What one or two poses, the better first, make of a true one."""
    turned = [np.linalg.norm(cv2.Rodrigues(pose.R @ R.T)[0]) for pose in poses]
    return Errors(
        position_m=float(np.linalg.norm(poses[0].t - t)),
        attitude_deg=float(np.degrees(turned[0])),
        wrong_branch=min(turned) < turned[0],
        covered=min(pose.distance(R, t) for pose in poses) < COVERED,
    )


def ahead(range_m: float, rng: np.random.Generator, seen: DockGeometry) -> View:
    """R, t and pixels of a dock in the picture's middle that is turned by yaw alone."""
    yaw = np.radians(rng.uniform(-1, 1) * ATTITUDE_DEG[1])
    R, t = cv2.Rodrigues(np.array([0.0, yaw, 0.0]))[0], np.array([0.0, 0.0, range_m])
    return R, t, CAMERA.project(seen.points @ R.T + t)


def by_geometry(
    name: str,
    range_m: float,
    sigma_px: float,
    index: int,
    seed: int,
    view: Callable[[float, np.random.Generator, DockGeometry], View] = pose_in_view,
) -> Errors:
    """One pose from projected markers with normal errors of ``sigma_px``."""
    R, t, pixels = view(range_m, random(seed, range_m, index), dock(name))
    noise = random(seed, range_m, index, 1).normal(0, sigma_px, pixels.shape)
    sigma = np.full(len(pixels), sigma_px)
    sighting = Sighting(dock(name).points, pixels + noise, sigma, CAMERA)
    poses = tuple(widened(sighting, pose) for pose in estimates(sighting))
    return errors(poses, R, t)


def on_photograph(name: str, range_m: float, index: int, seed: int) -> Errors | None:
    """One composited frame through the detector; None where the dock is not recalled."""
    files = backgrounds()
    photograph = read(files[index % len(files)])
    scene = compose(photograph, range_m, random(seed, range_m, index), dock(name))
    seen = detector(name).process(scene.frame_bgr, 0.0)
    if not seen.found or seen.markers is None:
        return None
    places = [seen.markers[marker] for marker in dock(name).names]
    if np.linalg.norm(places - scene.pixels, axis=1).max() >= NEAR_PX:
        return None
    return errors(told_poses(seen), scene.R, scene.t)


def random(seed: int, range_m: float, *index: int) -> np.random.Generator:
    """A generator for one frame, the same for both docks."""
    return np.random.default_rng([seed, round(1000 * range_m), *index])


def row(name: str, range_m: float, what: str, good: Sequence[Errors]) -> str:
    """A line of a table."""
    start = f"| {name} | {range_m:g} m | {what} |"
    if not good:
        return f"{start} - | - | - | - |"
    position = 100 / range_m * np.percentile([e.position_m for e in good], (50, 95))
    attitude = np.percentile([e.attitude_deg for e in good], (50, 95))
    wrong, covered = (np.mean([getattr(e, k) for e in good]) for k in ("wrong_branch", "covered"))
    return (
        f"{start} {position[0]:.2f} / {position[1]:.2f}% | {attitude[0]:.1f}° / {attitude[1]:.1f}° "
        f"| {100 * wrong:.0f}% | {covered:.2f} |"
    )


def geometry_table(
    views: int,
    seed: int,
    ranges_m: Sequence[float] = RANGES_M,
    view: Callable[[float, np.random.Generator, DockGeometry], View] = pose_in_view,
) -> str:
    """Accuracy by geometry alone."""
    lines = [HEADER.format("error of a marker")]
    for sigma_px in NOISE_PX:
        for name in DOCKS:
            for range_m in ranges_m:
                every = [by_geometry(name, range_m, sigma_px, i, seed, view) for i in range(views)]
                lines.append(row(name, range_m, f"{sigma_px:g} px", every))
    return "\n".join(lines)


def photograph_table(frames: int, seed: int, jobs: int) -> str:
    """Recall and accuracy on composited frames."""
    lines = [HEADER.format("recalled")]
    with ProcessPoolExecutor(jobs) as pool:
        for name in DOCKS:
            for range_m in RANGES_M:
                look = partial(on_photograph, name, range_m, seed=seed)
                seen = list(pool.map(look, range(frames), chunksize=4))
                good = [e for e in seen if e is not None]
                lines.append(row(name, range_m, f"{len(good) / frames:.2f}", good))
                print(lines[-1], file=sys.stderr, flush=True)
    return "\n".join(lines)


def written(page: str, tables: dict[str, str]) -> str:
    """The page with its tables replaced."""
    for key, table in tables.items():
        before, begin, rest = page.partition(BEGIN.format(key))
        _, end, after = rest.partition(END)
        if not (begin and end):
            raise ValueError(f"the page has no place for {key}: add {BEGIN.format(key)} and {END}")
        page = f"{before}{BEGIN.format(key)}\n{table}\n{END}{after}"
    return page


def main() -> int:
    """Print the tables; exit status 3 without photographs."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--frames", type=int, default=FRAMES, help="composited, a range")
    parser.add_argument("--views", type=int, default=VIEWS, help="by geometry alone, a range")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", nargs="+", choices=TABLES, default=TABLES)
    parser.add_argument("--write", action="store_true", help=f"into {PAGE.relative_to(ROOT)}")
    args = parser.parse_args()
    if not PHOTOGRAPHS.is_dir():
        print(f"no photographs: {PHOTOGRAPHS.relative_to(ROOT.parent)} is missing", file=sys.stderr)
        return 3
    makers = {
        "geometry": lambda: geometry_table(args.views, args.seed),
        "ahead": lambda: geometry_table(args.views, args.seed, AHEAD_M, ahead),
        "photographs": lambda: photograph_table(args.frames, args.seed, args.jobs),
    }
    tables = {key: makers[key]() for key in args.only}
    for key, table in tables.items():
        print(f"{key}\n\n{table}\n")
    if args.write:
        temporary = PAGE.with_suffix(".md.new")
        temporary.write_text(written(PAGE.read_text(encoding="utf-8"), tables), encoding="utf-8")
        temporary.replace(PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
