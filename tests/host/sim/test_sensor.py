"""Sensor: exposure, noise, mosaic, tone curve and JPEG, each against its own formula."""

from dataclasses import replace

import numpy as np
import pytest

from chromadock.sim.camera_spec import load_camera
from chromadock.sim.control import CameraSettings
from chromadock.sim.sensor import tone_curve
from chromadock.sim.spectrum import gaussian

VEHICLE = load_camera("vehicle").sensor
QUIET = replace(
    VEHICLE, full_well_e=1e12, read_noise_e=0.0, bits=16, jpeg_quality=None, colour_matrix=np.eye(3)
)
"""The vehicle's, without noise, colour correction and JPEG."""
DAYLIGHT = tuple((1 / VEHICLE.response.daylight_raw).tolist())


def settings(exposure_s=0.01, gain=1.0, white_balance=DAYLIGHT):
    return CameraSettings(exposure_s, gain, white_balance)


def small(sensor, width=64, height=48):
    return replace(sensor, width=width, height=height)


def patch(sensor, rgb):
    """(H, W, 3) float32: the same light everywhere."""
    return np.broadcast_to(np.float32(rgb), (sensor.height, sensor.width, 3)).copy()


def rng(seed=0):
    return np.random.default_rng(seed)


def srgb_encoded(linear):
    """IEC 61966-2-1, 0..1."""
    linear = np.asarray(linear, np.float64)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def srgb_linear(level):
    """IEC 61966-2-1 the other way, from 0..255."""
    encoded = np.asarray(level, np.float64) / 255
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def test_exposure_is_iso_12232s():
    # By hand: H = 0.65 * 200 cd/m^2 * 0.01 s / 2^2 = 0.325 lux s; ISO 100 saturates at 0.78.
    sensor = small(replace(QUIET, f_number=2.0, base_iso=100.0))
    assert sensor.level(settings(exposure_s=0.01)) * 200 == pytest.approx(0.325 / 0.78)
    picture = sensor.picture(patch(sensor, 200), settings(exposure_s=0.01), rng())
    assert np.abs(picture - 255 * srgb_encoded(0.325 / 0.78)).max() <= 1


def test_gain_time_and_aperture_are_reciprocal():
    sensor = small(QUIET)
    wanted = sensor.picture(patch(sensor, 150), settings(0.008, 1.0), rng())
    for other, changed in (
        (sensor, settings(0.004, 2.0)),
        (replace(sensor, f_number=VEHICLE.f_number / 2), settings(0.002, 1.0)),
        (replace(sensor, base_iso=VEHICLE.base_iso * 4), settings(0.002, 1.0)),
    ):
        assert np.array_equal(other.picture(patch(sensor, 150), changed, rng()), wanted)


def test_a_grey_patch_is_linear_in_light(record_property):
    sensor = replace(VEHICLE, jpeg_quality=None)
    full = 1 / sensor.level(settings())
    worst = 0.0
    for share in (0.02, 0.05, 0.2, 0.5, 0.8):
        light = patch(sensor, share * full)
        mosaic = sensor.raw(light, settings(), rng(7))
        green = mosaic[0::2, 1::2].mean()
        picture = srgb_linear(sensor.picture(light, settings(), rng(7)))
        worst = max(worst, abs(green / share - 1), *abs(picture.mean((0, 1)) / share - 1))
        assert green == pytest.approx(share, rel=2e-3)
        assert picture.mean((0, 1)) == pytest.approx([share] * 3, rel=0.015)  # 8 bits
    record_property("figure", f"grey from 2 % to 80 % linear within {worst:.1%}")


@pytest.mark.parametrize("gain", [1.0, 8.0])
def test_noise_follows_the_photon_transfer_curve(gain, record_property):
    # Janesick: variance in electrons = electrons + read noise^2, whatever the gain.
    sensor = replace(VEHICLE, bits=16, read_noise_e=20.0)
    electron = gain / sensor.full_well_e
    for electrons in (0, 100, 600, 1000):
        level = electrons * electron / sensor.level(settings(gain=gain))
        mosaic = sensor.raw(patch(sensor, level), settings(gain=gain), rng(electrons))
        # Green is at its full level; each colour has the electrons that its own level says.
        seen = mosaic[0::2, 1::2] / electron
        assert seen.mean() == pytest.approx(electrons, abs=0.5)
        assert seen.var() == pytest.approx(electrons + 20.0**2, rel=0.03)
    record_property("figure", f"gain {gain:g}: variance {seen.var():.0f} e^2 at 1000 e, 20 e read")


