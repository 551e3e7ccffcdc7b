"""AutoControl: what a camera does by itself, seen through the pictures it then takes."""

from dataclasses import replace

import numpy as np
import pytest
from pydantic import ValidationError

from chromadock.sim.camera_spec import load_camera
from chromadock.sim.control import AutoControl, ControlSpec

SENSOR = replace(
    load_camera("vehicle").sensor,
    width=64,
    height=48,
    full_well_e=1e9,
    read_noise_e=0.0,
    jpeg_quality=None,
)
GREY = np.array([200.0, 200.0, 200.0])
BLUE_WATER = np.array([60.0, 130.0, 180.0])
GREEN_WATER = np.array([90.0, 180.0, 110.0])
WIDE = {"exposure_limits_s": (1e-6, 1.0), "gain_limits": (1.0, 1.0)}


def control(**changes):
    return AutoControl(SENSOR, ControlSpec(**changes))


def shown(signal, settings):
    """(3,) mean R, G, B of the picture of a plain scene, linear, 0..1."""
    light = np.broadcast_to(np.float32(signal), (48, 64, 3)).copy()
    bgr = SENSOR.picture(light, settings, np.random.default_rng(0)).mean((0, 1))
    encoded = bgr[::-1] / 255
    return np.where(encoded < 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def spread(colour):
    return colour.max() / colour.min()


def test_automatic_exposure_shows_grey_at_its_target():
    for luminance in (2.0, 50.0, 3000.0):
        settings = control(**WIDE).settle(GREY / 200 * luminance)
        assert shown(GREY / 200 * luminance, settings) == pytest.approx([0.18] * 3, rel=0.02)


def test_a_stop_of_compensation_doubles_the_light():
    plain, more = (control(ev=ev, **WIDE).settle(GREY) for ev in (0.0, 1.0))
    assert more.exposure_s == pytest.approx(2 * plain.exposure_s)


def test_gain_rises_only_when_the_time_is_at_its_longest():
    limits = {"exposure_limits_s": (1e-4, 0.02), "gain_limits": (1.0, 16.0)}
    for luminance in (1e6, 1e3, 100.0, 10.0, 1.0, 1e-3, 0.0):
        settings = control(**limits).settle(GREY / 200 * luminance)
        assert 1e-4 <= settings.exposure_s <= 0.02
        assert 1.0 <= settings.gain * (1 + 1e-9) <= 16.0 * (1 + 1e-8)
        assert settings.gain == pytest.approx(1.0) or settings.exposure_s == 0.02
    assert control(**limits).settle(GREY * 1e6).exposure_s == pytest.approx(1e-4)
    assert control(**limits).settle(GREY * 0).gain == pytest.approx(16.0)


def test_grey_world_drives_the_means_of_blue_water_together(record_property):
    locked = shown(BLUE_WATER, control(**WIDE).settle(BLUE_WATER))
    automatic = shown(BLUE_WATER, control(white_balance="auto", **WIDE).settle(BLUE_WATER))
    record_property(
        "figure", f"blue water: locked {locked.round(2)}, automatic {automatic.round(2)}"
    )
    assert spread(locked) > 3
    assert spread(automatic) < 1.03


def test_grey_world_has_its_limits():
    settings = control(white_balance="auto", white_balance_limit=3.0).settle([1.0, 100.0, 100.0])
    assert settings.white_balance[0] == pytest.approx(3.0)
    assert min(settings.white_balance) == 1


@pytest.mark.parametrize("white_balance", ["daylight", "auto"])
def test_the_smallest_factor_is_one_so_that_clipped_light_is_white(white_balance):
    for scene in (GREY, BLUE_WATER, GREEN_WATER):
        settings = control(white_balance=white_balance, tint=(0.9, 0.8, 1.1)).settle(scene)
        assert min(settings.white_balance) == 1
        assert shown(scene * 1e6, settings) == pytest.approx([1, 1, 1])


def test_automatic_exposure_converges_without_overshoot_and_stays():
    camera = control(time_constant_s=0.4, **WIDE)
    camera.update(GREY, 0.0)
    times = np.arange(1, 41) * 0.1
    exposures = [camera.update(GREY / 10, t).exposure_s for t in times]
    goal = control(**WIDE).settle(GREY / 10).exposure_s
    assert (np.diff(exposures) > 0).all()
    assert max(exposures) <= goal * (1 + 1e-9)
    assert exposures[-1] == pytest.approx(goal, rel=1e-3)
    # After one time constant the way left, in stops, is 1/e of the whole.
    after_one = np.log(goal / exposures[3]) / np.log(10)
    assert after_one == pytest.approx(np.exp(-1), rel=1e-6)


@pytest.mark.parametrize("white_balance", ["auto", "daylight"])
def test_a_steady_scene_keeps_its_settings(white_balance):
    camera = control(white_balance=white_balance)
    first = camera.update(BLUE_WATER, 0.0)
    for t in range(1, 20):
        later = camera.update(BLUE_WATER, t * 0.2)
        assert later.exposure_s == pytest.approx(first.exposure_s)
        assert later.white_balance == pytest.approx(first.white_balance)


def test_the_frame_rate_does_not_change_how_fast_it_settles():
    slow, fast = (control(**WIDE) for _ in range(2))
    for camera in (slow, fast):
        camera.update(GREY, 0.0)
    at_once = slow.update(GREY * 3, 0.5)
    for t in np.arange(1, 11) * 0.05:
        step_by_step = fast.update(GREY * 3, t)
    assert step_by_step.exposure_s == pytest.approx(at_once.exposure_s)


def test_automatic_white_balance_follows_the_water():
    camera = control(white_balance="auto")
    camera.update(BLUE_WATER, 0.0)
    before = shown(GREEN_WATER, camera.update(GREEN_WATER, 0.05))
    after = shown(GREEN_WATER, camera.update(GREEN_WATER, 10.0))
    assert spread(before) > 1.3
    assert spread(after) < 1.03


def test_what_is_locked_stays_whatever_the_light():
    camera = control(exposure=(0.005, 2.0), white_balance="daylight")
    for t, scene in enumerate((GREY, BLUE_WATER * 100, GREEN_WATER / 100)):
        settings = camera.update(scene, t)
        assert (settings.exposure_s, settings.gain) == (0.005, 2.0)
        assert settings.white_balance == pytest.approx(1 / SENSOR.response.daylight_raw)


def test_start_settles_on_the_first_frame_and_then_locks():
    camera = control(exposure="start", white_balance="start")
    first = camera.update(BLUE_WATER, 0.0)
    assert first == control(exposure="auto", white_balance="auto").settle(BLUE_WATER)
    assert camera.update(GREEN_WATER * 10, 5.0) == first
    assert camera.update(GREY / 10, 50.0) == first


def test_exposure_may_follow_while_white_balance_is_locked_at_the_start():
    camera = control(exposure="auto", white_balance="start", **WIDE)
    first = camera.update(BLUE_WATER, 0.0)
    later = camera.update(GREEN_WATER * 10, 20.0)
    assert later.white_balance == first.white_balance
    assert later.exposure_s < 0.2 * first.exposure_s


def test_a_tint_multiplies_the_white_balance():
    plain = np.array(control().settle(GREY).white_balance)
    tinted = np.array(control(tint=(1.2, 1.0, 0.9)).settle(GREY).white_balance)
    ratio = tinted / plain
    assert ratio / ratio[1] == pytest.approx([1.2, 1.0, 0.9])


def test_time_must_not_go_back():
    camera = control()
    camera.update(GREY, 1.0)
    with pytest.raises(ValueError, match=r"went back by 0\.5 s"):
        camera.update(GREY, 0.5)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"exposure": "fast"}, '"auto", "start" or'),
        ({"exposure": (0.0, 1.0)}, '"auto", "start" or'),
        ({"white_balance": "sunny"}, "'auto', 'start' or 'daylight'"),
        ({"tint": (1.0, 9.0, 1.0)}, "0.25 to 4"),
        ({"gain_limits": (4.0, 2.0)}, "the first must be the smaller"),
        ({"exposure": (0.01, 1.0), "ev": 1.0}, "it must be 0 then"),
    ],
)
def test_a_control_that_cannot_be_is_refused_when_made_and_when_changed(changes, says):
    with pytest.raises(ValidationError) as raised:
        ControlSpec(**changes)
    assert says in str(raised.value)
    with pytest.raises(ValidationError):
        replace(ControlSpec(), **changes)
