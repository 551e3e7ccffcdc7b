"""Response: what the channels make of spectra, against figures from elsewhere."""

import jerlov
import numpy as np
import pytest

from chromadock.sim.camera_spec import load_camera
from chromadock.sim.response import PRIMARIES_NM, PRIMARY_FWHM_NM, Response
from chromadock.sim.spectrum import WAVELENGTHS_NM, daylight, gaussian

NIKON_5100 = {468: (0.05, 0.37, 0.99), 523: (0.12, 0.98, 0.20), 622: (0.70, 0.07, 0.00)}
"""Measured response of R, G, B, nm: docs of the data set in colour-science."""


@pytest.fixture(params=["vehicle", "ov2640"])
def response(request):
    return load_camera(request.param).sensor.response


@pytest.mark.parametrize("wavelength", NIKON_5100)
def test_the_vehicle_camera_responds_like_a_measured_one(wavelength, record_property):
    curves = load_camera("vehicle").sensor.response.curves
    ours = np.array([np.interp(wavelength, WAVELENGTHS_NM, curve) for curve in curves])
    record_property("figure", f"{wavelength} nm: R, G, B {ours.round(2)}")
    assert ours == pytest.approx(NIKON_5100[wavelength], abs=0.05)


@pytest.mark.parametrize("luminance", [1.0, 250.0])
def test_daylight_gives_its_luminance_in_every_channel(response, luminance):
    wavelengths, y_bar = jerlov.cie_1931_cmf()[0], jerlov.cie_1931_cmf()[1][:, 1]
    d65 = np.interp(wavelengths, *jerlov.d65(), left=0, right=0)
    radiance = d65 * luminance / (683 * np.trapezoid(y_bar * d65, wavelengths))
    ours = response.signal(np.interp(WAVELENGTHS_NM, wavelengths, radiance))
    assert ours == pytest.approx([luminance] * 3, rel=2e-3)


def test_the_signal_is_the_integral_of_spectrum_times_response():
    bells = [(600.0, 61.0, 1.0), (526.0, 96.0, 0.9), (470.0, 60.0, 0.8)]
    response = Response.of_bands(*([bell] for bell in bells))
    fine = np.arange(397.5, 702.6, 0.1)  # each sample stands for 5 nm
    d65 = np.interp(fine, *jerlov.d65())
    d65 *= daylight(1.0)[20] / np.interp(500, *jerlov.d65())
    led = np.exp(-4 * np.log(2) * ((fine - 523) / 35) ** 2)
    for channel, (peak, fwhm, height) in enumerate(bells):
        curve = height * np.exp(-4 * np.log(2) * ((fine - peak) / fwhm) ** 2)
        expected = np.trapezoid(curve * led, fine) / np.trapezoid(curve * d65, fine)
        assert response.signal(gaussian(523, 35))[channel] == pytest.approx(expected, rel=2e-3)


def test_many_spectra_at_once_give_what_each_gives_alone(response):
    spectra = np.random.default_rng(3).random((2, 4, len(WAVELENGTHS_NM)))
    signals = response.signal(spectra)
    assert signals.shape == (2, 4, 3)
    assert signals[1, 2] == pytest.approx(response.signal(spectra[1, 2]))


@pytest.mark.parametrize(("peak_nm", "strongest"), [(622, 0), (523, 1), (467, 2)])
def test_each_led_is_seen_by_its_own_channel(response, peak_nm, strongest):
    signal = response.signal(gaussian(peak_nm, 25))
    others = np.delete(signal, strongest)
    assert signal[strongest] > 1.5 * others.max()


def test_a_blue_led_shows_in_green_too(record_property):
    response = load_camera("vehicle").sensor.response
    raw = response.signal(gaussian(467, 25)) * response.daylight_raw
    record_property("figure", f"raw R, G, B of a blue LED: {(raw / raw[2]).round(3)}")
    assert raw[1] / raw[2] == pytest.approx(0.37, abs=0.05)


def test_raw_daylight_is_unequal_by_the_areas_under_the_curves(response):
    fine = np.arange(400, 701, 1.0)
    d65 = np.interp(fine, *jerlov.d65())
    areas = [
        np.trapezoid(np.interp(fine, WAVELENGTHS_NM, curve) * d65, fine)
        for curve in response.curves
    ]
    assert response.daylight_raw == pytest.approx(np.array(areas) / max(areas), rel=0.01)
    assert response.daylight_raw.max() == 1


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_colour_correction_undoes_its_share_of_crosstalk_and_keeps_white(response, share):
    bands = np.stack([gaussian(peak, PRIMARY_FWHM_NM) for peak in PRIMARIES_NM])
    seen = response.signal(bands)  # (band, channel)
    heights = np.linalg.solve(seen.T, np.ones(3))
    assert (heights > 0).all()
    white_parts = seen * heights[:, None]
    corrected = white_parts @ response.colour_correction(share).T
    assert corrected.sum(axis=0) == pytest.approx([1, 1, 1])
    apart = ~np.eye(3, dtype=bool)
    assert corrected[apart] == pytest.approx((1 - share) * white_parts[apart], abs=1e-12)
    assert response.colour_correction(share) @ np.ones(3) == pytest.approx([1, 1, 1])


def test_the_dock_camera_has_the_wider_crosstalk(record_property):
    def crosstalk(name):
        full = load_camera(name).sensor.response.colour_correction(1.0)
        return -full[~np.eye(3, dtype=bool)].sum()

    dock, vehicle = crosstalk("ov2640"), crosstalk("vehicle")
    record_property("figure", f"sum of what is undone: dock {dock:.2f}, vehicle {vehicle:.2f}")
    assert dock > 1.2 * vehicle


def test_curves_on_another_grid_are_refused():
    with pytest.raises(ValueError, match=r"\(3, 31\), not \(3, 61\)"):
        Response(np.ones((3, 31)))
