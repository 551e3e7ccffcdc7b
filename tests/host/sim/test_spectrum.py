"""Spectra: brightness and colour by jerlov's own integrals over the CIE observer."""

import jerlov
import numpy as np
import pytest
from jerlov.colour import SRGB_WHITEPOINT_XY, SRGB_WHITEPOINT_XYZ, XYZ_TO_LINEAR_SRGB

from chromadock.sim.spectrum import (
    WAVELENGTHS_NM,
    daylight,
    gaussian,
    led_intensity,
    luminance,
    reflectance,
)

pytestmark = pytest.mark.filterwarnings("ignore::jerlov.CoverageWarning")


def xyz(spectrum):
    """jerlov's integral, in lm/W's own unit."""
    return 683 * jerlov.spectrum_to_xyz(spectrum, WAVELENGTHS_NM)


def linear_srgb(spectrum, white):
    return XYZ_TO_LINEAR_SRGB @ (xyz(spectrum) / xyz(white) * SRGB_WHITEPOINT_XYZ)


def test_the_grid_is_61_wavelengths_from_400_to_700():
    assert len(WAVELENGTHS_NM) == 61
    assert WAVELENGTHS_NM[[0, -1]].tolist() == [400, 700]


def test_daylight_has_the_asked_illuminance_and_the_white_of_d65():
    total = xyz(daylight(10_000))
    assert total[1] == pytest.approx(10_000, rel=1e-3)
    # 400 to 700 nm leave out a half per cent of Z.
    assert total[:2] / total.sum() == pytest.approx(SRGB_WHITEPOINT_XY, abs=2e-3)


def test_night_is_dark():
    assert not daylight(0).any()


def test_green_light_of_a_watt_has_683_lumens():
    peak = gaussian(555, 10)
    watts = np.trapezoid(peak, WAVELENGTHS_NM)
    assert luminance(peak / watts) == pytest.approx(683, rel=0.01)


@pytest.mark.parametrize(
    ("peak", "fwhm", "candela"), [(622, 20, 0.4), (523, 35, 0.7), (468, 25, 0.2)]
)
def test_an_led_has_its_candela_its_peak_and_its_width(peak, fwhm, candela):
    intensity = led_intensity(peak, fwhm, candela)
    assert xyz(intensity)[1] == pytest.approx(candela, rel=1e-3)
    fine = np.arange(400, 700, 0.1)
    curve = np.interp(fine, WAVELENGTHS_NM, intensity)
    mean = (curve * fine).sum() / curve.sum()
    assert mean == pytest.approx(peak, abs=0.2)
    above = fine[curve > curve.max() / 2]
    assert above[-1] - above[0] == pytest.approx(fwhm, abs=2)


def test_a_red_led_is_red():
    x, y, _ = xyz(led_intensity(622, 20, 1)) / xyz(led_intensity(622, 20, 1)).sum()
    # The spectral locus at 622 nm: CIE 15, (0.695, 0.305).
    assert (x, y) == pytest.approx((0.695, 0.305), abs=0.01)


def test_a_green_led_is_green():
    x, y, _ = xyz(led_intensity(523, 35, 1)) / xyz(led_intensity(523, 35, 1)).sum()
    assert y > 0.65
    assert x < 0.25


def test_a_blue_led_is_blue():
    _, y, z = xyz(led_intensity(468, 25, 1)) / xyz(led_intensity(468, 25, 1)).sum()
    assert z > 0.75
    assert y < 0.1


@pytest.mark.parametrize(
    "rgb",
    [
        (0.9, 0.3, 0.02),
        (0.6, 0.05, 0.05),
        (0.05, 0.4, 0.1),
        (0.05, 0.1, 0.5),
        (0.9, 0.8, 0.05),
        (0.02, 0.02, 0.02),
        (1, 0, 0),
        (0, 1, 0),
        (0, 0, 1),
    ],
)
def test_paint_looks_as_asked_in_daylight(rgb, record_property):
    paint = reflectance(rgb)
    assert paint.min() >= 0
    assert paint.max() <= 1
    light = daylight(1000)
    seen = linear_srgb(paint * light, light)
    record_property("figure", f"asked {rgb}, seen {seen.round(3).tolist()}")
    assert seen == pytest.approx(rgb, abs=0.04)


def test_grey_paint_is_flat():
    assert reflectance((0.2, 0.2, 0.2)) == pytest.approx(0.2, abs=0.002)


def test_paint_has_no_steps():
    assert np.abs(np.diff(reflectance((0.9, 0.3, 0.02)))).max() < 0.2
