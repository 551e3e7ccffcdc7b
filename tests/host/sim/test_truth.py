"""The truth of a frame against the frame's own light."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from small_scene import PLAIN, STILL, small_scene

from chromadock.output import json_line
from chromadock.rotation import matrix_from_quaternion
from chromadock.sim.control import CameraSettings
from chromadock.sim.rays import solid_angles
from chromadock.sim.renderer import Renderer
from chromadock.sim.scene import Scene, load_scene
from chromadock.sim.truth import colour_of

MAGENTA = (1.0, 0.0, 1.0)
SETTINGS = CameraSettings(0.001, 1.0, (1.5, 1.0, 1.2))
NEAR_PX = 3


def lamps(scene: Scene, time_s: float = 0.0) -> np.ndarray:
    """(H, W, 3) light of the lamps alone."""
    renderer = Renderer(scene, "vehicle")
    return renderer.light(time_s, MAGENTA) - renderer.light(time_s, (0, 0, 0))


def centroid(image: np.ndarray, pixel: np.ndarray) -> np.ndarray:
    """Of the light about a place, less the halo at the rim of the window."""
    x0, y0 = np.rint(pixel).astype(int)
    ys, xs = np.mgrid[y0 - NEAR_PX : y0 + NEAR_PX + 1, x0 - NEAR_PX : x0 + NEAR_PX + 1]
    light = image[ys, xs].sum(axis=-1).astype(float)
    light -= np.median(light[[0, -1]])
    return np.array([(light * xs).sum(), (light * ys).sum()]) / light.sum()


@pytest.mark.parametrize("distance_m", [2.0, 4.0])
def test_marker_pixels_are_where_the_light_is(distance_m: float, record_property) -> None:
    overrides = {
        **PLAIN,
        "vehicle.distance_m": distance_m,
        "vehicle.offset_right_m": 0.6,
        "vehicle.aim_roll_deg": 9.0,
        "vehicle.aim_yaw_deg": 8.0,
        "vehicle.sway.yaw_deg": 3.0,
    }
    scene = load_scene("pool", overrides)
    truth = Renderer(scene, "vehicle").frame(0.4, MAGENTA, SETTINGS, 0).truth
    assert all(marker.seen for marker in truth.markers)
    image = lamps(scene, 0.4)
    apart = [np.hypot(*(centroid(image, p) - p)) for p in truth.pixels()]
    record_property("figure", f"marker pixels to centroids, {distance_m:g} m: {max(apart):.3f} px")
    assert max(apart) < 0.1


def test_pose_and_pixels_of_the_truth_belong_together(tmp_path: Path) -> None:
    scene = small_scene("lake", tmp_path, {"vehicle.distance_m": 1.3})
    truth = Renderer(scene, "vehicle").frame(2.0, MAGENTA, SETTINGS, 0).truth
    R = matrix_from_quaternion(truth.q_wxyz)
    points = scene.dock.points @ R.T + truth.T_camera_dock.t
    np.testing.assert_allclose(
        scene.vehicle_camera.model.project(points), truth.pixels(), atol=1e-6
    )
    ranges = [marker.range_m for marker in truth.markers]
    np.testing.assert_allclose(ranges, np.linalg.norm(points, axis=1))


def test_a_moving_marker_is_at_the_place_of_its_own_rows_time(
    tmp_path: Path, record_property
) -> None:
    """A steady approach from aside: velocity times the row's time from the middle of the frame."""
    approach = {"to_m": 1.0, "duration_s": 0.8}
    overrides = {**PLAIN, "vehicle.distance_m": 5.0, "vehicle.approach": approach,
                 "vehicle.aim_pitch_deg": 15.0}  # fmt: skip
    rolling = small_scene("pool", tmp_path, overrides, readout_s="0.06")
    (tmp_path / "global").mkdir()
    steady = small_scene("pool", tmp_path / "global", overrides)
    frames = {t: Renderer(steady, "vehicle").frame(t, MAGENTA, SETTINGS, 0).truth.pixels()
              for t in (0.59, 0.6, 0.61)}  # fmt: skip
    velocity = (frames[0.61] - frames[0.59]) / 0.02
    truth = Renderer(rolling, "vehicle").frame(0.6, MAGENTA, SETTINGS, 0).truth
    delay = 0.06 * (truth.pixels()[:, 1] / 119 - 0.5)
    moved = truth.pixels() - frames[0.6]
    wanted = velocity * delay[:, None]
    record_property("figure", f"rolling shutter moves markers {np.abs(wanted).max():.2f} px")
    assert np.abs(wanted).max() > 0.5
    np.testing.assert_allclose(moved, wanted, atol=0.1 * np.abs(wanted).max())
    image = lamps(rolling, 0.6)
    for pixel in truth.pixels():
        assert np.hypot(*(centroid(image, pixel) - pixel)) < 0.1


