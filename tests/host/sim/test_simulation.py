"""Both sides in one water, as the evaluation and the command line run them."""

from __future__ import annotations

import pickle
import sys
from pathlib import Path

import numpy as np
import pytest
from small_scene import STILL, small_scene

from chromadock import Detector
from chromadock.choices import MAPPINGS
from chromadock.errors import ChromadockError
from chromadock.method import MIN_VALUE
from chromadock.sim.scene import SHIPPED
from chromadock.sim.simulation import Simulation

RATE_HZ = 5
WARM_S = 2.0


def apart(one_deg: float, other_deg: float) -> float:
    return abs((one_deg - other_deg + 180) % 360 - 180)


@pytest.mark.parametrize("name", SHIPPED)
def test_dock_and_vehicle_agree_on_the_hue(name: str, tmp_path: Path, record_property) -> None:
    """No message between them: firmware core by its own camera, detector by the vehicle's."""
    scene = small_scene(name, tmp_path, {"vehicle.distance_m": 1.5})
    simulation = Simulation(scene)
    detector = Detector(scene.vehicle_camera.model, scene.dock)
    differences = []
    for step in simulation.steps(np.arange(0, WARM_S + 2, 1 / RATE_HZ)):
        detection = detector.process(simulation.frame(step).image_bgr, step.time_s)
        assert detection.background.hue_deg is not None
        if step.time_s >= WARM_S:
            differences.append(apart(step.dock_hue_deg, detection.marker.hue_deg))
    record_property("figure", f"{name}: hues apart by at most {max(differences):.1f} degrees")
    assert max(differences) < 6


NIGHT = {
    "light.surface_illuminance_lux": 0,
    "light.sun_elevation_deg": -40,
    "light.diffuse_share": 1,
}


@pytest.mark.parametrize("distance_m", [1.0, 2.0, 4.0, 8.0])
def test_at_night_the_glow_of_the_lamps_is_not_taken_for_the_water(
    distance_m: float, tmp_path: Path
) -> None:
    """Both take the fallback, though the vehicle's camera turns its gain up to the highest."""
    scene = small_scene("pool", tmp_path, {**NIGHT, "vehicle.distance_m": distance_m})
    simulation = Simulation(scene)
    detector = Detector(scene.vehicle_camera.model, scene.dock)
    for step in simulation.steps([0.0, 0.5, 1.0]):
        frame = simulation.frame(step).image_bgr
        detection = detector.process(frame, step.time_s)
        assert step.dock_hue_deg == detection.marker.hue_deg == 120
        assert detection.background.hue_deg is None
    # It would, by the dock's own threshold: the picture is not black.
    assert max(detection.background.rgb) >= MIN_VALUE


def test_leds_show_the_mapping_of_the_waters_hue(tmp_path: Path) -> None:
    scene = small_scene("pool", tmp_path, STILL)
    hues = {}
    for mapping in MAPPINGS:
        *_, last = Simulation(scene, mapping).steps(np.arange(0, 1, 1 / RATE_HZ))
        hues[mapping] = last.dock_hue_deg
        assert max(last.led_share) == pytest.approx(1, abs=0.01)
        assert min(last.led_share) == pytest.approx(0, abs=0.01)
    assert apart(hues["complement"], hues["ternary"] + 60) < 1
    # Pool blue is about 200 to 220 degrees, so red and magenta lead for ternary.
    assert apart(hues["ternary"], 330) < 20


@pytest.mark.parametrize(
    ("colour", "shown"), [("white", (1, 1, 1)), ("#0000FF", (0, 0, 1)), ("#200000", (1, 0, 0))]
)
def test_lamps_of_a_colour_of_their_own_do_not_follow_the_water(
    colour: str, shown: tuple[int, ...], tmp_path: Path
) -> None:
    for water in ("pool", "lake"):
        simulation = Simulation(small_scene(water, tmp_path, {**STILL, "dock.colour": colour}))
        for step in simulation.steps([0.0, 0.5]):
            assert step.led_share == pytest.approx(shown, abs=0.001)


