"""Lamps of a colour of their own: what may be written, and what the detector makes of it."""

from __future__ import annotations

import numpy as np
import pytest
from composites import CAMERA, DOCK, compose

from chromadock import ChromadockError, Detector, DockGeometry
from chromadock.colour.hsv import degrees, nearest_hue
from chromadock.look import Found, Look
from chromadock.marker_colour import MarkerColour

BLUE_WATER = np.full((120, 160, 3), (200, 100, 0), np.uint8)  # BGR
GREY_WATER = np.full((120, 160, 3), 120, np.uint8)


def expecting(frame: np.ndarray = BLUE_WATER, dock: DockGeometry = DOCK, **settings):
    """What a new detector looks for in one frame."""
    return Detector(None, dock, **settings).process(frame, 0.0)


def painted(colour: str | None) -> DockGeometry:
    """The original dock with lamps of a colour."""
    return DockGeometry(DOCK.names, DOCK.points, "painted.toml", colour)


def test_near_the_limit_of_grey_the_detector_expects_one_hue_and_none_between() -> None:
    detector, seen = Detector(None, DOCK), []
    for number in range(60):
        frame = GREY_WATER if number % 3 == 2 or number >= 30 else BLUE_WATER
        seen.append(detector.process(frame, 0.1 * number).marker.hue_deg)
    blue = expecting().marker.hue_deg
    assert seen[:30] == pytest.approx([blue] * 30)
    changed = seen.index(120.0)
    assert changed in (38, 39)  # a second after the last blue frame
    assert seen[:changed] == pytest.approx([blue] * changed)
    assert set(seen[changed:]) == {120.0}


@pytest.mark.parametrize(
    ("text", "kind", "hue_deg", "shown"),
    [
        ("#0000FF", "hue", 240, "#0000FF"),
        ("ff8000", "hue", 30, "#FF8000"),  # Itten's orange, halfway from red to yellow
        (" #00ff00 ", "hue", 120, "#00FF00"),
        ("#000040", "hue", 240, "#000040"),
        ("White", "white", None, "white"),
        ("#FFF4E8", "white", None, "#FFF4E8"),  # warm white LEDs
        ("#808080", "white", None, "#808080"),
        ("ANY", "any", None, "any"),
    ],
)
def test_a_colour_is_a_hue_or_white_or_any(text, kind, hue_deg, shown) -> None:
    colour = MarkerColour.parse(text)
    assert (colour.kind, colour.text) == (kind, shown)
    if hue_deg is None:
        assert colour.hue is None
    else:
        assert colour.hue is not None
        assert degrees(colour.hue) == pytest.approx(hue_deg, abs=0.3)


@pytest.mark.parametrize("text", ["", "blue", "#00F", "#0000FF00", "0x0000FF", "#GG0000", "240"])
def test_what_is_no_colour_is_refused_with_what_may_stand_there(text) -> None:
    with pytest.raises(ChromadockError) as raised:
        MarkerColour.parse(text, "--marker-colour")
    line = str(raised.value)
    assert line.startswith(f"--marker-colour is '{text}'")
    assert '"#RRGGBB" such as "#0000FF", white or any' in line
    assert "\n" not in line


def test_black_is_no_lamps_colour() -> None:
    with pytest.raises(ChromadockError, match="#000000, which no lamp shines in"):
        MarkerColour.parse("#000000")


@pytest.mark.parametrize("independent", [False, True])
def test_a_hue_that_is_given_stands_whatever_the_water_is(independent: bool) -> None:
    detector = Detector(None, DOCK, independent=independent, marker_colour="#0000FF")
    for time, frame in enumerate((BLUE_WATER, GREY_WATER, np.zeros_like(BLUE_WATER))):
        marker = detector.process(frame, float(time)).marker
        assert (marker.rgb, marker.hue_deg, marker.given) == ((0, 0, 255), 240.0, "#0000FF")


def test_without_one_the_water_decides() -> None:
    marker = expecting().marker
    assert marker.given is None
    assert marker.hue_deg == pytest.approx(330, abs=1)


def test_white_has_no_hue_and_is_seen_as_the_paler_water() -> None:
    detection = expecting(marker_colour="white")
    assert detection.marker.rgb == (255, 255, 255)
    assert detection.marker.hue_deg is None
    assert detection.observed == pytest.approx((128, 178, 228), abs=1)


