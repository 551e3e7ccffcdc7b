"""Whole frames: what hides what, what is pure, what each camera sees."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from small_scene import PLAIN, STILL, small_scene

from chromadock.sim.control import CameraSettings
from chromadock.sim.renderer import Renderer
from chromadock.sim.scene import SHIPPED, load_scene

MAGENTA = (1.0, 0.0, 1.0)
SETTINGS = CameraSettings(0.001, 1.0, (1.5, 1.0, 1.2))


def near(image: np.ndarray, pixel: np.ndarray, reach: int = 2) -> np.ndarray:
    x, y = np.rint(pixel).astype(int)
    return image[y - reach : y + reach + 1, x - reach : x + reach + 1]


def test_a_buoy_before_a_marker_hides_it_in_truth_and_picture(tmp_path: Path) -> None:
    buoy = {"shape": "sphere", "rgb": [0.8, 0.2, 0.02], "radius_m": 0.05,
            "centre_m": [-0.445, -0.0635, -0.4]}  # fmt: skip
    free, hidden = (
        small_scene("pool", tmp_path, {**PLAIN, "vehicle.distance_m": 2.0, "body": bodies,
                                       "vehicle.offset_right_m": 0.0})
        for bodies in ([], [{**buoy, "centre_m": [-0.445 * 0.8, -0.0635 * 0.8, -0.4]}])
    )  # fmt: skip
    truths = [Renderer(s, "vehicle").frame(0.0, MAGENTA, SETTINGS, 0).truth for s in (free, hidden)]
    shares = [{m.name: m.visible for m in truth.markers} for truth in truths]
    assert shares[0] == dict.fromkeys(free.dock.names, 1.0)
    assert shares[1] == {**shares[0], "top_left": 0.0}
    assert not truths[1].markers[free.dock.names.index("top_left")].seen
    for scene, truth in zip((free, hidden), truths, strict=True):
        renderer = Renderer(scene, "vehicle")
        lamps = renderer.light(0.0, MAGENTA) - renderer.light(0.0, (0, 0, 0))
        for marker, pixel in zip(truth.markers, truth.pixels(), strict=True):
            core = near(lamps, pixel)[..., 0].max() / truth.water_signal[0]
            assert (core > 1) == marker.seen, marker.name
    image = Renderer(hidden, "vehicle").light(0.0, (0, 0, 0))
    orange = near(image, truths[1].pixels()[free.dock.names.index("top_left")])
    open_water = near(image, [80, 40])
    assert orange[..., 0].mean() / orange[..., 2].mean() > 2 * (
        open_water[..., 0].mean() / open_water[..., 2].mean()
    )


def test_the_docks_own_parts_hide_no_marker_of_shipped_scenes() -> None:
    for name in ("pool", "lake", "sea"):
        scene = load_scene(name)
        renderer = Renderer(scene, "vehicle")
        for time_s in (0.0, 1.7, 5.0):
            truth = renderer.frame(time_s, MAGENTA, SETTINGS, 0).truth
            assert all(marker.seen and marker.visible == 1 for marker in truth.markers)


def test_a_frame_is_a_pure_function_of_its_arguments(tmp_path: Path) -> None:
    scene = small_scene("lake", tmp_path, {"vehicle.distance_m": 1.0})
    one, other = Renderer(scene, "vehicle"), Renderer(scene, "vehicle")
    frame = one.frame(1.3, MAGENTA, SETTINGS, 5).image_bgr
    other.frame(0.2, (0, 1, 0), SETTINGS, 4)
    np.testing.assert_array_equal(other.frame(1.3, MAGENTA, SETTINGS, 9).image_bgr, frame)
    for changed in (
        other.frame(1.3001, MAGENTA, SETTINGS, 5),
        Renderer(small_scene("lake", tmp_path, {"seed": 77}), "vehicle").frame(
            1.3, MAGENTA, SETTINGS, 5
        ),
    ):
        assert (changed.image_bgr != frame).mean() > 0.3


def test_both_cameras_look_the_same_way_and_only_the_vehicles_sees_lamps(tmp_path: Path) -> None:
    scene = small_scene("pool", tmp_path, {**STILL, "vehicle.heading_deg": 130.0})
    vehicle, dock = (Renderer(scene, which) for which in ("vehicle", "dock"))
    truths = [r.frame(0.0, MAGENTA, SETTINGS, 0).truth for r in (vehicle, dock)]
    assert [truth.heading_deg for truth in truths] == pytest.approx([130.0, 130.0])
    assert truths[0].range_m == pytest.approx(3.0)
    assert truths[1].range_m == 0
    assert truths[1].markers == ()
    np.testing.assert_array_equal(dock.light(0.0, MAGENTA), dock.light(0.0, (0, 0, 0)))
    assert (vehicle.light(0.0, MAGENTA) - vehicle.light(0.0, (0, 0, 0))).max() > 100


def test_the_meter_reads_the_mean_of_the_image(tmp_path: Path) -> None:
    # Without the halo, which at night is a good part of all light.
    for overrides, tolerance in (({}, 0.1), ({"light.surface_illuminance_lux": 0.0}, 0.5)):
        scene = small_scene("pool", tmp_path, {**PLAIN, "vehicle.distance_m": 1.5, **overrides})
        renderer = Renderer(scene, "vehicle")
        mean = renderer.light(0.0, MAGENTA).mean(axis=(0, 1))
        metered = renderer.meter(0.0, MAGENTA)
        np.testing.assert_allclose(metered[[0, 2]], mean[[0, 2]], rtol=tolerance)
    assert not renderer.meter(0.0, (0, 0, 0)).any()


def test_at_night_there_are_lamps_and_nothing_else(tmp_path: Path) -> None:
    night = {"light.surface_illuminance_lux": 0.0, "vehicle.distance_m": 1.5}
    renderer = Renderer(small_scene("pool", tmp_path, {**STILL, **night}), "vehicle")
    assert not renderer.light(0.0, (0, 0, 0)).any()
    image = renderer.light(0.0, MAGENTA)
    assert np.isfinite(image).all()
    for pixel in renderer.frame(0.0, MAGENTA, SETTINGS, 0).truth.pixels():
        assert near(image, pixel)[..., 0].max() > 1000 * np.median(image[..., 0])


def test_orange_is_orange_nearby_and_fades_to_water(tmp_path: Path) -> None:
    def contrast(range_m: float) -> np.ndarray:
        ball = {"shape": "sphere", "rgb": [0.86, 0.19, 0.015], "centre_m": [0, 0, 0],
                "radius_m": 0.1 * range_m}  # fmt: skip
        scenes = [
            small_scene("sea", tmp_path, {**PLAIN, "body": b, "vehicle.distance_m": range_m})
            for b in ([ball], [])
        ]
        seen, water = (Renderer(s, "vehicle").light(0.0, (0, 0, 0))[55, 79] for s in scenes)
        return np.asarray(seen / water - 1)

    close, far = contrast(0.6), contrast(12.0)
    assert close[0] > 0.3
    assert close[0] > close[1] + 0.5 > close[2] + 0.5
    assert np.abs(far).max() < 0.1


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_scenes_have_light_all_around_at_all_times_of_day(name: str, tmp_path) -> None:
    for heading in (0.0, 90.0, 180.0, 270.0):
        for elevation in (-5.0, 5.0, 30.0, 85.0):
            overrides = {"vehicle.heading_deg": heading, "light.sun_elevation_deg": elevation}
            scene = small_scene(name, tmp_path, {**overrides, "vehicle.distance_m": 1.2})
            image = Renderer(scene, "vehicle").light(2.4, MAGENTA)
            assert np.isfinite(image).all()
            assert image.min() >= 0
            assert image.mean() > 1


def test_headings_see_the_sun_or_their_own_shadow(tmp_path: Path) -> None:
    """The pool's sun stands in the south."""
    brightness = {}
    for heading in (0.0, 180.0):
        scene = small_scene("sea", tmp_path, {**PLAIN, "vehicle.heading_deg": heading,
                                              "light.sun_azimuth_deg": 180.0})  # fmt: skip
        image = Renderer(scene, "vehicle").light(0.0, (0, 0, 0))
        assert np.isfinite(image).all()
        brightness[heading] = image.mean()
    assert brightness[180.0] > 1.3 * brightness[0.0]
