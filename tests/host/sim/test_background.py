"""Rendered water against jerlov, Tyler's measurement, and integrals done the long way."""

import math
import warnings

import jerlov
import numpy as np
import pytest

from chromadock.camera import CameraModel
from chromadock.sim.ambient import Ambient, Cloud
from chromadock.sim.background import Background
from chromadock.sim.basin import Basin, Floor, Wall
from chromadock.sim.camera_spec import load_camera
from chromadock.sim.focusing import Focusing
from chromadock.sim.phase import PhaseFunction
from chromadock.sim.radiance import SunAndSky, path_radiance
from chromadock.sim.rays import RayGrid, solid_angles
from chromadock.sim.spectrum import WAVELENGTHS_NM
from chromadock.sim.water import Water
from chromadock.sim.waves import GaussianField

VEHICLE = load_camera("vehicle")
RESPONSE = VEHICLE.sensor.response
SMALL = CameraModel(160, 120, np.array([[128.0, 0, 79.5], [0, 128.0, 59.5], [0, 0, 1]]))
WAVES = GaussianField(5, wind_m_s=3.0)
CENTRE = (60, 80)
BLACK = (0.0, 0.0, 0.0)


def daylight(water, flicker=False, **changes):
    given = {
        "water": water,
        "surface_illuminance_lux": 50000.0,
        "sun_elevation_deg": 50.0,
        "sun_azimuth_deg": 180.0,
        "diffuse_share": 0.25,
        "flicker": flicker,
        "seed": 3,
    }
    return Ambient(**(given | changes))


def looking(heading_deg, pitch_deg=0.0):
    """R_world_camera of a camera that looks that way, pitched up."""
    h, p = np.radians([heading_deg, pitch_deg])
    ahead = np.array([math.cos(h) * math.cos(p), math.sin(h) * math.cos(p), -math.sin(p)])
    right = np.array([-math.sin(h), math.cos(h), 0.0])
    return np.column_stack([right, np.cross(ahead, right), ahead])


def background(ambient, basin=None, camera=SMALL):
    return Background(camera, RESPONSE, ambient, WAVES, basin or Basin())


def level_pixel(light):
    """The signal in the middle, where SMALL looks level, between the two middle rows."""
    row, column = CENTRE
    return light[row - 1 : row + 1, column - 1 : column + 1].mean(axis=(0, 1)).astype(np.float64)


WATERS = {
    "pool": Water.pool(),
    "IB": Water.jerlov_type("IB"),
    "5C": Water.jerlov_type("5C"),
    "lake": Water.lake(2.0),
}


@pytest.mark.parametrize("name", WATERS)
def test_level_water_is_on_average_the_veiling_radiance(name, record_property):
    ambient = daylight(WATERS[name])
    drawn = background(ambient)
    depth = 8.0
    around = np.mean(
        [level_pixel(drawn.light(0.0, looking(heading), depth)) for heading in range(0, 360, 10)],
        axis=0,
    )
    wanted = RESPONSE.signal(
        jerlov.veiling_radiance_estimate(
            ambient.water.as_jerlov,
            ambient.downwelling(depth, 0.0),
            WAVELENGTHS_NM,
            backscatter_ratio=ambient.water.phase.backscatter_ratio,
        )
    )
    assert wanted == pytest.approx(RESPONSE.signal(ambient.veiling_radiance(depth, 0.0)))
    record_property("figure", f"{name}: off by {np.abs(around / wanted - 1).max():.2%}")
    assert around == pytest.approx(wanted, rel=0.01)


