"""Fits what a lamp looks like beside clutter: host/chromadock/robust/frame/likeness.toml.

.venv/bin/python tools/fit_likeness.py [--scenes N] [--simulated N] [--looks N]
    [--photographs FOLDER ...]

scipy, which it needs, is installed by ``tools/setup bench``.

Peaks of drawn scenes of the develop half that are a marker's are lamps; those far from every
marker, of scenes without other lamps, and those of photographs, as they are and coded as JPEG
once more, are clutter.  So are those of the simulator's frames, in the waters and the light of the
experiments, with waves and noise of their own: lamps that are composited into photographs alone
tell too little of what others may look like.  Each distance counts as much as the others, or near
docks, which have every one of their lamps among the peaks, would tell what far ones look like.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from network import RIDGE, Network
from step import ROOT

from chromadock._native import lib
from chromadock.colour.marker import marker_hue
from chromadock.colour.vehicle import vehicle_background
from chromadock.errors import ChromadockError
from chromadock.evaluate.experiment import read_experiment
from chromadock.evaluate.runs import Run, runs_of
from chromadock.method import HUE_RANGE
from chromadock.robust.frame import likeness
from chromadock.robust.frame.likeness import FILE, inputs
from chromadock.robust.frame.peaks import Peaks, find_peaks
from chromadock.robust.frame.response import respond
from chromadock.robust.weigh.shape import focal_px
from chromadock.sim.simulation import Simulation
from chromadock.variety import Backdrops, Half, draw, render
from chromadock.variety.factors import variety

BACKGROUNDS = ROOT.parent / "shared" / "data" / "transdec" / "backgrounds"
EXPERIMENTS = [
    ROOT / "experiments" / f"{name}.toml"
    for name in ("mapping_clear", "mapping_turbid", "conditions", "daylight", "exposure")
]
SIMULATED_SEED = 1001
"""Of waves, sway and noise: none of an experiment's own."""
SIMULATED_FAR_M = 4.0
"""Simulated frames are of two kinds, or their near docks would count for most."""
TARGET = Path(likeness.__file__).with_name(FILE)
LAMPS_CELLS, CLUTTER_CELLS = 0.8, 4.0
"""From a marker's true place: what is nearer is the marker, what is farther clutter."""
FOCAL_PX = 554.0
"""Of photographs whose camera is not known."""


@dataclass(frozen=True, eq=False)
class Sample:
    """Peaks of one frame: (N, LOOKS) looks, (N,) strength, scale and whether they are lamps;
    ``kind``: the distance of the dock, or what else it is."""

    looks: np.ndarray
    snr: np.ndarray
    scale: np.ndarray
    lamp: np.ndarray
    kind: str


def scene_sample(index: int, backdrops: Backdrops) -> Sample:
    """Peaks of a drawn scene."""
    cv2.setNumThreads(1)
    distances = tuple(variety().shares["distance"])
    distance = distances[index % len(distances)]
    scene = draw(index, Half.DEVELOP.seed(5), backdrops, distance=distance)
    frame, truth = render(scene)
    hue = marker_hue(vehicle_background(frame), scene.mapping)
    every = find_peaks(respond(frame, hue, focal_px(truth.camera)))
    others = {thing.kind for thing in scene.things} & {"lamp"}
    return _sample(every, truth.pixels, distance, clutter=not others)


def _sample(every: dict[int, Peaks], pixels: np.ndarray, kind: str, clutter: bool = True) -> Sample:
    """Peaks of a frame with (n, 2) markers; ``clutter``: whether the others are."""
    parts = []
    for scale, (cell, peaks) in enumerate(every.items()):
        away = np.linalg.norm(peaks.xy[:, None] - pixels, axis=2).min(axis=1, initial=np.inf)
        lamp = away < LAMPS_CELLS * cell
        kept = lamp | ((away > CLUTTER_CELLS * cell) & clutter)
        parts.append((peaks.looks[kept], peaks.snr[kept], np.full(kept.sum(), scale), lamp[kept]))
    return Sample(*(np.concatenate(values) for values in zip(*parts, strict=True)), kind)


def simulated_runs(frames: int) -> list[Run]:
    """About so many frames of the experiments' waters and light, with a seed of their own."""
    runs = []
    for path in EXPERIMENTS:
        experiment = read_experiment(path).model_copy(update={"seed": SIMULATED_SEED})
        runs += runs_of(experiment, path)
    each = max(1, round(frames / len(runs)))
    return [replace(run, frames=min(each, run.frames)) for run in runs]


def simulated_samples(run: Run) -> list[Sample]:
    """Peaks of the vehicle's frames of a run."""
    cv2.setNumThreads(1)
    simulation, samples = Simulation(run.scene, run.mapping), []
    for step in simulation.steps(run.time_s(frame) for frame in range(run.frames)):
        frame = simulation.frame(step)
        hue = marker_hue(vehicle_background(frame.image_bgr), run.mapping)
        focal = focal_px(run.scene.vehicle_camera.model)
        every = find_peaks(respond(frame.image_bgr, hue, focal))
        seen = frame.truth.pixels()[[marker.in_view for marker in frame.truth.markers]]
        far = "far" if run.distance_m >= SIMULATED_FAR_M else "near"
        samples.append(_sample(every, seen, f"simulated {far}"))
    return samples


