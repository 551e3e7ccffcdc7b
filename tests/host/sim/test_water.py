"""Waters: against jerlov's tables, HydroLight's Kd and the visibility of a black target."""

import math

import jerlov
import numpy as np
import pytest

from chromadock.errors import ChromadockError
from chromadock.sim.spectrum import WAVELENGTHS_NM
from chromadock.sim.water import JERLOV_TYPES, Water

pytestmark = pytest.mark.filterwarnings("ignore::jerlov.ProvenanceWarning")

MEASURED = ("IB", "II", "III", "1C", "3C", "5C")
PURE = {"a": jerlov.pure_water_absorption, "b": jerlov.pure_water_scattering}


def at(wavelength_nm, values):
    return float(np.interp(wavelength_nm, WAVELENGTHS_NM, values))


def published(name):
    source = "williamson2022" if name in MEASURED else "solonenko2015"
    return jerlov.water(name, source=source)


def compare(name, wavelength_nm):
    water, table = Water.jerlov_type(name), published(name)
    assert at(wavelength_nm, water.a) == pytest.approx(table.a(wavelength_nm), rel=0.01)
    assert at(wavelength_nm, water.b) == pytest.approx(table.b(wavelength_nm), rel=0.01)
    assert at(wavelength_nm, water.c) == pytest.approx(table.c(wavelength_nm), rel=0.01)


@pytest.mark.parametrize("name", JERLOV_TYPES)
def test_blue_light_of_an_led_finds_the_published_coefficients(name):
    compare(name, 468.0)


@pytest.mark.parametrize("name", JERLOV_TYPES)
def test_green_light_of_an_led_finds_the_published_coefficients(name):
    compare(name, 523.0)


@pytest.mark.parametrize("name", JERLOV_TYPES)
def test_red_light_of_an_led_finds_the_published_coefficients(name):
    compare(name, 622.0)


# c at 468, 523 and 622 nm as ../shared/docs/underwater-light.md lists it.
@pytest.mark.parametrize(
    ("name", "blue", "green", "red"),
    [("I", 0.022, 0.046, 0.288), ("III", 0.403, 0.375, 0.578), ("9C", 4.89, 3.84, 2.96)],
)
def test_the_documented_attenuation_is_met(name, blue, green, red):
    water = Water.jerlov_type(name)
    seen = [at(wavelength, water.c) for wavelength in (468, 523, 622)]
    assert seen == pytest.approx([blue, green, red], rel=0.03)


def test_blue_fares_worst_in_the_most_turbid_water_and_red_in_the_clearest():
    clear, turbid = Water.jerlov_type("I"), Water.jerlov_type("9C")
    assert at(622, clear.c) > 5 * at(468, clear.c)
    assert at(468, turbid.c) > 1.5 * at(622, turbid.c)


def black_target_contrast(water, distance_m):
    """jerlov's apparent contrast at 532 nm of a black target against the open water."""
    wavelengths = np.array([532.0])
    scene = jerlov.Scene(water.as_jerlov, [1.0], wavelengths)
    veil = jerlov.veiling_radiance_estimate(
        water.as_jerlov, [1.0], wavelengths, backscatter_ratio=water.phase.backscatter_ratio
    )
    seen = scene.observe([0.0], distance_m, veiling_radiance=veil, face_irradiance_ratio=1.0)
    return float(seen.contrast(veil)[0])


@pytest.mark.parametrize("visibility", [0.5, 2.0, 6.0, 20.0])
def test_a_black_target_vanishes_at_a_lakes_visibility(visibility, record_property):
    water = Water.lake(visibility)
    contrast = black_target_contrast(water, visibility)
    record_property("figure", f"visibility {visibility:g} m: contrast {contrast:.5f}")
    assert at(532, water.c) * visibility == pytest.approx(4.8)
    assert contrast == pytest.approx(-math.exp(-4.8), rel=1e-6)


def test_dissolved_matter_leaves_the_visibility_and_takes_the_blue():
    plain, brown = Water.lake(2.0), Water.lake(2.0, cdom_per_m=1.5)
    assert black_target_contrast(brown, 2.0) == pytest.approx(-math.exp(-4.8), rel=1e-6)
    assert at(468, brown.a) > 1.8 * at(468, plain.a)
    assert at(622, brown.a) < 1.2 * at(622, plain.a)


def test_a_lake_as_clear_as_type_5c_is_type_5c():
    type_5c = Water.jerlov_type("5C")
    lake = Water.lake(4.8 / at(532, type_5c.c))
    assert lake.a == pytest.approx(type_5c.a)
    assert lake.b == pytest.approx(type_5c.b)