def test_the_converter_has_its_number_of_steps():
    sensor = replace(VEHICLE, bits=8)
    mosaic = sensor.raw(patch(sensor, 100), settings(), rng())
    steps = mosaic.astype(np.float64) * 255
    assert np.abs(steps - np.rint(steps)).max() < 1e-3
    assert len(np.unique(mosaic)) > 20


def test_a_full_pixel_holds_no_more():
    light = patch(VEHICLE, 1.2 / VEHICLE.level(settings()))
    mosaic = VEHICLE.raw(light, settings(), rng())
    assert mosaic[0::2, 1::2].min() == mosaic[0::2, 1::2].max() == 1
    assert mosaic[0::2, 0::2].mean() == pytest.approx(
        1.2 * VEHICLE.response.daylight_raw[0], rel=1e-3
    )


def test_darkness_stays_unbiased_before_the_picture_clips_it():
    mosaic = VEHICLE.raw(patch(VEHICLE, 0), settings(gain=16.0), rng())
    electrons = mosaic.mean() * VEHICLE.full_well_e / 16
    assert electrons == pytest.approx(0, abs=0.05)
    assert VEHICLE.picture(patch(VEHICLE, 0), settings(), rng()).max() <= 8


@pytest.mark.parametrize(("rgb", "bgr_index"), [(0, 2), (1, 1), (2, 0)])
def test_light_in_one_channel_makes_a_picture_of_that_colour(rgb, bgr_index):
    sensor = small(QUIET)
    light = patch(sensor, 0)
    light[..., rgb] = 200
    picture = sensor.picture(light, settings(), rng())
    others = np.delete(picture, bgr_index, axis=2)
    assert picture[..., bgr_index].min() > 100
    assert others.max() == 0


@pytest.mark.parametrize(("peak_nm", "bgr_index"), [(622, 2), (523, 1), (467, 0)])
@pytest.mark.parametrize("name", ["vehicle", "ov2640"])
def test_an_led_makes_a_picture_of_its_colour(name, peak_nm, bgr_index):
    sensor = load_camera(name).sensor
    signal = sensor.response.signal(gaussian(peak_nm, 25))
    light = patch(sensor, signal / signal.max() * 0.5 / sensor.level(settings()))
    daylight = tuple((1 / sensor.response.daylight_raw).tolist())
    colour = sensor.picture(light, settings(white_balance=daylight), rng()).mean((0, 1))
    assert colour[bgr_index] > 1.25 * np.delete(colour, bgr_index).max()


def test_the_colour_matrix_works_on_linear_red_green_blue():
    sensor = small(replace(QUIET, colour_matrix=VEHICLE.colour_matrix))
    rgb = np.array([0.30, 0.45, 0.25])
    picture = sensor.picture(patch(sensor, rgb / sensor.level(settings())), settings(), rng())
    shown = srgb_linear(picture[..., ::-1]).mean((0, 1))
    assert shown == pytest.approx(VEHICLE.colour_matrix @ rgb, rel=0.015)


def test_the_mosaic_is_red_green_over_green_blue():
    sensor = small(QUIET, 6, 4)
    light = patch(sensor, 0)
    light[..., 0], light[..., 1], light[..., 2] = 10, 20, 30
    full = sensor.level(settings()) * sensor.response.daylight_raw
    cell = sensor.raw(light, settings(), rng()) / np.float32(
        np.tile([[full[0], full[1]], [full[1], full[2]]], (2, 3))
    )
    assert cell == pytest.approx(np.tile([[10, 20], [20, 30]], (2, 3)), rel=1e-3)