def photograph_sample(path: Path, seed: int) -> Sample:
    """Peaks of a photograph without a dock, for a hue at random, every second time as JPEG."""
    cv2.setNumThreads(1)
    rng = np.random.default_rng([seed, 7])
    frame = cv2.resize(cv2.imread(str(path)), (640, 480), interpolation=cv2.INTER_AREA)
    if rng.random() < 0.5:
        quality = [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(60, 96))]
        frame = cv2.imdecode(cv2.imencode(".jpg", frame, quality)[1], cv2.IMREAD_COLOR)
    every = list(find_peaks(respond(frame, int(rng.integers(HUE_RANGE)), FOCAL_PX)).values())
    counts = [len(peaks.snr) for peaks in every]
    return Sample(
        np.concatenate([peaks.looks for peaks in every]),
        np.concatenate([peaks.snr for peaks in every]),
        np.repeat(np.arange(len(every)), counts),
        np.zeros(sum(counts), bool),
        "photograph",
    )


def regression(design: np.ndarray, lamp: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Coefficients of a logistic regression by Newton's method."""
    b = np.zeros(design.shape[1])
    for _ in range(60):
        p = 1 / (1 + np.exp(-np.clip(design @ b, -30, 30)))
        gradient = design.T @ (weight * (lamp - p)) - RIDGE * b
        curvature = (design * (weight * p * (1 - p))[:, None]).T @ design
        step = np.linalg.solve(curvature + RIDGE * np.eye(len(b)), gradient)
        b += step
        if np.abs(step).max() < 1e-6:
            break
    return b


def main() -> int:
    """Fit and write the table; exit status 2 for a wrong folder, 3 without photographs."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", type=int, default=3200)
    parser.add_argument("--simulated", type=int, default=1000, help="frames, about")
    parser.add_argument("--looks", type=int, default=800, help="photographs, at most")
    parser.add_argument("--photographs", nargs="*", type=Path, default=(), metavar="FOLDER")
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    if not BACKGROUNDS.is_dir():
        print(f"no photographs: {BACKGROUNDS.relative_to(ROOT.parent)} is missing", file=sys.stderr)
        return 3
    try:
        backdrops = Backdrops.of_folders(BACKGROUNDS, args.photographs).half(Half.DEVELOP)
    except ChromadockError as error:
        print(error, file=sys.stderr)
        return 2
    files = [*backdrops.plain, *backdrops.other]
    chosen = np.random.default_rng(0).permutation(len(files))[: args.looks]
    with ProcessPoolExecutor(args.jobs) as pool:
        jobs = [pool.submit(scene_sample, i, backdrops) for i in range(args.scenes)]
        jobs += [pool.submit(photograph_sample, files[k], int(k)) for k in chosen]
        runs = [pool.submit(simulated_samples, run) for run in simulated_runs(args.simulated)]
        samples = [job.result() for job in jobs] + [s for run in runs for s in run.result()]
    looks, snr, scale, lamp = (
        np.concatenate([getattr(s, name) for s in samples])
        for name in ("looks", "snr", "scale", "lamp")
    )
    weight = np.concatenate([np.full(len(s.lamp), _worth(s.kind, samples)) for s in samples])
    weight = np.where(lamp, weight, 1.0)
    told = inputs(looks, snr, scale)
    network = Network(told)
    network.fit(told, lamp, weight)
    base = np.column_stack([told[:, -(lib.FRONT_BASE - 1) :], np.ones(len(told))])
    without = regression(base, lamp, weight)
    table = network.weights() | {"without": without}
    lines = [
        f"# Generated by tools/fit_likeness.py from {int(lamp.sum())} lamps and "
        f"{int((~lamp).sum())} peaks of clutter: do not edit.",
        *(f"{name} = {_rows(values)}" for name, values in table.items()),
    ]
    TARGET.write_text("\n".join(lines) + "\n", encoding="utf-8")
    ratio = network.log_odds(told) - base @ without
    print(lines[0])
    print("natural log of the ratio at 10, 50 and 90%:")
    print("lamps  ", np.round(np.quantile(ratio[lamp], [0.1, 0.5, 0.9]), 1))
    print("clutter", np.round(np.quantile(ratio[~lamp], [0.1, 0.5, 0.9]), 1))
    return 0


def _rows(values: np.ndarray) -> str:
    """An array, or one of arrays, as TOML has it."""
    if values.ndim == 1:
        return f"[{', '.join(f'{v:.4f}' for v in values)}]"
    rows = "".join(f"    {_rows(row)},\n" for row in values)
    return f"[\n{rows}]"


def _worth(kind: str, samples: list[Sample]) -> float:
    """Weight of each lamp of a kind, such that all kinds have the same in sum."""
    lamps = {
        k: sum(s.lamp.sum() for s in samples if s.kind == k) for k in {s.kind for s in samples}
    }
    mean = np.mean([n for n in lamps.values() if n])
    return float(mean / lamps[kind]) if lamps[kind] else 1.0


if __name__ == "__main__":
    sys.exit(main())
