"""The settings' table as C, Python and a page for people."""

from __future__ import annotations

from collections.abc import Sequence

from parameters import Parameter


def c_header(banner: str, parameters: Sequence[Parameter]) -> str:
    """``parameter_table.h``: an index for each parameter."""
    indices = "\n".join(f"    PARAMETER_{p.name}," for p in parameters)
    return f"""/* {banner} */
#ifndef PARAMETER_TABLE_H
#define PARAMETER_TABLE_H

#include "parameter.h"

enum {{
{indices}
    PARAMETER_COUNT
}};

extern const parameter_t PARAMETERS[PARAMETER_COUNT];

#endif
"""


def c_table(banner: str, parameters: Sequence[Parameter]) -> str:
    """``parameter_table.c``: where each lives in the settings, its range and scale."""
    rows = "\n".join(
        f'    {{"{p.name}", FIELD({p.field}), {p.minimum}, {p.maximum}, {p.default},'
        f" {p.numerator}, {p.shift}}},"
        for p in parameters
    )
    return f"""/* {banner} */
#include "parameter_table.h"

#include <stddef.h>

#include "settings.h"

#define FIELD(name) offsetof(dock_settings_t, name), sizeof(((dock_settings_t *)0)->name)

const parameter_t PARAMETERS[PARAMETER_COUNT] = {{
{rows}
}};
"""


def python(banner: str, parameters: Sequence[Parameter]) -> str:
    """``parameter_table.py``: what the host says of each."""
    rows = "\n".join(
        f"    Parameter({p.name!r}, {p.shown(p.minimum)!r}, {p.shown(p.maximum)!r},"
        f" {p.shown(p.default)!r}, {p.unit!r}, {p.values!r}, {p.text!r}),"
        for p in parameters
    )
    return f'''# {banner}
"""The dock's parameters as users see them."""

from typing import NamedTuple


class Parameter(NamedTuple):
    """Range and default in ``unit``; ``values`` names an enumeration's values from 0."""

    name: str
    minimum: float
    maximum: float
    default: float
    unit: str
    values: tuple[str, ...]
    text: str


PARAMETERS = (
{rows}
)
'''


def page(banner: str, parameters: Sequence[Parameter]) -> str:
    """``parameters.md``."""
    rows = "\n".join(
        f"| `{p.name}` | {_number(p.shown(p.minimum))} .. {_number(p.shown(p.maximum))} {p.unit} |"
        f" {_number(p.shown(p.default))} | {_meaning(p)} |"
        for p in parameters
    )
    return f"""<!-- {banner} -->
# Parameters of the dock

Set them with `chromadock dock params set NAME VALUE` or any MAVLink ground station; they take
effect at once and are kept over a restart after `chromadock dock params save`. Values outside the
range are refused.

| name | range | default | what it does |
|---|---|---|---|
{rows}
"""


def _number(value: float) -> str:
    return f"{value:.6g}"


def _meaning(p: Parameter) -> str:
    if not p.values:
        return p.text
    return p.text + " " + "; ".join(f"{i}: {v}" for i, v in enumerate(p.values)) + "."