@pytest.mark.parametrize("name", WATERS)
@pytest.mark.parametrize("optical_distance", [0.5, 2.0, 4.8])
def test_a_black_target_stands_out_by_jerlovs_contrast(name, optical_distance, record_property):
    ambient = daylight(WATERS[name])
    depth = 30.0 if name in ("pool", "IB") else 8.0
    at_532 = float(np.interp(532.0, WAVELENGTHS_NM, ambient.water.c))
    distance = optical_distance / at_532
    open_water, target = (
        level_pixel(background(ambient, basin).light(0.0, looking(90), depth))
        for basin in (Basin(), Basin(wall=Wall(distance, BLACK)))
    )
    scene = jerlov.Scene(ambient.water.as_jerlov, ambient.downwelling(depth, 0.0), WAVELENGTHS_NM)
    veil = ambient.veiling_radiance(depth, 0.0)
    seen = scene.observe(np.zeros(61), distance, veiling_radiance=veil, face_irradiance_ratio=0.5)
    contrast = target / open_water - 1
    wanted = RESPONSE.signal(seen.radiance) / RESPONSE.signal(veil) - 1
    figures = "/".join(f"{value:.4f}" for value in contrast)
    record_property("figure", f"{name}, c r = {optical_distance:g}: contrast R/G/B {figures}")
    assert contrast == pytest.approx(wanted, rel=0.02, abs=2e-5)
    # The green channel's light is about 532 nm.
    assert contrast[1] == pytest.approx(-math.exp(-optical_distance), rel=0.5)


def test_a_path_is_the_integral_of_what_it_scatters():
    water, mu0 = WATERS["IB"], 0.9
    kd, level = water.kd(mu0), np.linspace(1, 2, 61)
    directions = np.array([-1.0, -0.3, 0.0, 0.4, 1.0])
    lengths = np.array([2.0, 5.0, 4.0, 30.0, 3.0])
    found = path_radiance(level, water.c, kd, directions, lengths)
    for index, (d_z, length) in enumerate(zip(directions, lengths, strict=True)):
        t = (np.arange(20000) + 0.5) / 20000 * length
        source = level * water.c * np.exp(-kd * d_z * t[:, None])
        brute = (source * np.exp(-water.c * t[:, None])).mean(axis=0) * length
        assert found[index] == pytest.approx(brute, rel=1e-4)


def test_a_path_that_grows_brighter_as_fast_as_it_is_dimmed_has_no_hole():
    level = c = kd = np.ones(61)
    assert path_radiance(level, c, kd, np.array([-1.0]), np.array([3.0])) == pytest.approx(3.0)


