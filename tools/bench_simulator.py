"""What a simulated frame costs."""

from __future__ import annotations

import statistics
import time

import cv2
from bench_ratios import ROUNDS, WARM_UP, one_thread

from chromadock.sim.scene import SHIPPED, load_scene
from chromadock.sim.simulation import Simulation


def simulator_ratios() -> dict[str, float]:
    """Time one rendered VGA frame of each shipped scene against one Gaussian blur of it."""
    ratios = {}
    with one_thread():
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
    return ratios
