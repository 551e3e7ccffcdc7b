"""Golden vectors: frames, sequences and settings in, every intermediate value out.

``frames.bin`` holds the pixels, ``golden.json`` everything else; the C copy of the
latter (``tests/firmware/golden.c``) serves the tests on the PC, on an emulated
Xtensa core and on a board.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import reference
from reference import RGB565, RGB888, Method, Tables

Paint = Callable[[float, float], tuple[float, float, float]]

NEUTRAL_LED = {
    "offset": [0, 0, 0],
    "matrix": [4096, 0, 0, 0, 4096, 0, 0, 0, 4096],
    "gamma": 2,
    "limit": 255,
    "common_anode": False,
}


def encode(fmt: str, rgb: tuple[float, float, float]) -> bytes:
    """One pixel, 0..255 a channel, clipped, as the camera delivers it."""
    r, g, b = (min(255, max(0, int(c + 0.5))) for c in rgb)
    if fmt == RGB888:
        return bytes((r, g, b))
    word = (r >> 3) << 11 | (g >> 2) << 5 | b >> 3
    return bytes((word >> 8, word & 255))


def paint(fmt: str, width: int, height: int, colour: Paint, noise: float, seed: int) -> bytes:
    """A frame whose pixel at relative place (u, v) is ``colour(u, v)`` plus noise."""
    rng = random.Random(seed)  # its random() is the same in every Python version
    frame = bytearray()
    for y in range(height):
        for x in range(width):
            rgb = colour((x + 0.5) / width, (y + 0.5) / height)
            frame += encode(fmt, tuple(c + noise * (rng.random() - 0.5) for c in rgb))  # type: ignore[arg-type]
    return bytes(frame)


def water(r: float, g: float, b: float, lamp: tuple[float, float, float]) -> Paint:
    """Water that brightens upwards, with a dark strut and four lamps in it."""

    def colour(u: float, v: float) -> tuple[float, float, float]:
        for lamp_u, lamp_v in ((0.3, 0.45), (0.7, 0.45), (0.3, 0.52), (0.7, 0.52)):
            if (u - lamp_u) ** 2 + 0.5 * (v - lamp_v) ** 2 < 0.0004:
                return lamp
        if abs(u - 0.5) < 0.02 and v < 0.4:
            return 20, 25, 30
        light = 1.15 - 0.3 * v
        return r * light, g * light, b * light

    return colour


def flat(r: float, g: float, b: float) -> Paint:
    """One colour everywhere."""
    return lambda u, v: (r, g, b)


def red_wrap(u: float, v: float) -> tuple[float, float, float]:
    """Hues a little above and a little below red: a linear mean would say cyan."""
    return (150, 40, 60) if u < 0.5 else (150, 60, 40)


def equal_bins(u: float, v: float) -> tuple[float, float, float]:
    """Two bins of the same size: the darker must win."""
    return (10, 60, 150) if u < 0.5 else (150, 215, 230)


def two_waters(u: float, v: float) -> tuple[float, float, float]:
    """Two bins of nearly the same size, and hues that take the core the longest."""
    return (60, 80, 40) if u < 0.49 else (120, 160, 80)


def every_hue(u: float, v: float) -> tuple[float, float, float]:
    """All hues across, all saturations down."""
    return reference.rgb_from_hsv(int(u * 1536), int(v * 255), 180)


def opposite(u: float, v: float) -> tuple[float, float, float]:
    """Hues that nearly cancel: a short mean vector, little confidence."""
    return (130, 80, 80) if u < 0.5 else (66, 116, 116)


def lamps_glow(u: float, v: float) -> tuple[float, float, float]:
    """Night: green lamps and their light in the water, less the farther from them."""
    off = min((u - lamp) ** 2 for lamp in (0.3, 0.7)) + 0.5 * (v - 0.48) ** 2
    glow = 12 / (0.08 + off**0.5)
    return (255, 255, 255) if off < 0.0004 else (0.3 * glow, glow, 0.4 * glow)


def frames() -> list[tuple[str, str, int, int, str, bytes]]:
    """Name, format, width, height, mapping, pixels of every golden frame."""
    pool = water(40, 140, 190, (250, 120, 240))
    lake = water(60, 110, 50, (90, 130, 250))
    brown = water(113, 86, 33, (250, 60, 60))
    plans: list[tuple[str, str, int, int, str, Paint, float]] = [
        ("pool_qqvga", RGB565, 160, 120, "ternary", pool, 12),
        ("lake_qqvga", RGB565, 160, 120, "complement", lake, 12),
        ("noise_qqvga", RGB565, 160, 120, "ternary", flat(128, 128, 128), 256),
        ("saturated_qqvga", RGB565, 160, 120, "ternary", flat(0, 90, 255), 30),
        ("pool_rgb888", RGB888, 160, 120, "complement", pool, 12),
        ("odd_size_rgb565", RGB565, 163, 127, "ternary", lake, 12),
        ("odd_size_rgb888", RGB888, 121, 61, "ternary", pool, 12),
        ("smaller_than_working", RGB888, 7, 5, "ternary", pool, 60),
        ("one_pixel_rgb888", RGB888, 1, 1, "complement", flat(12, 200, 99), 0),
        ("one_pixel_rgb565", RGB565, 1, 1, "ternary", flat(12, 200, 99), 0),
        ("black", RGB888, 80, 60, "ternary", flat(0, 0, 0), 0),
        ("white", RGB888, 80, 60, "ternary", flat(255, 255, 255), 0),
        ("grey_water", RGB888, 80, 60, "complement", flat(120, 126, 124), 4),
        ("night", RGB888, 80, 60, "ternary", flat(2, 4, 9), 6),
        ("red_wrap", RGB888, 80, 60, "ternary", red_wrap, 0),
        ("equal_bins", RGB888, 80, 60, "ternary", equal_bins, 0),
        ("opposite_hues", RGB888, 80, 60, "ternary", opposite, 0),
        ("every_hue", RGB888, 80, 60, "ternary", every_hue, 0),
        ("ties_of_six", RGB888, 160, 180, "ternary", pool, 40),
        ("saturation_26", RGB888, 1, 1, "ternary", flat(229, 255, 255), 0),
        ("saturation_25", RGB888, 1, 1, "ternary", flat(230, 255, 255), 0),
        ("value_16", RGB888, 1, 1, "complement", flat(4, 10, 16), 0),
        ("value_15", RGB888, 1, 1, "complement", flat(4, 10, 15), 0),
        ("value_48", RGB888, 1, 1, "complement", flat(12, 30, 48), 0),
        ("value_47", RGB888, 1, 1, "complement", flat(12, 30, 47), 0),
        ("pool_contrast", RGB565, 160, 120, "contrast", pool, 12),
        ("brown_contrast", RGB888, 80, 60, "contrast", brown, 12),
        ("lamps_glow", RGB888, 80, 60, "ternary", lamps_glow, 12),
        ("two_waters_qqvga", RGB565, 160, 120, "ternary", two_waters, 0),
        ("night_contrast", RGB888, 1, 1, "contrast", flat(2, 4, 9), 0),
    ]
    return [
        (name, fmt, w, h, mapping, paint(fmt, w, h, colour, noise, seed))
        for seed, (name, fmt, w, h, mapping, colour, noise) in enumerate(plans)
    ]


def frame_vectors(m: Method, t: Tables) -> tuple[list[dict[str, Any]], bytes]:
    """The frames' records and the bytes that they point into."""
    records, blob = [], bytearray()

    def store(pixels: bytes) -> int:
        blob.extend(bytes(-len(blob) % 4))  # the frame buffers of a board are aligned too
        offset = len(blob)
        blob.extend(pixels)
        return offset

    for name, fmt, width, height, mapping, frame in frames():
        working = reference.working_image(m, frame, fmt, width, height)
        smoothed = reference.smooth(m, working)
        background = reference.background(m, t, smoothed)
        seen = reference.background(m, t, smoothed, "vehicle")
        fallback = m["marker"]["fallback_hue"]
        hue = reference.marker_hue(m, t, background, mapping, fallback)
        records.append(
            {
                "name": name,
                "format": fmt,
                "width": width,
                "height": height,
                "mapping": mapping,
                "frame_at": store(frame),
                "frame_bytes": len(frame),
                "working_at": store(bytes(c for p in working for c in p)),
                "smoothed_at": store(bytes(c for p in smoothed for c in p)),
                "background": background,
                "marker_hue": hue,
                "vehicle": {
                    "meaningful": seen["meaningful"],
                    "marker_hue": reference.marker_hue(m, t, seen, mapping, fallback),
                },
                "duties": reference.led_duties(m, t, hue, NEUTRAL_LED),
            }
        )
    return records, bytes(blob)