def test_the_light_of_the_lake_pend_oreille(record_property):
    """Tyler's (1958) radiance distribution at 4.24 m: one water, no free parameter."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", jerlov.ProvenanceWarning)
        tyler = jerlov.tyler1958_radiance(4.24)
    like = jerlov.petzold_scattering("HAOCE 11")  # c = 0.398, his is 0.396
    water = Water("like it", np.full(61, like.a), np.full(61, like.b), PhaseFunction.of("HAOCE 11"))
    sky = jerlov.gernez2009_diffuse_share()
    zenith = 90 - tyler.sun_altitude_deg
    diffuse = float(np.interp(zenith, sky.sun_zenith_deg, sky.diffuse_fraction))
    ambient = daylight(
        water, sun_elevation_deg=tyler.sun_altitude_deg, sun_azimuth_deg=0.0, diffuse_share=diffuse
    )
    drawn = background(ambient)

    def radiance(tilt, azimuth):
        return level_pixel(drawn.light(0.0, looking(azimuth, 90 - tilt), tyler.depth_m))[1]

    level = tyler.radiance[list(tyler.tilt_deg).index(90)]
    found = np.array([radiance(90.0, azimuth) for azimuth in tyler.azimuth_deg])
    ratio, measured = found[0] / found[-1], level[0] / level[-1]
    record_property("figure", f"sun to antisun: {ratio:.2f}, Tyler {measured:.2f}")
    assert (np.diff(found) < 0).all()
    assert measured / 2 < ratio < measured * 2
    # From near the horizon to where the sun's own image begins, over its mean.
    for tilt in (60.0, 70.0, 80.0, 100.0, 110.0, 120.0):
        row = tyler.radiance[list(tyler.tilt_deg).index(tilt)]
        for azimuth in (0.0, 80.0, 180.0):
            wanted = row[list(tyler.azimuth_deg).index(azimuth)] / level.mean()
            assert 1 / 2.5 < radiance(tilt, azimuth) / found.mean() / wanted < 2.5


def test_the_phase_function_turns_sunlight_to_the_eye():
    phase, travel = WATERS["5C"].phase, np.array([0.6, 0.0, 0.8])
    source = SunAndSky(phase, travel)
    azimuth = np.linspace(0, 2 * np.pi, 361)[:-1]
    level = np.stack([np.cos(azimuth), np.sin(azimuth), 0 * azimuth]).astype(np.float32)
    assert source.sun(level).mean() == pytest.approx(1, rel=0.005)
    # Light that comes at the eye along -d: 53.1 degrees from the sunlight's way, and 126.9.
    towards, away = np.eye(3, dtype=np.float32)[:, :1] * -1, np.eye(3, dtype=np.float32)[:, :1]
    angles = np.arccos([0.6, -0.6])
    wanted = np.divide(*phase.value(angles))
    assert source.sun(towards)[0] / source.sun(away)[0] == pytest.approx(wanted, rel=0.01)
    assert source.sky(np.zeros(1)) == pytest.approx(1)
    assert source.sky(np.array([-0.5])) > 1 > source.sky(np.array([0.5]))


def test_deeper_water_is_darker_by_its_diffuse_attenuation():
    ambient = daylight(WATERS["IB"])
    drawn = background(ambient)
    upper, lower = (level_pixel(drawn.light(0.0, looking(30), depth)) for depth in (20.0, 25.0))
    spectrum = ambient.veiling_radiance(20.0, 0.0)
    wanted = RESPONSE.signal(spectrum * np.exp(-5 * ambient.kd)) / RESPONSE.signal(spectrum)
    assert lower / upper == pytest.approx(wanted, rel=0.01)


def test_up_is_brighter_than_level_and_down_is_darker():
    drawn = background(daylight(WATERS["IB"]), camera=VEHICLE.model)
    light = drawn.light(0.0, looking(90), 10.0).mean(axis=(1, 2))
    assert (np.diff(light[::40]) < 0).all()


def test_a_floor_is_what_reaches_it_and_what_it_reflects():
    ambient = daylight(WATERS["pool"])
    drawn = background(ambient, Basin(Floor(3.0, (0.4, 0.4, 0.4))))
    bare = background(ambient, Basin(Floor(3.0, BLACK)))
    down = looking(0, -90)
    found = level_pixel(drawn.light(0.0, down, 1.0)) - level_pixel(bare.light(0.0, down, 1.0))
    arriving = ambient.downwelling(3.0, 0.0) * 0.4 / math.pi * np.exp(-ambient.water.c * 2.0)
    assert found == pytest.approx(RESPONSE.signal(arriving), rel=0.03)


@pytest.mark.parametrize("camera", [VEHICLE.model, SMALL], ids=["vehicle", "small"])
def test_where_floor_and_wall_meet_the_lens_bends_the_edge(camera):
    ambient = daylight(WATERS["pool"])
    basin = Basin(Floor(4.0, (0.9, 0.9, 0.9)), Wall(8.0, BLACK))
    light = background(ambient, basin, camera).light(0.0, looking(20), 1.5)[..., 1]
    for share in (0.05, 0.5, 0.9):
        column = round(share * (camera.width - 1))
        rows = np.arange(camera.height)
        plane = camera.undistort(np.column_stack([np.full(len(rows), column), rows]))
        # Level distance 8 m, 2.5 m below: tan of the depression is 2.5 / 8.
        tangent = plane[:, 1] / np.hypot(plane[:, 0], 1)
        wanted = np.interp(2.5 / 8.0, tangent, rows)
        steepest = np.abs(np.diff(light[:, column])).argmax() + 0.5
        assert steepest == pytest.approx(wanted, abs=3)


def test_a_wall_faces_the_sun_or_turns_its_back():
    ambient = daylight(WATERS["IB"], diffuse_share=0.3)
    lit, shaded = (
        level_pixel(
            background(ambient, Basin(wall=Wall(2.0, (0.5, 0.5, 0.5)))).light(0, looking(h), 3.0)
        )
        - level_pixel(background(ambient, Basin(wall=Wall(2.0, BLACK))).light(0, looking(h), 3.0))
        for h in (0.0, 180.0)
    )
    # The sun is in the south: it shines on the wall to the north.
    travel = ambient.sun_direction
    wanted = (0.15 + 0.7 * math.hypot(*travel[:2]) / travel[2]) / 0.15
    assert lit / shaded == pytest.approx(wanted, rel=0.02)


def test_shafts_are_the_flickers_path_averages(record_property):
    ambient = daylight(WATERS["IB"], flicker=True)
    focusing = Focusing(ambient, RESPONSE)
    rng = np.random.default_rng(1)
    rays = np.stack([np.ones((1, 60)), *rng.uniform(-0.6, 0.6, (2, 1, 60))])
    rays = (rays / np.linalg.norm(rays, axis=0)).astype(np.float32)
    mean = rng.uniform(0.3, 3, (1, 60)).astype(np.float32)
    sigma = np.array([0.5, 0.4, 0.3], np.float32)
    found = focusing.along(rays, mean, 2.0, sigma)[0]
    travel = ambient.sun_direction
    brute = np.empty((60, 3))
    for index, (ray, m) in enumerate(zip(rays[:, 0].T, mean[0], strict=True)):
        t = -np.log((np.arange(4000) + 0.5) / 4000) * m
        # Along the sunray through each place, up to the camera's depth.
        x, y = (ray[:2, None] - (travel[:2] / travel[2])[:, None] * ray[2]) * t
        g = ambient.fluctuation(2.0, x, y)
        brute[index] = np.exp(sigma * g[:, None] - sigma**2 / 2).mean(axis=0)
    off = np.abs(found - brute)
    record_property("figure", f"shafts off by {off.mean():.3f} of {brute.std():.3f}")
    assert off.mean() < 0.3 * brute.std()
    assert abs((found - brute).mean()) < 0.02


def test_shafts_have_less_contrast_than_the_flicker_and_none_on_average(record_property):
    ambient = daylight(WATERS["pool"], flicker=True)
    drawn, calm = background(ambient), background(daylight(WATERS["pool"]))
    sideways = looking(90)
    at_rest = calm.light(0.0, sideways, 2.0)[80:, ::8]
    factors = np.array([drawn.light(7.0 * k, sideways, 2.0)[80:, ::8] / at_rest for k in range(40)])
    variation = np.sqrt(np.expm1(ambient.flicker_sigma(2.0, 0.0) ** 2)).mean()
    record_property("figure", f"shafts' CV {factors.std():.2f}, the irradiance's {variation:.2f}")
    assert factors.mean() == pytest.approx(1, abs=0.05)
    assert 0.1 * variation < factors.std() < 0.8 * variation


def test_the_net_of_light_on_the_floor_keeps_its_mean():
    basin = Basin(Floor(3.0, (0.4, 0.4, 0.4)))
    drawn = background(daylight(WATERS["pool"], flicker=True), basin)
    calm = background(daylight(WATERS["pool"]), basin)
    down = looking(0, -60)
    at_rest = calm.light(0.0, down, 1.0)
    factors = np.array([drawn.light(3.0 * k, down, 1.0) / at_rest for k in range(40)])
    assert factors.mean() == pytest.approx(1, abs=0.05)
    assert factors[0].std() > 0.05


def test_the_surface_moves_and_nothing_below_it_without_flicker():
    drawn = background(daylight(WATERS["pool"]), camera=VEHICLE.model)
    first, soon, later = (drawn.light(t, looking(0), 1.0) for t in (0.0, 0.01, 1.0))
    above, below = slice(0, 120), slice(260, 480)
    moved = np.abs(later - first)[above].mean()
    assert np.abs(soon - first)[above].mean() < 0.2 * moved
    assert moved > 0.01 * first[above].mean()
    np.testing.assert_array_equal(first[below], later[below])


def test_the_same_moment_gives_the_same_picture():
    def light():
        ambient = daylight(WATERS["pool"], flicker=True)
        basin = Basin(Floor(5.0, (0.1, 0.2, 0.1)), Wall(10.0, (0.1, 0.2, 0.1)))
        return background(ambient, basin).light(3.7, looking(200, 10), 1.2)

    first = light()
    assert (first == light()).all()
    assert first.dtype == np.float32
    assert first.shape == (120, 160, 3)
    assert np.isfinite(first).all()
    assert (first > 0).all()


@pytest.mark.parametrize("size", [(640, 480), (161, 123), (98, 50)])
@pytest.mark.parametrize("pitch", [-90, 0, 35, 90])
def test_any_image_and_attitude_is_rendered_whole(size, pitch):
    width, height = size
    camera = CameraModel.nominal(width, height)
    basin = Basin(Floor(3.0, (0.3, 0.3, 0.3)), Wall(6.0, (0.3, 0.3, 0.3)))
    light = background(daylight(WATERS["pool"], flicker=True), basin, camera).light(
        1.0, looking(10, pitch), 1.0
    )
    assert light.shape == (height, width, 3)
    assert np.isfinite(light).all()
    assert (light > 0).all()


def test_night_is_dark_and_a_cloud_dims():
    night = background(daylight(WATERS["IB"], flicker=True, surface_illuminance_lux=0.0))
    assert not night.light(0.0, looking(0, 30), 2.0).any()
    cloud = Cloud(start_s=10, fade_s=5, transmittance=0.3)
    drawn = background(daylight(WATERS["IB"], clouds=(cloud,)))
    # Around the horizon, for the light under it has no direction any more.
    before, under = (
        np.mean([level_pixel(drawn.light(t, looking(h), 15.0)) for h in range(0, 360, 30)])
        for t in (0.0, 20.0)
    )
    assert under / before == pytest.approx(0.3, rel=0.02)


def test_pixels_solid_angles_are_the_pinholes():
    pixels = np.array([[80.0, 60.0], [0.0, 0.0], [159.0, 30.0]])
    plane = (pixels - [79.5, 59.5]) / 128
    wanted = (1 + (plane**2).sum(axis=1)) ** -1.5 / 128**2
    assert solid_angles(SMALL, pixels) == pytest.approx(wanted, rel=1e-4)


def test_a_coarse_grid_meets_the_image_it_is_enlarged_to():
    grid = RayGrid(SMALL, (4, 2))
    columns = grid.pixels[..., 0].astype(np.float32)
    enlarged = grid.enlarge(columns)
    assert enlarged[60, 10:150] == pytest.approx(np.arange(10, 150), abs=1e-3)


@pytest.mark.parametrize("share", [0.0, 0.25, 1.0])
@pytest.mark.parametrize("name", WATERS)
def test_all_light_is_finite_and_no_formula_overflows(name, share):
    ambient = daylight(WATERS[name], flicker=True, diffuse_share=share)
    drawn = background(ambient, Basin(Floor(2.4, BLACK), Wall(9.0, BLACK)))
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        for heading in range(0, 360, 45):
            for pitch in (-60, -10, 0, 10, 60):
                light = drawn.light(0.5, looking(heading, pitch), 1.0)
                assert np.isfinite(light).all()
                assert (light >= 0).all()
