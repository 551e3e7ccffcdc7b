"""The frames that the static filters are tuned on."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import cv2
import numpy as np

from chromadock.evaluate.experiment import MAX_SEED
from chromadock.evaluate.filters import STATIC
from chromadock.evaluate.fingerprint import fingerprint
from chromadock.evaluate.store import digest
from chromadock.evaluate.target import target_of
from chromadock.evaluate.tuned import Tuned
from chromadock.evaluate.tuning import MIN_CHANGE, Example, tune
from chromadock.evaluate.version import code_digest
from chromadock.paper.mask import blurred_grey
from chromadock.sim.scene import Scene, load_scene
from chromadock.sim.simulation import Simulation

SCENES = tuple(STATIC.values())
DISTANCES_M = (1.0, 3.0, 5.0)
HEADINGS_DEG = (0.0, 90.0, 180.0, 270.0)
SEED = MAX_SEED + 1
"""No experiment may have it: no evaluated frame is among these."""


def tuned_filters() -> Tuned:
    """Render the frames and tune on them, as ``tuning`` describes; a few seconds."""
    cv2.setNumThreads(1)
    return tune({name: [_example(scene) for scene in _scenes(name)] for name in SCENES})


def tuning_digest() -> str:
    """Of all that ``tuned_filters`` depends on."""
    scenes = [fingerprint(scene) for name in SCENES for scene in _scenes(name)]
    return digest(f"{scenes} {code_digest()}".encode())


def _scenes(name: str) -> Iterator[Scene]:
    for number, (distance, heading) in enumerate(itertools.product(DISTANCES_M, HEADINGS_DEG)):
        yield load_scene(
            name,
            {
                "vehicle.distance_m": distance,
                "vehicle.heading_deg": heading,
                "seed": SEED + number,
            },
        )


def _example(scene: Scene) -> Example:
    """The first frame of the scene, with the dock's LEDs as they are and dark."""
    simulation = Simulation(scene)
    step = next(simulation.steps([0.0]))
    lit = simulation.frame(step)
    dark = simulation.frame(replace(step, led_share=(0.0, 0.0, 0.0))).image_bgr
    near = target_of(scene, lit.truth).circles(dark.shape) > 0
    change = np.abs(lit.image_bgr.astype(np.int16) - dark).max(axis=2)
    return Example(
        hsv=cv2.cvtColor(lit.image_bgr, cv2.COLOR_BGR2HSV),
        grey=blurred_grey(lit.image_bgr),
        marker=near & (change >= MIN_CHANGE),
        outside=~near,
    )
