"""C = numpy on whatever hypothesis comes up with, and what must hold of both."""

from __future__ import annotations

import numpy as np
import reference
from comparison import of_hue
from hypothesis import example, given
from hypothesis import strategies as st

from chromadock.choices import MAPPINGS
from chromadock.colour.hsv import hue_of_vector, rgb_from_hsv
from chromadock.colour.marker import RollingHue, SteadyHue, marker_hue
from chromadock_firmware import ffi, lib

HUE = st.integers(0, lib.METHOD_HUE_RANGE - 1)
INT32 = st.integers(-(2**31), 2**31 - 1)


@given(INT32, INT32)
@example(-(2**31), -(2**31))
@example(-(2**31), 2**31 - 1)
@example(1, -1)
def test_the_hue_of_any_vector(x: int, y: int) -> None:
    hue = ffi.new("uint16_t *", 9999)
    found = lib.hue_of_vector((x, y), hue)
    assert (int(hue[0]) if found else None) == hue_of_vector(x, y)
    if found:
        exact = np.degrees(np.arctan2(y, x)) * lib.METHOD_HUE_RANGE / 360
        apart = (hue[0] - exact + lib.METHOD_HUE_RANGE / 2) % lib.METHOD_HUE_RANGE
        assert abs(apart - lib.METHOD_HUE_RANGE / 2) <= 1


@given(
    start=st.integers(0, 2**32 - 1),
    window_ms=st.integers(lib.METHOD_MIN_WINDOW_MS, lib.METHOD_MAX_WINDOW_MS),
    decisions=st.lists(st.tuples(st.integers(-50, 2500), HUE), min_size=1, max_size=150),
)
def test_rolling_means_with_any_pace_and_any_clock(
    start: int, window_ms: int, decisions: list[tuple[int, int]]
) -> None:
    state = ffi.new("rolling_t *")
    lib.rolling_init(state)
    rolling = RollingHue(window_ms)
    now_ms = start
    for step, hue in decisions:
        now_ms = (now_ms + step) % 2**32
        assert lib.rolling_add(state, hue, now_ms, window_ms) == rolling.add(hue, now_ms)


@given(
    start=st.integers(0, 2**32 - 1),
    decisions=st.lists(
        st.tuples(st.integers(-50, 1500), st.booleans(), HUE), min_size=1, max_size=150
    ),
)
def test_decisions_of_both_kinds_with_any_pace_and_any_clock(
    start: int, decisions: list[tuple[int, bool, int]]
) -> None:
    state = ffi.new("steady_t *")
    lib.steady_init(state)
    steady, now_ms = SteadyHue(), start
    for step, meaningful, hue in decisions:
        now_ms = (now_ms + step) % 2**32
        lib.steady_add(state, meaningful, hue, lib.METHOD_WINDOW_MS, now_ms)
        assert state.shown == steady.add(meaningful, hue, now_ms)


@given(HUE, st.lists(st.integers(0, 2000), max_size=40))
def test_the_mean_of_one_hue_is_that_hue(hue: int, steps: list[int]) -> None:
    rolling, now_ms = RollingHue(), 0
    for step in [0, *steps]:
        now_ms += step
        assert rolling.add(hue, now_ms) == hue


@given(
    hue=HUE,
    offset=st.tuples(*[st.integers(-255, 255)] * 3),
    matrix=st.tuples(*[st.integers(-(2**15), 2**15 - 1)] * 9),
    gamma=st.integers(0, lib.METHOD_GAMMA_COUNT - 1),
    limit=st.integers(0, 255),
)
def test_duties_stay_in_range_and_polarity_mirrors_them(
    hue: int, offset: tuple[int, ...], matrix: tuple[int, ...], gamma: int, limit: int
) -> None:
    duties = []
    for common_anode in (False, True):
        led = ffi.new("led_settings_t *", (offset, matrix, gamma, limit, common_anode))
        settings = ffi.new("dock_settings_t *", lib.dock_default_settings())
        settings.led = led[0]
        assert lib.dock_mend_settings(settings) == 0
        duty = ffi.new("uint16_t[3]")
        lib.led_duties(duty, hue, led)
        duties.append(np.array(list(duty)))
    assert (duties[0] <= lib.LED_FULL).all()
    assert (duties[0] + duties[1] == lib.LED_FULL).all()
    assert (duties[0] <= np.ceil(lib.LED_FULL * limit / 255)).all()


@given(st.integers(0, 255), st.integers(0, 255), st.integers(0, 255))
def test_the_limit_in_water_of_any_value(limit: int, dark: int, value: int) -> None:
    led = ffi.new("led_settings_t *", {"limit": limit, "dark_limit": dark})
    dimmed = lib.led_dimmed(led, value).limit
    assert dimmed == reference.dimmed_limit(limit, dark, value)
    assert min(limit, dark) <= dimmed <= limit


@given(HUE, st.integers(0, 255), st.integers(0, 255))
def test_the_colour_of_any_hue_saturation_and_value(hue: int, saturation: int, value: int) -> None:
    c = lib.rgb_from_hsv(hue, saturation, value)
    rgb = (c.red, c.green, c.blue)
    assert rgb == rgb_from_hsv(hue, saturation, value)
    assert max(rgb) == value
    assert abs(max(rgb) - min(rgb) - value * saturation / 255) <= 0.5


@given(HUE, st.booleans(), st.sampled_from(MAPPINGS), HUE)
def test_the_marker_of_any_water(hue: int, meaningful: bool, mapping: str, fallback: int) -> None:
    water = ffi.new("background_t *", {"hue": hue, "meaningful": meaningful})
    marker = lib.marker_hue(water, MAPPINGS.index(mapping), fallback)
    assert marker == marker_hue(of_hue(hue, meaningful), mapping, fallback)
    assert 0 <= marker < lib.METHOD_HUE_RANGE
    assert meaningful or marker == fallback


@given(HUE, HUE)
def test_contrast_turns_at_most_half_as_far_as_the_water(one: int, other: int) -> None:
    water, marker = (
        min((b - a) % lib.METHOD_HUE_RANGE, (a - b) % lib.METHOD_HUE_RANGE)
        for a, b in ((one, other), [marker_hue(of_hue(h), "contrast") for h in (one, other)])
    )
    assert 2 * marker <= water + 1