def test_contrast_is_the_light_in_the_markers_middle_over_the_waters(tmp_path: Path) -> None:
    scene = small_scene("pool", tmp_path, {**PLAIN, "vehicle.distance_m": 2.0})
    truth = Renderer(scene, "vehicle").frame(0.0, MAGENTA, SETTINGS, 0).truth
    image = lamps(scene)
    for marker, pixel in zip(truth.markers, truth.pixels(), strict=True):
        core = image[round(pixel[1]), round(pixel[0])] / truth.water_signal
        # The middle is not a pixel's, and the halo comes on top.
        assert core[0] == pytest.approx(marker.contrast[0], rel=0.6)
        assert marker.contrast[1] < 0.4 * marker.contrast[0]
    energy = [image[..., 0][r - 3 : r + 4, c - 3 : c + 4].sum()
              for c, r in truth.pixels().round().astype(int)]  # fmt: skip
    angle = solid_angles(scene.vehicle_camera.model, truth.pixels())
    assert (energy * angle > 0).all()


def test_markers_out_behind_or_aside_are_told_so(tmp_path: Path) -> None:
    dark = small_scene("pool", tmp_path, {**PLAIN, "dock.markers_out": ["top_left"]})
    lit = {
        m.name: m.lit
        for m in Renderer(dark, "vehicle").frame(0, MAGENTA, SETTINGS, 0).truth.markers
    }
    assert lit == {name: name != "top_left" for name in dark.dock.names}
    nothing = Renderer(dark, "vehicle").frame(0, (0, 0, 0), SETTINGS, 0).truth
    assert not any(m.lit or m.seen or any(m.contrast) for m in nothing.markers)
    for yaw, pixel in ((60.0, True), (90.0, False)):
        aside = small_scene(
            "pool", tmp_path, {**PLAIN, "vehicle.aim_yaw_deg": yaw, "vehicle.aim_pitch_deg": 0}
        )
        if not pixel:
            aside = small_scene(
                "pool", tmp_path, {**PLAIN, "vehicle.distance_m": 0.3, "vehicle.aim_yaw_deg": 90.0}
            )
        truth = Renderer(aside, "vehicle").frame(0, MAGENTA, SETTINGS, 0).truth
        assert not any(m.in_view for m in truth.markers)


def test_a_line_of_truth_is_strict_json_with_units_in_its_names(tmp_path: Path) -> None:
    scene = small_scene("pool", tmp_path, {"vehicle.distance_m": 0.3, "vehicle.aim_yaw_deg": 80.0,
                                           "light.surface_illuminance_lux": 0.0})  # fmt: skip
    truth = Renderer(scene, "vehicle").frame(0.1, MAGENTA, SETTINGS, 3).truth
    line = json.loads(json_line(truth.to_dict()))
    assert line["frame"] == 3
    assert set(line["markers"]) == set(scene.dock.names)
    assert any(marker["pixel"] is None for marker in line["markers"].values())
    assert line["camera"]["exposure_s"] == 0.001
    assert line["water"]["rgb"] == [0, 0, 0]
    assert max(abs(np.linalg.norm(line["T_camera_dock"]["q_wxyz"]) - 1), 0) < 1e-6


def test_the_waters_colour_is_the_one_in_the_picture() -> None:
    """Through the sensor, noise, demosaicing and all."""
    for camera in (load_scene("pool").vehicle_camera, load_scene("pool").dock_camera):
        sensor = camera.sensor
        for signal in ([500.0, 1500.0, 2500.0], [2000.0, 2100.0, 900.0], [30.0, 60.0, 50.0]):
            light = np.broadcast_to(np.float32(signal), (sensor.height, sensor.width, 3))
            settings = camera.auto_control().settle(signal)
            picture = sensor.picture(np.array(light), settings, np.random.default_rng(0))
            mean = picture.reshape(-1, 3).mean(axis=0)[::-1]
            np.testing.assert_allclose(
                colour_of(np.array(signal), sensor, settings), mean, atol=2.5
            )


def test_clouds_and_flicker_are_told(tmp_path: Path) -> None:
    cloud = [{"start_s": 1.0, "fade_s": 1.0, "transmittance": 0.25}]
    scene = small_scene("pool", tmp_path, {**STILL, "light.cloud": cloud})
    before, after = (
        Renderer(scene, "vehicle").frame(t, MAGENTA, SETTINGS, 0).truth for t in (0, 5)
    )
    assert (before.clear_share, after.clear_share) == (1, 0.25)
    ratio = after.water_signal.sum() / before.water_signal.sum()
    assert 0.15 < ratio < 0.4
    assert before.flicker != after.flicker