@pytest.mark.parametrize(
    ("sigma_px", "rgb"),
    [
        (0.7, (1, 1, 1)),
        (0.7, (1, 0.2, 0.8)),
        (1.0, (1, 1, 1)),
        (1.0, (1, 0, 0)),
        (1.0, (0, 1, 0)),
        (1.0, (0, 0, 1)),
    ],
)
def test_a_spot_stays_where_it_is(sigma_px, rgb, record_property):
    sensor = small(QUIET, 32, 32)
    rows, columns = np.mgrid[:32, :32]
    worst = 0.0
    for x, y in [(14 + i * 0.37, 15 + i * 0.23) for i in range(10)]:
        spot = np.exp(-((columns - x) ** 2 + (rows - y) ** 2) / (2 * sigma_px**2))
        peak = 0.55 / sensor.level(settings())
        light = (spot[..., None] * np.array(rgb) * peak).astype(np.float32)
        shown = srgb_linear(sensor.picture(light, settings(), rng())).sum(axis=-1)
        found = np.array([(shown * columns).sum(), (shown * rows).sum()]) / shown.sum()
        worst = max(worst, float(np.hypot(*(found - (x, y)))))
    record_property("figure", f"spot of {sigma_px} px, colour {rgb}: within {worst:.3f} px")
    assert worst < 0.1


@pytest.mark.parametrize("peak_nm", [622, 523, 467])
def test_a_core_that_clips_loses_its_hue(peak_nm, record_property):
    sensor = small(VEHICLE)
    signal = sensor.response.signal(gaussian(peak_nm, 25))
    led = signal / signal.max() / sensor.level(settings())
    colours = [
        sensor.picture(patch(sensor, led * factor), settings(), rng()).astype(float).mean((0, 1))
        for factor in (0.5, 5, 50, 500, 5000)
    ]
    saturation = np.array([1 - colour.min() / colour.max() for colour in colours])
    record_property("figure", f"{peak_nm} nm: saturation {saturation.round(2)} up to 5000 x full")
    assert saturation[0] > 0.7
    assert (np.diff(saturation) < 0.01).all()
    assert colours[-1] == pytest.approx([255, 255, 255])


def test_the_same_generator_gives_the_same_picture_and_another_does_not():
    sensor = small(VEHICLE)
    light = patch(sensor, (100, 150, 120))
    untouched = light.copy()
    first = sensor.picture(light, settings(), rng(5))
    assert np.array_equal(sensor.picture(light, settings(), rng(5)), first)
    assert not np.array_equal(sensor.picture(light, settings(), rng(6)), first)
    assert np.array_equal(light, untouched)


def test_the_tone_curve_of_2_4_is_srgbs():
    curve = tone_curve(2.4).astype(float)
    linear = np.arange(65536) / 65535
    assert np.abs(curve - 255 * srgb_encoded(linear)).max() <= 0.51
    assert (curve[0], curve[-1]) == (0, 255)


@pytest.mark.parametrize("gamma", [1.8, 2.2, 2.4])
def test_a_tone_curve_rises_and_can_be_undone(gamma):
    curve = tone_curve(gamma).astype(int)
    assert (np.diff(curve) >= 0).all()
    assert len(np.unique(curve)) == 256
    # A level stands for the linear values between its neighbours' and no others.
    back = np.searchsorted(curve, np.arange(256))
    assert np.array_equal(curve[back], np.arange(256))


def test_jpeg_costs_detail_but_no_colour():
    plain = replace(VEHICLE, jpeg_quality=None)
    rows, columns = np.mgrid[: plain.height, : plain.width]
    light = patch(plain, (60, 120, 150)) * (1 + 0.5 * np.sin(columns / 30) * np.cos(rows / 20))[
        ..., None
    ].astype(np.float32)
    whole = plain.picture(light, settings(), rng()).astype(float)
    errors = []
    for quality in (95, 80, 40):
        packed = replace(VEHICLE, jpeg_quality=quality).picture(light, settings(), rng())
        assert packed.mean((0, 1)) == pytest.approx(whole.mean((0, 1)), abs=1)
        errors.append(np.abs(packed - whole).mean())
    assert 0 < errors[0] < errors[1] < errors[2] < 6


def test_light_of_another_size_is_refused():
    with pytest.raises(ValueError, match=r"\(480, 640\).* not 480x640x3"):
        VEHICLE.picture(np.zeros((480, 640), np.float32), settings(), rng())
