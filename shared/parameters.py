"""The settings' table: ``parameters.toml`` with its references resolved, a row a value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

Method = dict[str, Any]


@dataclass(frozen=True)
class Parameter:
    """One value that a ground station can set.

    ``minimum``, ``maximum`` and ``default`` are of the stored integer; users see
    stored * numerator / 2^shift in ``unit``.
    """

    name: str
    field: str
    minimum: int
    maximum: int
    default: int
    numerator: int
    shift: int
    unit: str
    values: tuple[str, ...]
    text: str

    def shown(self, stored: int) -> float:
        """The value that users see."""
        return stored * self.numerator / (1 << self.shift)


def load(document: dict[str, Any], method: Method) -> list[Parameter]:
    """Every parameter in the table's order; a row with ``each`` becomes several."""
    return [p for row in document["parameter"] for p in _expand(row, method)]


def _expand(row: dict[str, Any], method: Method) -> list[Parameter]:
    names = [row["name"]]
    fields = [row["field"]]
    if "each" in row:
        names = [f"{row['name']}_{part}" for part in row["each"]]
        fields = [f"{row['field']}[{i}]" for i in range(len(names))]
    values = tuple(str(v) for v in _resolve(row.get("values", ()), method))
    numerator, shift = row.get("scale", (1, 0))
    parameters = []
    for i, (name, field) in enumerate(zip(names, fields, strict=True)):
        if len(name) > 15:
            raise ValueError(f"{name}: MAVLink allows 15 letters")
        maximum = _resolve(row["max"], method)
        if not isinstance(maximum, int):
            maximum = len(maximum) - 1
        default = _resolve(row["default"], method)
        if isinstance(default, list):
            default = default[i]
        if str(default) in values and not isinstance(row["default"], int):
            default = values.index(str(default))
        minimum = _resolve(row.get("min", 0), method)
        if not minimum <= default <= maximum:
            raise ValueError(f"{name}: default {default} is not in {minimum}..{maximum}")
        parameters.append(
            Parameter(
                name,
                field,
                minimum,
                maximum,
                default,
                numerator,
                shift,
                row.get("unit", ""),
                values,
                row["text"],
            )
        )
    return parameters


def _resolve(value: Any, method: Method) -> Any:
    """The number behind "$section.key" of ``method.toml``."""
    if not (isinstance(value, str) and value.startswith("$")):
        return value
    section, key = value[1:].split(".")
    found = method[section][key]
    return list(found) if isinstance(found, dict) else found