def test_a_colour_that_only_the_vehicle_does_not_know_is_the_docks_own_choice(
    tmp_path: Path,
) -> None:
    chosen, unknown = (
        list(Simulation(small_scene("pool", tmp_path, {**STILL, **more})).steps([0.0, 0.5]))
        for more in ({}, {"dock.colour": "any"})
    )
    assert chosen == unknown


def test_steps_and_frames_do_not_depend_on_the_process(tmp_path: Path) -> None:
    simulation = Simulation(small_scene("lake", tmp_path, {"vehicle.distance_m": 1.0}))
    again = pickle.loads(pickle.dumps(simulation))
    times = np.arange(0, 0.8, 1 / RATE_HZ)
    steps = list(simulation.steps(times))
    assert list(again.steps(times)) == steps
    for step in steps[::-1]:
        one, other = (s.frame(pickle.loads(pickle.dumps(step))) for s in (simulation, again))
        np.testing.assert_array_equal(one.image_bgr, other.image_bgr)
        assert one.truth.to_dict() == other.truth.to_dict()


def test_steps_start_anew_with_every_call(tmp_path: Path) -> None:
    simulation = Simulation(small_scene("pool", tmp_path))
    times = [0.0, 0.2, 0.4]
    assert list(simulation.steps(times)) == list(simulation.steps(times))


def test_steps_come_one_by_one_without_rendering_the_vehicles_frames(tmp_path, monkeypatch) -> None:
    simulation = Simulation(small_scene("pool", tmp_path))
    monkeypatch.setattr(simulation._vehicle, "frame", None)
    endless = (i / RATE_HZ for i in range(sys.maxsize))
    assert next(simulation.steps(endless)).index == 0


def test_the_vehicles_exposure_follows_a_cloud_and_the_docks_stays_locked(tmp_path: Path) -> None:
    cloud = [{"start_s": 0.5, "fade_s": 0.5, "transmittance": 0.25}]
    simulation = Simulation(small_scene("sea", tmp_path, {**STILL, "light.cloud": cloud}))
    steps = list(simulation.steps(np.arange(0, 6, 1 / RATE_HZ)))
    first, last = steps[0].settings, steps[-1].settings
    ratio = last.exposure_s * last.gain / (first.exposure_s * first.gain)
    # The sun is behind this camera: clouds that scatter its light leave more than their share.
    assert 1.5 < ratio < 4.5
    assert len({step.dock_settings for step in steps}) == 1
    assert sum(steps[-1].dock_background) < 0.9 * sum(steps[0].dock_background)


def test_automatic_white_balance_erases_the_hue_that_the_dock_measures(tmp_path: Path) -> None:
    """The reason for locking it: grey-world balance takes the water's colour away."""
    saturation = {}
    for mode in ("daylight", "auto"):
        scene = small_scene("pool", tmp_path, {**STILL, "dock_camera.white_balance": mode})
        *_, last = Simulation(scene).steps(np.arange(0, 2, 1 / RATE_HZ))
        rgb = last.dock_background
        saturation[mode] = 1 - min(rgb) / max(rgb)
    assert saturation["daylight"] > 0.5
    assert saturation["auto"] < 0.6 * saturation["daylight"]


def test_the_dock_frame_of_a_step_is_what_the_firmware_saw(tmp_path: Path) -> None:
    simulation = Simulation(small_scene("pool", tmp_path, STILL))
    (step,) = simulation.steps([0.0])
    image = simulation.dock_frame(step).image_bgr
    assert image.shape == (120, 160, 3)
    mean = image.reshape(-1, 3).mean(axis=0)[::-1]
    np.testing.assert_allclose(mean, step.dock_background, atol=25)


def test_unknown_mappings_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ChromadockError, match="unknown mapping 'blue': choose one of ternary"):
        Simulation(small_scene("pool", tmp_path), "blue")