def test_of_any_colour_nothing_is_expected() -> None:
    detection = expecting(marker_colour="any")
    assert detection.marker.rgb is None
    assert detection.marker.hue_deg is None
    assert detection.observed is None
    record = detection.to_dict()
    assert record["marker"] == {"rgb": None, "hue_deg": None, "received_deg": None, "given": "any"}
    assert record["observed"] == {"rgb": None}


def test_the_docks_own_colour_counts_unless_another_is_given() -> None:
    assert expecting(dock=painted("#0000FF")).marker.hue_deg == 240.0
    assert expecting(dock=painted("#0000FF"), marker_colour="#FF0000").marker.hue_deg == 0.0
    assert expecting(dock=painted(None)).marker.given is None


def test_a_dock_of_no_colour_is_refused_with_its_file() -> None:
    with pytest.raises(ChromadockError, match=r"painted\.toml: colour is 'navy': give"):
        painted("navy")


@pytest.mark.parametrize("colour", ["#FF0000", "white"])
def test_the_paper_method_looks_for_it_too(colour: str) -> None:
    detection = expecting(method="paper", marker_colour=colour)
    assert detection.marker.given == colour


def test_the_paper_method_cannot_look_for_any_colour() -> None:
    with pytest.raises(ChromadockError, match=r"method paper cannot.*any colour.*method robust"):
        Detector(None, DOCK, method="paper", marker_colour="any")


def test_a_method_is_told_whether_there_is_a_hue() -> None:
    seen: list[Look] = []

    class Watching:
        mask = np.zeros((120, 160), np.uint8)

        def find(self, look, watch):
            seen.append(look)
            return Found("not_found", 0.0)

    for colour in (None, "#0000FF", "white", "any"):
        detector = Detector(None, DOCK, independent=True, marker_colour=colour)
        detector._method = Watching()
        detector.process(BLUE_WATER, 0.0)
    assert [look.colour for look in seen] == ["hue", "hue", "white", "any"]
    assert [look.marker_rgb for look in seen[1:]] == [(0, 0, 255), (255, 255, 255), None]
    by_the_water = seen[0].hue
    assert [look.hue for look in seen] == [by_the_water, 1024, by_the_water, by_the_water]


def test_a_dock_of_blue_lamps_in_blue_water_is_found_by_its_colour() -> None:
    """Adaptive, such a dock would be red: 120 degrees off."""
    rng = np.random.default_rng(3)
    water = np.clip(np.array((140, 110, 30)) + rng.normal(0, 2, (480, 640, 3)), 0, 255)
    seen = compose(water.astype(np.uint8), 2.0, rng, hue=1024)
    detector = Detector(CAMERA, DOCK, independent=True, marker_colour="#0000FF")
    detection = detector.process(seen.frame_bgr, 0.0)
    assert detection.markers is not None
    for name, pixel in zip(DOCK.names, seen.pixels, strict=True):
        assert np.hypot(*(np.array(detection.markers[name]) - pixel)) < 1.5


# --- the fallback ---


@pytest.mark.parametrize("frame", [GREY_WATER, np.zeros_like(GREY_WATER)], ids=["grey", "night"])
def test_where_the_water_has_no_hue_the_fallback_is_what_was_set(frame: np.ndarray) -> None:
    assert expecting(frame).marker.hue_deg == 120.0
    assert expecting(frame, fallback_hue_deg=300).marker.rgb == (255, 0, 255)
    assert expecting(BLUE_WATER, fallback_hue_deg=300).marker.hue_deg != 300


@pytest.mark.parametrize("hue_deg", [-1, 360, 359.95, float("nan"), float("inf")])
def test_a_fallback_beyond_the_circle_is_refused(hue_deg: float) -> None:
    with pytest.raises(ChromadockError, match=r"fallback hue is .*give degrees, 0 \.\. 359\.77"):
        Detector(None, DOCK, fallback_hue_deg=hue_deg)


def test_degrees_are_rounded_to_steps_as_the_docks_parameters_are() -> None:
    for hue in (0, 1, 511, 512, 1535):
        assert nearest_hue(degrees(hue)) == hue
    assert nearest_hue(0.1171) == 0
    assert nearest_hue(0.1172) == 1
    assert nearest_hue(359.8) == 1535
