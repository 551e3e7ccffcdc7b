"""Times ``Detector.process`` against one Gaussian blur of the same frame; host memory."""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
PHOTOGRAPHS = ROOT.parent / "shared" / "data" / "transdec"

WIDTH, HEIGHT = 640, 480  # what the budget is for: photographs of other sizes are passed over
PER_FOLDER = 3

ROUNDS = 31
WARM_UP = 3


class SkippedError(Exception):
    """Why it cannot be measured here, in one line."""


def host_ratios() -> tuple[dict[str, float], list[str]]:
    """Measure every scene.

    Returns:
        Ratios by "scene" and "scene/stage", and a line for each part that was left out.

    Raises:
        SkippedError: the host package cannot be used.
    """
    try:
        import cv2

        from chromadock import Detector, DockGeometry
    except ImportError as error:
        raise SkippedError(f"host: {error}") from error

    photographs, skipped = real_frames()
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        ratios: dict[str, float] = {}
        for scene, frame in {"water": plain_water(), **photographs}.items():
            detector = Detector(
                camera=None,
                dock=DockGeometry.default(),
                method="paper",
                mapping="ternary",
                independent=True,
            )
            ratios.update(scene_ratios(scene, frame, detector))
    finally:
        cv2.setNumThreads(threads)
    return ratios, skipped


def simulator_ratios() -> dict[str, float]:
    """Time one rendered VGA frame of each shipped scene against one Gaussian blur of it.

    Raises:
        SkippedError: the simulator cannot be used.
    """
    import cv2

    try:
        from chromadock.sim.scene import SHIPPED, load_scene
        from chromadock.sim.simulation import Simulation
    except ImportError as error:
        raise SkippedError(f"simulator: {error}") from error

    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        ratios = {}
        for scene in SHIPPED:
            simulation = Simulation(load_scene(scene))
            frames = []
            for step in simulation.steps(turn / 30 for turn in range(WARM_UP + ROUNDS)):
                start = time.perf_counter()
                picture = simulation.frame(step).image_bgr
                between = time.perf_counter()
                cv2.GaussianBlur(picture, (5, 5), 0)
                frames.append((between - start) / (time.perf_counter() - between))
            ratios[scene] = round(statistics.median(frames[WARM_UP:]), 1)
    finally:
        cv2.setNumThreads(threads)
    return ratios


def resident_mib(frames: int = 60) -> float:
    """Most memory that ``chromadock detect`` holds on a VGA video, MiB."""
    import cv2

    with tempfile.TemporaryDirectory() as folder:
        video = str(Path(folder) / "vga.mp4")
        codec = cv2.VideoWriter_fourcc(*"mp4v")
        writer = cv2.VideoWriter(video, codec, 30, (WIDTH, HEIGHT))
        for _ in range(frames):
            writer.write(plain_water())
        writer.release()
        # In a process of its own: the figure is the largest of all its children.
        done = subprocess.run(
            [sys.executable, __file__, video], check=True, capture_output=True, text=True
        )
    return float(done.stdout)


def plain_water() -> Any:
    """Make a frame of blue-green water, darker downwards, with a camera's noise."""
    import numpy as np

    light = np.linspace(1.15, 0.85, HEIGHT)[:, None, None]
    colour = np.array([190.0, 140.0, 40.0])  # blue, green, red
    noise = np.random.default_rng(0).normal(0.0, 3.0, (HEIGHT, WIDTH, 3))
    return np.clip(colour * light + noise, 0, 255).astype(np.uint8)


def real_frames() -> tuple[dict[str, Any], list[str]]:
    """Read the first photographs of each kind, and say so if there are none."""
    import cv2

    if not PHOTOGRAPHS.is_dir():
        return {}, [
            f"real frames: no folder {PHOTOGRAPHS.relative_to(ROOT.parent)} beside this one"
        ]
    frames: dict[str, Any] = {}
    for folder in ("backgrounds", "distractors"):
        found = 0
        for path in sorted((PHOTOGRAPHS / folder).glob("*.jpg")):
            frame = cv2.imread(str(path))
            if found < PER_FOLDER and frame is not None and frame.shape == (HEIGHT, WIDTH, 3):
                frames[f"{folder}-{path.stem}"] = frame
                found += 1
    return frames, []


def scene_ratios(scene: str, frame: Any, detector: Any) -> dict[str, float]:
    """Time blur and detector in turns; the median of the ratios of neighbours."""
    import cv2

    ratios: dict[str, list[float]] = {}
    for turn in range(WARM_UP + ROUNDS):
        start = time.perf_counter()
        cv2.GaussianBlur(frame, (5, 5), 0)
        between = time.perf_counter()
        detection = detector.process(frame, 0.0)
        end = time.perf_counter()
        if turn < WARM_UP:
            continue
        blur_s = between - start
        ratios.setdefault(scene, []).append((end - between) / blur_s)
        for stage, stage_ms in detection.timing_ms.items():
            if stage != "total":
                ratios.setdefault(f"{scene}/{stage}", []).append(stage_ms / 1000 / blur_s)
    return {name: round(statistics.median(values), 3) for name, values in ratios.items()}


def main() -> None:
    """Run ``chromadock detect`` on a video and print the memory it took, MiB."""
    detect = [sys.executable, "-m", "chromadock", "detect", sys.argv[1], "--json"]
    subprocess.run(detect, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)


if __name__ == "__main__":
    main()
