"""The parameters' values as people write them: checked before anything is sent."""

from __future__ import annotations

import difflib
import math
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.parameter_table import PARAMETERS, Parameter
from chromadock.text import one_line
from chromadock.toml_file import read_toml

TABLE = {p.name: p for p in PARAMETERS}


def parameter(name: str) -> Parameter:
    """The row of the table for ``name``, in capitals or not.

    Raises
    ------
    ChromadockError
        Where there is none; names the nearest.
    """
    if name.upper() in TABLE:
        return TABLE[name.upper()]
    near = difflib.get_close_matches(name.upper(), TABLE, 1)
    mend = f"did you mean {near[0]}?" if near else "see `chromadock dock params list`"
    raise ChromadockError(f"no parameter is called {one_line(name, 30)}: {mend}")


def parse(row: Parameter, text: str | float) -> float:
    """A number, or the name of an enumeration's value or an unambiguous start of it.

    Raises
    ------
    ChromadockError
        Where it is neither, or out of range.
    """
    if row.values:
        return float(_index(row, str(text)))
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    whole = step(row) == 1.0
    if not (row.minimum <= value <= row.maximum) or (whole and value != round(value)):
        raise ChromadockError(
            f"{row.name} is {one_line(text, 30)}: give {'a whole number' if whole else 'a number'} "
            f"{row.minimum:g} .. {row.maximum:g}{f' {row.unit}' if row.unit else ''}"
        )
    return value


def show(row: Parameter, value: float) -> str:
    """The value with its unit, or its name."""
    if row.values and value == round(value) and 0 <= value < len(row.values):
        return row.values[int(value)]
    number = f"{value:.0f}" if value == round(value) else f"{value:.4f}".rstrip("0")
    return f"{number} {row.unit}".strip()


def show_range(row: Parameter) -> str:
    """What may be set."""
    if row.values:
        return " | ".join(row.values)
    return f"{row.minimum:g} .. {row.maximum:g} {row.unit}".strip()


def step(row: Parameter) -> float:
    """The smallest difference of two values, as the dock keeps them: the table's ends are
    whole numbers of steps, so it is the unit of the fraction of the larger one."""
    fraction = math.modf(row.maximum)[0]
    if fraction == 0:
        return 1.0
    return 360.0 / 1536 if row.unit == "deg" else 1.0 - fraction


def read_file(path: Path) -> dict[str, float]:
    """Names and values of a TOML file of ``NAME = value``; all of it is right, or nothing.

    Raises
    ------
    ChromadockError
        One line: the file, the name, what may be set.
    """
    content = read_toml(path, "give a TOML file of NAME = value")
    if not content:
        raise ChromadockError(f"{path}: sets nothing: write lines of NAME = value")
    values: dict[str, float] = {}
    for name, value in content.items():
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise ChromadockError(f"{path}: {name} must be a number or a name in quotes")
        try:
            row = parameter(name)
            values[row.name] = parse(row, value)
        except ChromadockError as error:
            raise ChromadockError(f"{path}: {error}") from None
    return values


def _index(row: Parameter, text: str) -> int:
    names = [value.lower() for value in row.values]
    wanted = text.strip().lower()
    if wanted in names:
        return names.index(wanted)
    if all(_number(name) is not None for name in names):  # LED_GAMMA: 2.2, not its place
        matches = [i for i, name in enumerate(names) if _number(name) == _number(wanted)]
    elif wanted.isascii() and wanted.isdigit():
        matches = [int(wanted)] if int(wanted) < len(names) else []
    else:
        matches = [i for i, name in enumerate(names) if wanted and name.startswith(wanted)]
    if len(matches) != 1:
        raise ChromadockError(
            f"{row.name} is {one_line(text, 30)}: give one of {' | '.join(row.values)}"
        )
    return matches[0]


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
