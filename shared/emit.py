"""The generated files' text: C and Python sources, the golden vectors."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable
from typing import Any

Method = dict[str, Any]
Tables = dict[str, list[int]]

# Tables whose entries need more than 16 bits, and the signed one.
C_TYPES = {
    "SINE": "int16_t",
    "GAMMA": "uint16_t",
    "MARKER_HUE": "uint16_t",
    "ARCTANGENT": "uint8_t",
    "MEAN_RED_OR_BLUE": "uint8_t",
}


def c_type(name: str) -> str:
    """The smallest C type that holds a table's entries."""
    return C_TYPES.get(name, "uint32_t")


def rows(values: Iterable[int], indent: str, width: int) -> str:
    """Numbers in lines of at most ``width`` columns."""
    text = ", ".join(str(v) for v in values)
    return "\n".join(textwrap.wrap(text, width, initial_indent=indent, subsequent_indent=indent))


def constants(m: Method) -> dict[str, int]:
    """The integer constants under one name for C and Python."""
    work, roll, led = m["working_image"], m["rolling"], m["led"]
    mappings, nodes = m["marker"]["mappings"], m["marker"]["nodes"]
    return {
        "HUE_RANGE": m["hue"]["range"],
        "HUE_SHIFT": m["hue"]["shift"],
        "OPENCV_SHIFT": m["hue"]["opencv_shift"],
        "TRIG_UNIT": m["hue"]["trig_unit"],
        "ATAN_STEPS": m["hue"]["atan_steps"],
        "WORKING_WIDTH": work["width"],
        "WORKING_HEIGHT": work["height"],
        "MAX_FRAME_WIDTH": work["max_frame_width"],
        "MAX_FRAME_HEIGHT": work["max_frame_height"],
        "GREY_RED": m["grey"]["red"],
        "GREY_GREEN": m["grey"]["green"],
        "GREY_BLUE": m["grey"]["blue"],
        "GREY_SHIFT": m["grey"]["shift"],
        "GREY_BINS": m["background"]["bins"],
        "MIN_SATURATION": m["background"]["min_saturation"],
        "MIN_VALUE": m["background"]["min_value"],
        "MIN_VALUE_VEHICLE": m["background"]["min_value_vehicle"],
        "MIN_RESULTANT": m["background"]["min_resultant"],
        "FALLBACK_HUE": m["marker"]["fallback_hue"],
        **{f"MAPPING_{k.upper()}": i for i, k in enumerate(mappings)},
        "MAPPING_COUNT": len(mappings),
        "MARKER_NODES": nodes,
        "MARKER_NODE_STEP": m["hue"]["range"] // nodes,
        "WINDOW_MS": roll["window_ms"],
        "HOLD_MS": roll["hold_ms"],
        "MIN_WINDOW_MS": roll["min_window_ms"],
        "MAX_WINDOW_MS": roll["max_window_ms"],
        "WINDOW_CAPACITY": roll["max_window_ms"] * roll["max_rate_hz"] // 1000,
        "GAMMA_COUNT": len(led["gammas"]),
        "PWM_BITS": led["pwm_bits"],
        "MATRIX_UNIT": led["matrix_unit"],
    }


def c_header(banner: str, m: Method, digest: str, tables: Tables) -> str:
    """``method.h``: constants and table declarations."""
    lines = [
        f"/* {banner} */",
        "#ifndef METHOD_H",
        "#define METHOD_H",
        "",
        "#include <stdint.h>",
        "",
        f"#define METHOD_DIGEST UINT64_C(0x{digest})",
        "",
        *(f"#define METHOD_{name} {value}" for name, value in constants(m).items()),
        "",
        *(f"extern const {c_type(n)} METHOD_{n}[{len(v)}];" for n, v in tables.items()),
        "",
        "#endif",
        "",
    ]
    return "\n".join(lines)


def c_tables(banner: str, m: Method, tables: Tables) -> str:
    """``method.c``: the tables themselves."""
    parts = [f'/* {banner} */\n#include "method.h"\n']
    for name, values in tables.items():
        body = rows(values, "    ", 80)
        parts.append(f"const {c_type(name)} METHOD_{name}[{len(values)}] = {{\n{body}}};\n")
    return "\n".join(parts)


def python(banner: str, m: Method, digest: str) -> str:
    """``method.py``: the same constants."""
    observed = m["observed"]
    lines = [
        f"# {banner}",
        '"""The numbers that dock and vehicle share; ``method_tables`` has the lookup tables."""',
        "",
        f'DIGEST = "{digest}"',
        "",
        *(f"{name} = {value}" for name, value in constants(m).items()),
        f"MAPPING_NAMES = {tuple(m['marker']['mappings'])}",
        f'DEFAULT_MAPPING_NAME = "{m["marker"]["default_mapping"]}"',
        f"GAMMAS = {tuple(m['led']['gammas'])}",
        f"HUE_WINDOW_DEG = {observed['hue_window_deg']}",
        f"SATURATION_WINDOW = {observed['saturation_window']}",
        f"VALUE_WINDOW = {observed['value_window']}",
        "",
    ]
    return "\n".join(lines)