@pytest.mark.parametrize("scattering", [0.1, 0.2, 0.3])
def test_a_pool_is_pure_water_with_particles(scattering, record_property):
    pool = Water.pool(scattering)
    for wavelength in (470.0, 525.0, 620.0):
        assert at(wavelength, pool.a) == pytest.approx(PURE["a"](wavelength))
        scattered = PURE["b"](wavelength, salinity_psu=0) + scattering
        assert at(wavelength, pool.b) == pytest.approx(scattered)
    visibility = 4.8 / at(532, pool.c)
    record_property("figure", f"pool, b = {scattering:g} /m: visibility {visibility:.1f} m")
    assert black_target_contrast(pool, visibility) == pytest.approx(-math.exp(-4.8), rel=1e-4)
    # Tap water and tap water with sand (FOE 24988) have 0.130 and 0.580.
    assert 0.13 < at(532, pool.c) < 0.58


@pytest.mark.parametrize("name", ["I", "IA", "7C", "9C"])
def test_diffuse_attenuation_is_hydrolights_from_the_same_coefficients(name, record_property):
    # HydroLight with the sun at the zenith of a clear sky, as Solonenko & Mobley ran it.
    wavelengths = np.array([450, 475, 500, 525, 550, 600, 625])
    kd = np.interp(wavelengths, WAVELENGTHS_NM, Water.jerlov_type(name).kd(mu0=0.9))
    ratio = kd / published(name).kd_hydrolight(wavelengths)
    record_property("figure", f"{name}: Kirk / HydroLight {ratio.min():.2f} to {ratio.max():.2f}")
    assert ratio == pytest.approx(1, abs=0.25)


@pytest.mark.parametrize("name", JERLOV_TYPES)
def test_diffuse_attenuation_is_jerlovs_of_1976(name, record_property):
    wavelengths = np.array([470.0, 525.0, 620.0])
    kd = np.interp(wavelengths, WAVELENGTHS_NM, Water.jerlov_type(name).kd(mu0=0.86))
    ratio = kd / jerlov.water(name, source="jerlov1976").kd(wavelengths)
    record_property("figure", f"{name}: Kirk / Jerlov 1976 B G R {ratio.round(2).tolist()}")
    # In IB alone the measured absorption of blue exceeds Jerlov's whole Kd.
    assert ratio == pytest.approx(1, abs=0.35 if name != "IB" else 0.7)


def test_turbid_water_backscatters_the_share_that_petzold_measured():
    lake = Water.lake(2.0)
    assert lake.phase.station.startswith("NUC")
    assert lake.bb / lake.b == pytest.approx(0.020, abs=0.0015)


def test_mixed_water_lies_between_its_parts():
    first, second = Water.jerlov_type("IB"), Water.jerlov_type("5C")
    mixed = Water.mixed([(first, 0.25), (second, 0.75)])
    for wavelength in (468, 523, 622):
        expected = 0.25 * published("IB").c(wavelength) + 0.75 * published("5C").c(wavelength)
        assert at(wavelength, mixed.c) == pytest.approx(expected, rel=0.01)


def test_measured_water_is_what_was_measured():
    water = Water.measured([390, 500, 710], [0.5, 0.1, 0.7], [1.0, 0.9, 0.6])
    assert at(500, water.a) == pytest.approx(0.1)
    assert at(605, water.a) == pytest.approx(0.4)
    assert at(605, water.b) == pytest.approx(0.75)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Water.jerlov_type("4C"), "'4C': give one of I, IA, IB"),
        (lambda: Water.pool(-0.1), "scattering_per_m is -0.1: it must be a positive"),
        (lambda: Water.pool(math.nan), "scattering_per_m is nan"),
        (lambda: Water.lake(200.0), "visibility_m is 200: with cdom_per_m = 0 it must lie between"),
        (lambda: Water.lake(-2.0), "visibility_m is -2"),
        (lambda: Water.lake(2.0, cdom_per_m=-1), "cdom_per_m is -1"),
        (lambda: Water.lake(5.0, cdom_per_m=10), "it must lie between 0 and 1.96 m"),
        (lambda: Water.mixed([]), "shares of the mixed waters are none"),
        (lambda: Water.mixed([(Water.pool(), 0.5)]), "mixed waters are 0.5: each"),
        (
            lambda: Water.mixed([(Water.pool(), 1.5), (Water.pool(), -0.5)]),
            "are 1.5, -0.5: each must be 0 or more",
        ),
        (
            lambda: Water.measured([450, 700], [1, 1], [1, 1]),
            "wavelengths_nm is 450 to 700: it must reach from 400 or less to 700 nm or more",
        ),
        (lambda: Water.measured([700, 400], [1, 1], [1, 1]), "two or more ascending"),
        (lambda: Water.measured([400, 700], [1], [1, 1]), "a has 1 numbers for 2 wavelengths"),
        (
            lambda: Water.measured([400, 700], [1, 1], [1, -2]),
            "b at 700 nm is -2: it must be a positive number of 1/m",
        ),
    ],
)
def test_an_impossible_water_is_refused_in_one_line(make, says):
    with pytest.raises(ChromadockError, match=r"\A[^\n]*\Z") as fault:
        make()
    assert says in str(fault.value)
