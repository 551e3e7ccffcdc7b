"""What the LEDs are told to show."""

from __future__ import annotations

import pytest
from rig import DARK, FULL, Rig

from chromadock import dialect

LED = dialect.MAV_CMD_DOCK_LED
AUTO, HUE, RAW = dialect.DOCK_LED_AUTO, dialect.DOCK_LED_HUE, dialect.DOCK_LED_RAW


def duties(rig: Rig) -> list[int]:
    return list(rig.dock.status().duty)


@pytest.mark.parametrize("channel", [0, 1, 2])
def test_one_channel_alone_in_steps(rig: Rig, channel: int) -> None:
    for level in (0, 1, 64, 128, 255):
        rgb = [0, 0, 0]
        rgb[channel] = level
        rig.dock.led_raw(*rgb)
        expected = list(DARK)
        expected[channel] = round(level / 255 * FULL)
        assert duties(rig) == pytest.approx(expected, abs=1)
    assert rig.dock.status().led_mode == RAW


# Pure colours of the standard wheel.
@pytest.mark.parametrize(
    ("degrees", "expected"),
    [
        (0, [FULL, 0, 0]),
        (60, [FULL, FULL, 0]),
        (120, [0, FULL, 0]),
        (180, [0, FULL, FULL]),
        (240, [0, 0, FULL]),
        (300, [FULL, 0, FULL]),
        (360, [FULL, 0, 0]),
    ],
)
def test_a_fixed_hue_shows_that_colour(rig: Rig, degrees: float, expected: list[int]) -> None:
    rig.dock.led_hue(degrees)
    assert duties(rig) == expected
    assert rig.dock.status().led_mode == HUE


def test_the_manual_mode_of_the_parameters_shows_its_hue(rig: Rig) -> None:
    rig.dock.set_parameter("LED_HUE", 120)
    rig.dock.set_parameter("LED_MODE", 1)
    assert duties(rig) == [0, FULL, 0]
    rig.dock.set_parameter("LED_MODE", 0)
    assert rig.dock.status().led_mode == AUTO


def test_the_limit_dims_and_the_polarity_turns_round(rig: Rig) -> None:
    rig.dock.led_raw(255, 0, 0)
    rig.dock.set_parameter("LED_LIMIT", 51)
    assert duties(rig) == pytest.approx([round(FULL / 5), 0, 0], abs=1)
    rig.dock.set_parameter("LED_ANODE", 1)
    assert duties(rig) == pytest.approx([FULL - round(FULL / 5), FULL, FULL], abs=1)


@pytest.mark.parametrize(
    "values", [(RAW, 256, 0, 0), (RAW, 0, -1, 0), (HUE, 361), (HUE, -1), (3,), (float("nan"),)]
)
def test_a_value_out_of_range_is_denied_and_changes_nothing(
    rig: Rig, values: tuple[float, ...]
) -> None:
    rig.dock.led_raw(10, 20, 30)
    before = duties(rig)
    assert rig.command(LED, *values) == dialect.MAV_RESULT_DENIED
    assert duties(rig) == before


def test_a_restart_ends_a_test_of_the_leds(rig: Rig) -> None:
    rig.dock.led_raw(255, 255, 255)
    rig.reset()
    rig.alive()
    assert rig.dock.status().led_mode == AUTO


def test_what_ends_every_session_leaves_the_leds_dark(rig: Rig) -> None:
    rig.dock.led_raw(255, 255, 255)
    rig.leds_off()
    assert duties(rig) == DARK
    for _ in range(3):  # and frames do not light them again
        assert list(rig.wait("DOCK_STATUS").duty) == DARK
