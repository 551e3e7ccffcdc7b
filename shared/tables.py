"""The lookup tables of the method, from the numbers in ``method.toml``."""

from __future__ import annotations

import math
from typing import Any

Method = dict[str, Any]


def hue_division(turn: int, shift: int) -> list[int]:
    """``turn * 2^shift / (6 * chroma)``, rounded; 0 for chroma 0 (no hue)."""
    unit = turn << shift
    return [0] + [(unit + 3 * d) // (6 * d) for d in range(1, 256)]


def saturation_division(m: Method) -> list[int]:
    """``255 * 2^shift / value``, rounded; 0 for value 0 (black)."""
    unit = 255 << m["hue"]["opencv_shift"]
    return [0] + [(2 * unit + v) // (2 * v) for v in range(1, 256)]


def sine(m: Method) -> list[int]:
    """One turn and a quarter, so that the cosine is the same table further on."""
    turn, unit = m["hue"]["range"], m["hue"]["trig_unit"]
    return [round(unit * math.sin(2 * math.pi * i / turn)) for i in range(turn + turn // 4)]


def arctangent(m: Method) -> list[int]:
    """Hue steps of the angle whose tangent is ``i / atan_steps``, over one octant."""
    turn, steps = m["hue"]["range"], m["hue"]["atan_steps"]
    return [round(math.atan(i / steps) * turn / (2 * math.pi)) for i in range(steps + 1)]


def gamma(m: Method) -> list[int]:
    """Code value 0..255 to linear light 0..65535, one run of 256 for each exponent."""
    return [round(65535 * (i / 255) ** g) for g in m["led"]["gammas"] for i in range(256)]


def marker_hue(m: Method) -> list[int]:
    """For each mapping the marker's hue at every node of the water's, and at the first again.

    Not taken modulo the turn, and so free of jumps: 0 or more, below two turns.
    """
    turn, nodes = m["hue"]["range"], m["marker"]["nodes"]
    ways = []
    for mapping in m["marker"]["mappings"]:
        if mapping in m["marker"]["turns"]:
            first = m["marker"]["turns"][mapping]
            ways += [first + i * turn // nodes for i in range(nodes + 1)]
        else:
            ways += unwrapped(m["marker"][mapping], turn)
    return ways


def mean_of_four(full: int, shift: int) -> list[int]:
    """For each sum of four values 0..``full`` their mean on 0..255, halves up, shifted left."""
    return [(510 * i + 4 * full) // (8 * full) << shift for i in range(4 * full + 1)]


def unwrapped(hues: list[int], turn: int) -> list[int]:
    """A closed way round some hues, from each to the next on the shorter side."""
    way = [hues[0]]
    for hue in [*hues[1:], hues[0]]:
        way.append(way[-1] + (hue - way[-1] + turn // 2) % turn - turn // 2)
    return [hue - min(way) // turn * turn for hue in way]


def all_tables(m: Method) -> dict[str, list[int]]:
    """Every table under its name in C and Python."""
    hue = m["hue"]
    return {
        "HUE_DIVISION": hue_division(hue["range"], hue["shift"]),
        "SATURATION_DIVISION": saturation_division(m),
        "SINE": sine(m),
        "ARCTANGENT": arctangent(m),
        "GAMMA": gamma(m),
        "MARKER_HUE": marker_hue(m),
        **{
            f"HUE_DIVISION_{turn}": hue_division(turn, hue["opencv_shift"])
            for turn in hue["opencv_ranges"]
        },
    }


def core_tables(m: Method) -> dict[str, list[int]]:
    """Every table of the C code.

    It has no gamma table for the first exponent, 1: that light is 257 times the code value.  And
    it has the means of 2 x 2 RGB565 pixels, green where ``pixel.h`` has it.
    """
    shared = all_tables(m)
    if shared["GAMMA"][:256] != [257 * code for code in range(256)]:
        raise ValueError("method.toml: the first of led.gammas has to be 1.0")
    return shared | {
        "GAMMA": shared["GAMMA"][256:],
        "MEAN_RED_OR_BLUE": mean_of_four(31, 0),
        "MEAN_GREEN": mean_of_four(63, 10),
    }