def rolling_vectors(m: Method, t: Tables) -> list[dict[str, Any]]:
    """Sequences of decisions with the mean after each."""
    rng = random.Random(7)
    turn, wrap = m["hue"]["range"], 1 << 32

    def noisy(start: int, step: float, rate: int, count: int) -> list[tuple[int, int]]:
        return [
            ((start + i * 1000 // rate) % wrap, int(i * step + 80 * rng.random() - 40) % turn)
            for i in range(count)
        ]

    sequences = {
        "about_red": noisy(0, 0, 30, 90),
        "turning": noisy(1000, 9.7, 30, 200),
        "clock_wrap": noisy(wrap - 1500, 3.1, 30, 120),
        "slow_camera": noisy(0, 150, 2, 20),
        "faster_than_the_window_holds": noisy(0, 5, 90, 250),
        "opposite_pair": [(0, 100), (10, 868), (20, 868)],
        "pause": [(0, 10), (100, 20), (1999, 400), (2100, 410), (9000, 900)],
        "clock_set_back": [(5000, 10), (5033, 20), (40, 600), (73, 610)],
    }
    window = m["rolling"]["window_ms"]
    vectors = []
    for name, decisions in sequences.items():
        rolling = reference.RollingHue(m, t, window)
        means = [rolling.add(hue, now) for now, hue in decisions]
        vectors.append({"name": name, "window_ms": window, "decisions": decisions, "means": means})
    return vectors


def steady_vectors(m: Method, t: Tables) -> list[dict[str, Any]]:
    """Sequences of decisions, with their kind, and the hue shown after each."""
    rng = random.Random(11)
    wrap, fallback = 1 << 32, m["marker"]["fallback_hue"]
    window, hold = m["rolling"]["window_ms"], m["rolling"]["hold_ms"]

    def kinds(start: int, step: int, *runs: tuple[bool, int]) -> list[tuple[int, bool, int]]:
        decisions, now = [], start
        for meaningful, count in runs:
            for _ in range(count):
                hue = 900 + int(40 * rng.random()) if meaningful else fallback
                decisions.append((now % wrap, meaningful, hue))
                now += step
        return decisions

    sequences = {
        "one_kind": kinds(0, 100, (True, 40)),
        "grey_for_less_than_the_hold": kinds(0, 100, (True, 20), (False, 9), (True, 20)),
        "grey_for_as_long_as_the_hold": kinds(0, 100, (True, 20), (False, 30), (True, 30)),
        "turns": kinds(0, 100, *[(True, 2), (False, 1)] * 20),
        "night_first": kinds(0, 33, (False, 40), (True, 60)),
        "one_ms_short": [(0, True, 900), (hold - 1, False, 512), (hold, False, 512)],
        "slow_camera": kinds(0, 2500, (True, 3), (False, 3), (True, 2)),
        "clock_wrap": kinds(wrap - 900, 100, (True, 5), (False, 25)),
        "clock_set_back": [(5000, True, 10), (5033, False, 512), (40, False, 512), (73, True, 20)],
    }
    vectors = []
    for name, decisions in sequences.items():
        steady = reference.SteadyHue(m, t, window)
        shown = [steady.add(meaningful, hue, now) for now, meaningful, hue in decisions]
        vectors.append({"name": name, "window_ms": window, "decisions": decisions, "shown": shown})
    return vectors


def mapping_vectors(m: Method, t: Tables) -> list[dict[str, Any]]:
    """Every mapping's marker for water of every hue."""
    fallback = m["marker"]["fallback_hue"]
    return [
        {
            "mapping": mapping,
            "hues": [
                reference.marker_hue(m, t, {"hue": hue, "meaningful": True}, mapping, fallback)
                for hue in range(m["hue"]["range"])
            ],
        }
        for mapping in m["marker"]["mappings"]
    ]


def led_vectors(m: Method, t: Tables) -> list[dict[str, Any]]:
    """Hue and LED settings in, duties out."""
    crosstalk = [4300, -200, -60, -350, 4500, -500, 0, -900, 5000]
    settings = [
        NEUTRAL_LED,
        {**NEUTRAL_LED, "common_anode": True},
        {**NEUTRAL_LED, "gamma": 0, "limit": 128},
        {**NEUTRAL_LED, "gamma": 3, "offset": [-40, 25, 60]},
        {**NEUTRAL_LED, "gamma": 1, "matrix": crosstalk, "common_anode": True},
        {**NEUTRAL_LED, "offset": [255, -255, 0], "limit": 0},
        {**NEUTRAL_LED, "matrix": [120, 0, 7, 0, 90, 1, 0, 0, 33], "limit": 200},
        {**NEUTRAL_LED, "matrix": [32767] * 9, "common_anode": True},
        {**NEUTRAL_LED, "matrix": [-32768] * 9},
    ]
    return [
        {"hue": hue, "led": led, "duties": reference.led_duties(m, t, hue, led)}
        for led in settings
        for hue in (0, 1, 128, 255, 256, 300, 512, 640, 768, 1024, 1300, 1535)
    ]
