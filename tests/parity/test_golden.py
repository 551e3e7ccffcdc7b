"""The golden vectors against numpy and against dockcore."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from comparison import assert_same, c_decision, numpy_decision, of_hue

from chromadock import method
from chromadock.choices import MAPPINGS
from chromadock.colour.background import background_colour
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.colour.marker import RollingHue, SteadyHue, marker_hue
from chromadock_firmware import Dock, Settings, ffi, lib


@pytest.mark.parametrize("decision", [numpy_decision, c_decision])
def test_every_intermediate_value_of_the_golden_frames(golden: dict[str, Any], decision) -> None:
    assert len(golden["frames"]) >= 18
    for record in golden["frames"]:
        data = golden["pixels"][record["frame_at"] :][: record["frame_bytes"]]

        def image(key: str, record: dict[str, Any] = record) -> np.ndarray:
            pixels = golden["pixels"][record[key] :][: 60 * 80 * 3]
            return np.frombuffer(pixels, np.uint8).reshape(60, 80, 3)

        background = {k: v for k, v in record["background"].items() if k != "rgb"}
        expected = {
            "working": image("working_at"),
            "smoothed": image("smoothed_at"),
            **background,
            "marker_hue": record["marker_hue"],
        }
        got = decision(data, record["width"], record["height"], record["format"], record["mapping"])
        assert_same({name: got[name] for name in expected}, expected, record["name"])
        assert set(got) == set(expected)
        colour = record["background"]
        rgb = rgb_from_hsv(colour["hue"], colour["saturation"], colour["value"])
        assert list(rgb) == colour["rgb"]


def test_the_vehicle_decides_on_the_golden_frames_by_its_own_darkness(
    golden: dict[str, Any],
) -> None:
    apart = set()
    for record in golden["frames"]:
        pixels = golden["pixels"][record["smoothed_at"] :][: 60 * 80 * 3]
        smoothed = np.frombuffer(pixels, np.uint8).reshape(60, 80, 3)
        seen = background_colour(smoothed, method.MIN_VALUE_VEHICLE)
        assert seen.meaningful is record["vehicle"]["meaningful"], record["name"]
        hue = marker_hue(seen, record["mapping"])
        assert hue == record["vehicle"]["marker_hue"], record["name"]
        assert hue == record["marker_hue"] or seen.value < method.MIN_VALUE_VEHICLE
        if seen.meaningful is not record["background"]["meaningful"]:
            apart.add(record["name"])
    assert apart == {"value_16", "value_47", "lamps_glow"}


def test_rolling_mean_in_numpy_and_c(golden: dict[str, Any]) -> None:
    for vector in golden["rolling"]:
        rolling = RollingHue(vector["window_ms"])
        state = ffi.new("rolling_t *")
        lib.rolling_init(state)
        for (now_ms, hue), mean in zip(vector["decisions"], vector["means"], strict=True):
            where = (vector["name"], now_ms)
            assert rolling.add(hue, now_ms) == mean, where
            assert lib.rolling_add(state, hue, now_ms, vector["window_ms"]) == mean, where


def test_the_hue_shown_for_decisions_of_both_kinds_in_numpy_and_c(golden: dict[str, Any]) -> None:
    assert len(golden["steady"]) >= 9
    for vector in golden["steady"]:
        steady = SteadyHue(vector["window_ms"])
        state = ffi.new("steady_t *")
        lib.steady_init(state)
        for (now_ms, meaningful, hue), shown in zip(
            vector["decisions"], vector["shown"], strict=True
        ):
            where = (vector["name"], now_ms)
            assert steady.add(meaningful, hue, now_ms) == shown, where
            lib.steady_add(state, meaningful, hue, vector["window_ms"], now_ms)
            assert state.shown == shown, where


def test_led_duties_in_c(golden: dict[str, Any]) -> None:
    for vector in golden["led"]:
        led = {f"led_{name}": value for name, value in vector["led"].items()}
        settings = Settings(**led).to_c()
        duty = ffi.new("uint16_t[3]")
        lib.led_duties(duty, vector["hue"], ffi.addressof(settings, "led"))
        assert list(duty) == vector["duties"], vector


def test_every_mapping_for_water_of_every_hue_in_numpy_and_c(golden: dict[str, Any]) -> None:
    assert [vector["mapping"] for vector in golden["mappings"]] == list(MAPPINGS)
    water = ffi.new("background_t *", {"meaningful": True})
    for number, vector in enumerate(golden["mappings"]):
        for hue, expected in enumerate(vector["hues"]):
            water.hue = hue
            where = (vector["mapping"], hue)
            assert lib.marker_hue(water, number, lib.METHOD_FALLBACK_HUE) == expected, where
            assert marker_hue(of_hue(hue), vector["mapping"]) == expected, where
        assert len(vector["hues"]) == lib.METHOD_HUE_RANGE


def test_a_whole_dock_gives_the_golden_duties(golden: dict[str, Any]) -> None:
    for record in golden["frames"]:
        dock = Dock(Settings(mapping=record["mapping"]))
        data = golden["pixels"][record["frame_at"] :][: record["frame_bytes"]]
        dock.frame(data, record["width"], record["height"], record["format"], 0)
        assert dock.marker_hue == record["marker_hue"], record["name"]
        assert list(dock.duties) == record["duties"], record["name"]