def python_tables(banner: str, tables: Tables) -> str:
    """``method_tables.py``: the same tables for numpy.

    Apart from the constants, which are read also by what must start without numpy.
    """
    lines = [
        f"# {banner}",
        '"""The lookup tables that dock and vehicle share."""',
        "",
        "import numpy as np",
        "",
    ]
    for name, values in tables.items():
        lines += [f"{name} = np.array(", "    [", rows(values, "        ", 96), "    ],"]
        lines += ["    dtype=np.int32,", ")", ""]
    return "\n".join(lines)


def vectors_json(vectors: dict[str, Any]) -> str:
    """One record a line: readable, and small differences stay small."""

    def records(key: str) -> str:
        return ",\n".join("  " + json.dumps(record) for record in vectors[key])

    kinds = ("frames", "rolling", "steady", "led", "mappings")
    body = ",\n".join(f' "{kind}": [\n{records(kind)}\n ]' for kind in kinds)
    return f'{{\n "banner": {json.dumps(vectors["banner"])},\n{body}\n}}\n'


def c_vectors(banner: str, vectors: dict[str, Any], pixels_digest: str) -> str:
    """``golden.c``: the vectors as the tables that ``golden.h`` declares.

    Build tools do not see what ``.incbin`` reads: the digest makes them compile again.
    """
    parts = [
        f"/* {banner} */",
        f"/* frames.bin: {pixels_digest} */",
        "/* clang-format off */",
        '#include "golden.h"',
        "",
        "/* The pixels, linked in as they are; -Wa,-I names the folder of frames.bin. */",
        '__asm__(".section .rodata\\n.global golden_pixels\\n.balign 4\\n"',
        '        "golden_pixels:\\n.incbin \\"frames.bin\\"\\n.previous\\n");',
        "",
        "const golden_frame_t golden_frames[] = {",
    ]
    for f in vectors["frames"]:
        b = f["background"]
        parts.append(
            f'    {{"{f["name"]}", FRAME_{f["format"].upper()}, {f["width"]}, {f["height"]},'
            f" METHOD_MAPPING_{f['mapping'].upper()}, {f['frame_at']}, {f['frame_bytes']},"
            f" {f['working_at']}, {f['smoothed_at']},\n"
            f"     {{{braces(b['bin_counts'])}, {b['bin']}, {{{b['hue_x']}, {b['hue_y']}}},"
            f" {b['chroma_sum']}, {b['saturation_sum']}, {b['value_sum']}, {b['hue']},"
            f" {b['saturation']}, {b['value']}, {b['resultant']}, {b['share']},"
            f" {b['confidence']}, {str(b['meaningful']).lower()}}},\n"
            f"     {braces(b['rgb'])}, {f['marker_hue']}, {braces(f['duties'])}}},"
        )
    parts += ["};", f"const size_t golden_frame_count = {len(vectors['frames'])};", ""]

    steps = []
    for r in vectors["rolling"]:
        for i, ((now, hue), mean) in enumerate(zip(r["decisions"], r["means"], strict=True)):
            steps.append(f"    {{{str(i == 0).lower()}, {now}u, {hue}, {mean}}},")
    parts += ["const golden_rolling_t golden_rolling[] = {", *steps, "};"]
    parts += [f"const size_t golden_rolling_count = {len(steps)};", ""]

    steps = []
    for r in vectors["steady"]:
        for i, ((now, meaningful, hue), shown) in enumerate(
            zip(r["decisions"], r["shown"], strict=True)
        ):
            steps.append(
                f"    {{{str(i == 0).lower()}, {now}u, {str(meaningful).lower()}, {hue}, {shown}}},"
            )
    parts += ["const golden_steady_t golden_steady[] = {", *steps, "};"]
    parts += [f"const size_t golden_steady_count = {len(steps)};", ""]

    parts.append("const golden_led_t golden_leds[] = {")
    for v in vectors["led"]:
        led = v["led"]
        parts.append(
            f"    {{{v['hue']}, {{{braces(led['offset'])}, {braces(led['matrix'])},"
            f" {led['gamma']}, {led['limit']}, {str(led['common_anode']).lower()}, 255}},"
            f" {braces(v['duties'])}}},"
        )
    parts += ["};", f"const size_t golden_led_count = {len(vectors['led'])};", ""]

    parts.append("const uint16_t golden_marker_hues[METHOD_MAPPING_COUNT][METHOD_HUE_RANGE] = {")
    for v in vectors["mappings"]:
        parts.append(f"    {{ /* {v['mapping']} */\n{rows(v['hues'], '        ', 100)}}},")
    parts += ["};", ""]
    return "\n".join(parts)


def braces(values: Iterable[int]) -> str:
    """A C initialiser."""
    return "{" + ", ".join(str(v) for v in values) + "}"
