"""What stands like the dock is told as a misfit only where it does not fit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from robust_composites import CAMERA, DOCK, compose

from chromadock import Detector, DockGeometry
from chromadock.geometry.pose import Estimate
from chromadock.robust.find.measure import misfit

MUCH = 20 * np.log(10)
LEVEL, BEFORE = np.eye(3), np.array([0.0, 0.0, 2.0])


@pytest.mark.parametrize(
    ("evidence", "error_px", "told"),
    [(MUCH, 9.0, True), (MUCH, 0.3, False), (MUCH / 4, 9.0, False)],
)
def test_only_errors_beyond_those_of_the_places_are_a_misfit(
    evidence: float, error_px: float, told: bool
) -> None:
    """Else the command line would say "0 pixels off: check the calibration"."""
    pose = Estimate(LEVEL, BEFORE, 0.0, error_px, np.eye(6))
    amiss = misfit(evidence, (pose,), np.full(4, 0.4))
    assert (None if amiss is None else amiss.error_px) == (error_px if told else None)


def misfits(dock: DockGeometry, independent: bool) -> list[bool]:
    """Whether each of 16 pictures of the default dock has one for ``dock``."""
    told = []
    for seed in range(16):
        rng = np.random.default_rng([3, seed])
        water = np.tile(np.array([190.0, 140.0, 40.0]), (480, 640, 1)) + rng.normal(
            0, 1.5, (480, 640, 3)
        )
        scene = compose(np.clip(water, 0, 255).astype(np.uint8), 1.0 + 0.05 * seed, rng)
        detector = Detector(CAMERA, dock, independent=independent)
        told.append(detector.process(scene.frame_bgr, 0.0).misfit is not None)
    return told


@pytest.mark.parametrize("independent", [True, False])
def test_a_dock_file_that_is_too_wide_is_told_though_the_dock_is_found(
    independent: bool, record_property: Any
) -> None:
    """Its width: taken for a dock that is turned, but no turn explains the perspective."""
    wide = replace(DOCK, points=DOCK.points * (1.15, 1.0, 1.0))
    amiss, right = np.mean(misfits(wide, independent)), np.mean(misfits(DOCK, independent))
    record_property("figure", f"misfit: {amiss:.2f} of files 15 % too wide, {right:.2f} of right")
    assert right == 0
    assert amiss > 0.5
