"""A dock at dusk and at night, its lamps much too bright for the camera: simulated."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from chromadock import Detector
from chromadock.sim.scene import load_scene
from chromadock.sim.simulation import Simulation

DARK = {
    "dusk": {"light.surface_illuminance_lux": 3, "light.sun_elevation_deg": -6},
    "night": {"light.surface_illuminance_lux": 0, "light.sun_elevation_deg": -40},
}
LAKE: dict[str, Any] = {
    "water": {"kind": "lake", "visibility_m": 6.0},
    "place": {
        "depth_m": 1.1,
        "floor_depth_m": 4.0,
        "floor_rgb": [0.12, 0.1, 0.06],
        "wind_m_s": 3.0,
    },
}
SWAY = {"dock.sway": {"yaw_deg": 20.0, "pitch_deg": 8.0, "roll_deg": 8.0, "period_s": 3.7}}
FRAMES = 6


@pytest.mark.parametrize("light", DARK)
@pytest.mark.parametrize("water", [{}, LAKE], ids=["pool", "lake"])
def test_overexposed_lamps_are_where_they_are(
    light: str, water: dict[str, Any], record_property: Any
) -> None:
    changes = {**DARK[light], "light.diffuse_share": 1, **water, **SWAY}
    scene = load_scene("pool", changes | {"vehicle.distance_m": 2.0})
    simulation = Simulation(scene)
    detector = Detector(scene.vehicle_camera.model, scene.dock, independent=True)
    errors = []
    for step in simulation.steps(5.0 * np.arange(FRAMES)):
        frame = simulation.frame(step)
        detection = detector.process(frame.image_bgr, step.time_s)
        assert detection.pose is not None and detection.clipped == 1.0
        true = frame.truth.T_camera_dock.t
        errors.append(float(np.linalg.norm(detection.pose.t - true) / np.linalg.norm(true)))
    record_property("figure", f"overexposed by {light}: places off by {100 * max(errors):.1f} %")
    assert max(errors) < 0.04 and np.median(errors) < 0.02
