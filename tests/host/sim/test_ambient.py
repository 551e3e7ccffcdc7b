"""Daylight under water: against jerlov's scene, Snell's law and Darecki's measured flicker."""

import math

import jerlov
import numpy as np
import pytest

from chromadock.errors import ChromadockError
from chromadock.sim.ambient import Ambient, Cloud, clear_beam_share
from chromadock.sim.spectrum import WAVELENGTHS_NM, daylight, luminance
from chromadock.sim.water import Water

LUX = 50_000.0
CLEAR_DIFFUSE = 0.233
"""Of a clear sky, sun 31.5 degrees from the zenith: Gernez & Antoine 2009 print .23 and .25
at 30 and 40 degrees."""


def ambient(water=None, elevation=58.5, azimuth=180.0, diffuse=CLEAR_DIFFUSE, **more):
    more.setdefault("surface_illuminance_lux", LUX)
    return Ambient(
        water=water or Water.jerlov_type("3C"),
        sun_elevation_deg=elevation,
        sun_azimuth_deg=azimuth,
        diffuse_share=diffuse,
        **more,
    )


@pytest.mark.parametrize("elevation", [5.0, 30.0, 58.5, 90.0])
def test_sunlight_obeys_snells_law(elevation):
    travel = ambient(elevation=elevation).sun_direction
    assert np.linalg.norm(travel) == pytest.approx(1)
    in_water = math.acos(travel[2])
    assert 1.34 * math.sin(in_water) == pytest.approx(math.sin(math.radians(90 - elevation)))


@pytest.mark.parametrize(
    ("azimuth", "towards"), [(0, (-1, 0)), (90, (0, -1)), (180, (1, 0)), (270, (0, 1))]
)
def test_light_travels_away_from_the_sun(azimuth, towards):
    travel = ambient(azimuth=float(azimuth), elevation=30.0).sun_direction
    assert travel[:2] / np.hypot(*travel[:2]) == pytest.approx(towards)
    assert travel[2] > 0


def test_the_mean_cosine_of_sunlight_is_the_refracted_suns():
    sun = ambient(diffuse=0.0, elevation=30.0)
    assert sun.mu0 == pytest.approx(math.cos(math.asin(math.cos(math.radians(30)) / 1.34)))


def test_the_mean_cosine_of_skylight_is_that_of_refracted_rays():
    # Rays of an evenly bright sky cross the surface with sin^2 of the zenith angle even.
    sine2 = np.random.default_rng(0).random(200_000)
    cosine = np.cos(np.arcsin(np.sqrt(sine2) / 1.34))
    assert ambient(diffuse=1.0).mu0 == pytest.approx(cosine.mean(), abs=5e-4)


@pytest.mark.parametrize("depth", [0.0, 1.0, 5.0])
def test_light_goes_down_as_in_jerlovs_scene(depth):
    light = ambient()
    scene = jerlov.Scene.at_depth(
        light.water.as_jerlov, depth, daylight(LUX), WAVELENGTHS_NM, kd=light.kd
    )
    assert light.downwelling(depth, 0.0) == pytest.approx(scene.downwelling)


def test_diffuse_attenuation_is_kirks_for_the_suns_height():
    high, low = ambient(elevation=90.0, diffuse=0.0), ambient(elevation=10.0, diffuse=0.0)
    a, b = high.water.a, high.water.b
    # Kirk (1984) for a vertical beam: G(1) = 0.235.
    assert high.kd == pytest.approx(np.sqrt(a * a + 0.235 * a * b))
    assert (low.kd > high.kd).all()


def test_just_beneath_the_surface_is_the_asked_illuminance():
    assert luminance(ambient().downwelling(0.0, 0.0)) == pytest.approx(LUX)


def test_a_moonless_night_is_dark_and_does_not_flicker():
    night = ambient(elevation=-30.0, surface_illuminance_lux=0.0)
    assert not night.downwelling(1.0, 0.0).any()
    assert not night.veiling_radiance(1.0, 0.0).any()
    assert not night.flicker_sigma(1.0, 0.0).any()
    assert np.isfinite(night.kd).all()


@pytest.mark.parametrize(
    "water", [Water.jerlov_type("IB"), Water.pool(), Water.lake(2.0)], ids=lambda w: w.name
)
@pytest.mark.filterwarnings("ignore::jerlov.ProvenanceWarning")
def test_veiling_light_is_jerlovs_estimate(water, record_property):
    light = ambient(water)
    measured = jerlov.petzold_scattering(water.phase.station)
    expected = jerlov.veiling_radiance_estimate(
        jerlov.Water.from_measurements(WAVELENGTHS_NM, a=water.a, b=water.b),
        light.downwelling(1.0, 0.0),
        WAVELENGTHS_NM,
        backscatter_ratio=measured.backscatter_ratio,
    )
    veil = light.veiling_radiance(1.0, 0.0)
    record_property("figure", f"{water.name}, {LUX:g} lux: {luminance(veil):.0f} cd/m2 at 1 m")
    # Petzold prints the ratio to a thousandth.
    assert veil == pytest.approx(expected, rel=0.04)


