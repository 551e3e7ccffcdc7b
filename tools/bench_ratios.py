"""Times work on a frame against one 5 x 5 Gaussian blur of the same frame.

Blur and work take turns in one process, OpenCV in one thread, and the median of the ratios of
neighbours is kept.  Counted is the processor's time, not the clock's: on a busy computer the
longer work is interrupted and the blur is not; and threads that a library starts are no gain.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

import cv2
import numpy as np

from chromadock import Detector, DockGeometry

ROUNDS = 101
WARM_UP = 20


@contextmanager
def one_thread() -> Iterator[None]:
    """OpenCV in one thread."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield
    finally:
        cv2.setNumThreads(threads)


def detector_ratios(
    scenes: Mapping[str, np.ndarray], method: str = "robust", rounds: int = ROUNDS
) -> dict[str, float]:
    """Measure ``Detector.process``, each frame alone.

    Parameters
    ----------
    scenes : (H, W, 3) uint8 BGR frames by name.

    Returns
    -------
    Ratios by "scene" and "scene/stage".
    """
    ratios: dict[str, float] = {}
    with one_thread():
        detector = Detector(None, DockGeometry.default(), method=method, independent=True)
        for scene, frame in scenes.items():
            ratios |= _scene_ratios(scene, frame, detector, rounds)
    return ratios


def tracked_ratios(
    scenes: Mapping[str, np.ndarray], frames: int = ROUNDS
) -> dict[str, tuple[float, float]]:
    """Measure ``Detector.process`` with its track, on views of a scene at 30 frames a second.

    Four times a second a marker that is out is looked for, and what is not sure yet is looked at
    again where it was: few frames take long, and so the mean and the 98th percentile are returned.
    """
    ratios = {}
    with one_thread():
        for scene, frame in scenes.items():
            detector = Detector(None, DockGeometry.default())
            # To and fro: no vehicle jumps.
            views = [np.roll(frame, shift, axis=1) for shift in (0, 1, 2, 3, 4, 3, 2, 1)]
            values = []
            for turn in range(WARM_UP + frames):
                view = views[turn % len(views)]
                blur_s = _blur_s(view)
                start = time.process_time()
                detector.process(view, turn / 30)
                values.append((time.process_time() - start) / blur_s)
            measured = values[WARM_UP:]
            longest = float(np.quantile(measured, 0.98))
            ratios[scene] = (round(statistics.mean(measured), 3), round(longest, 3))
    return ratios


def ratio(frame: np.ndarray, work: Callable[[], object], rounds: int = ROUNDS) -> float:
    """Measure any work that belongs to a frame; to be called in ``one_thread``."""
    for _ in range(WARM_UP):
        _blur_s(frame)
        work()
    values = []
    for _ in range(rounds):
        blur_s = _blur_s(frame)
        start = time.process_time()
        work()
        values.append((time.process_time() - start) / blur_s)
    return round(statistics.median(values), 3)


def totals(ratios: Mapping[str, float]) -> dict[str, float]:
    """The scenes' own ratios, without those of their stages."""
    return {name: value for name, value in ratios.items() if "/" not in name}


def by_cost(ratios: Mapping[str, float]) -> list[str]:
    """Names of scenes, the cheapest first."""
    return sorted(totals(ratios), key=lambda name: ratios[name])


def _scene_ratios(
    scene: str, frame: np.ndarray, detector: Detector, rounds: int
) -> dict[str, float]:
    detections = [detector.process(frame, 0.0)]
    total = ratio(frame, lambda: detections.append(detector.process(frame, 0.0)), rounds)
    laps = [detection.timing_ms for detection in detections[1 + WARM_UP :]]
    # The detector's own clock also counts interruptions: of each stage the lap with the least.
    shortest = {stage: min(lap[stage] for lap in laps) for stage in laps[0] if stage != "total"}
    scale = total / sum(shortest.values())
    parts = {f"{scene}/{stage}": round(scale * ms, 3) for stage, ms in shortest.items()}
    return {scene: total, **parts}


def _blur_s(frame: np.ndarray) -> float:
    start = time.process_time()
    cv2.GaussianBlur(frame, (5, 5), 0)
    return time.process_time() - start