def flicker_variation(depth, wavelength, seconds=4000.0):
    """Standard deviation over mean of the simulated irradiance at one place."""
    light = ambient(seed=5)
    sigma = np.interp(wavelength, WAVELENGTHS_NM, light.flicker_sigma(depth, 0.0))
    g = light.fluctuation(np.arange(0, seconds, 0.02), 0.0, 0.0)
    irradiance = np.exp(sigma * g - sigma**2 / 2)
    assert irradiance.mean() == pytest.approx(1, abs=0.02)
    return irradiance.std() / irradiance.mean()


MEASURED = jerlov.darecki2011_irradiance_cv()


def compare_flicker(wavelength, record_property):
    column = list(MEASURED.wavelengths_nm).index(wavelength)
    simulated = np.array([flicker_variation(depth, wavelength) for depth in MEASURED.depth_m])
    ratio = simulated / MEASURED.cv[:, column]
    record_property("figure", f"{wavelength:g} nm: simulated / measured {ratio.round(3).tolist()}")
    assert ratio == pytest.approx(1, abs=0.05)


def test_blue_flickers_as_measured_at_every_depth(record_property):
    compare_flicker(443.0, record_property)


def test_green_flickers_as_measured_at_every_depth(record_property):
    compare_flicker(532.0, record_property)


def test_red_flickers_as_measured_at_every_depth(record_property):
    compare_flicker(670.0, record_property)


def test_flicker_is_kept_beyond_the_measured_depths_and_wavelengths():
    light = ambient()
    assert (light.flicker_sigma(0.0, 0.0) == light.flicker_sigma(0.86, 0.0)).all()
    assert (light.flicker_sigma(50.0, 0.0) == light.flicker_sigma(9.58, 0.0)).all()
    sigma = light.flicker_sigma(1.0, 0.0)
    assert sigma[0] == sigma[WAVELENGTHS_NM == 440][0]
    assert sigma[-1] == sigma[WAVELENGTHS_NM == 670][0]


def test_flicker_can_be_off():
    assert not ambient(flicker=False).flicker_sigma(1.0, 0.0).any()


def test_an_overcast_sky_does_not_flicker():
    assert not ambient(diffuse=1.0).flicker_sigma(1.0, 0.0).any()


def test_the_reference_sky_is_gernez_and_antoines():
    assert clear_beam_share() == pytest.approx(1 - CLEAR_DIFFUSE)


def test_a_cloud_dims_within_its_fade_and_goes_again():
    cloud = Cloud(start_s=10.0, fade_s=5.0, transmittance=0.3, end_s=30.0)
    light = ambient(clouds=(cloud,))
    lux = [luminance(light.downwelling(0.0, time)) for time in (0, 10, 12.5, 15, 30, 32.5, 35, 99)]
    share = np.array(lux) / LUX
    assert share == pytest.approx([1, 1, 0.65, 0.3, 0.3, 0.65, 1, 1])


def test_a_cloud_without_an_end_stays():
    light = ambient(clouds=(Cloud(10.0, 5.0, 0.3),))
    assert luminance(light.downwelling(0.0, 1e6)) == pytest.approx(0.3 * LUX)


def test_two_clouds_dim_twice():
    light = ambient(clouds=(Cloud(0.0, 1.0, 0.5), Cloud(5.0, 1.0, 0.4)))
    assert luminance(light.downwelling(0.0, 10.0)) == pytest.approx(0.2 * LUX)


def test_flicker_fades_with_the_cloud():
    light = ambient(clouds=(Cloud(10.0, 5.0, 0.3),))
    sigma = np.array([light.flicker_sigma(1.0, time).max() for time in np.arange(9, 17, 0.25)])
    assert (np.diff(sigma) <= 0).all()
    assert sigma[0] > 0.5
    assert sigma[-1] < 1e-6
    assert light.diffuse_share_at(20.0) == pytest.approx(1)


def test_haze_leaves_some_of_the_beam():
    # Optical depth 2 (1 / 0.9 - 1) / 0.15 = 1.481, transmittance of the beam 0.2273.
    light = ambient(clouds=(Cloud(0.0, 1.0, 0.9),))
    beam = (1 - light.diffuse_share_at(10.0)) * 0.9
    assert beam == pytest.approx((1 - CLEAR_DIFFUSE) * 0.2273, rel=1e-3)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Cloud(0, 1, 0.0), "transmittance is 0: it must be above 0 and at most 1"),
        (lambda: Cloud(0, 1, 1.5), "transmittance is 1.5"),
        (lambda: Cloud(0, 0, 0.5), "fade_s is 0: it must be above 0 s"),
    ],
)
def test_an_impossible_cloud_is_refused(make, says):
    with pytest.raises(ChromadockError, match=says):
        make()
