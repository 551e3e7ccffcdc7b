"""The vehicle's file and its page of the documentation, both from the keys."""

from __future__ import annotations

import json
import textwrap
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from chromadock.validation import Wanted
from chromadock.vehicle.keys import TEXT_IN_QUOTES, VehicleFile
from chromadock.vehicle.reading import tables

_WIDTH = 100
_HEAD = """\
# The settings of a vehicle: `chromadock run` reads them.
# Every key has its default here; one that is left out has it too.
"""


def shipped_file() -> str:
    """A TOML file with every key at its default, its meaning beside it."""
    parts = [_HEAD]
    for name, model in tables().items():
        optional = VehicleFile.model_fields[name].default is None
        sign = "# " if optional else ""
        lines = [*_comment(_words(model)), f"{sign}[{name}]"]
        for key, field in model.model_fields.items():
            lines += _comment(f"{field.description}{_told(field)}")
            lines.append(f"{sign}{key} = {toml_value(field.default)}")
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def page() -> str:
    """``docs/configuration.md``."""
    parts = [
        "<!-- By tools/configuration.py from host/chromadock/vehicle/keys.py. Do not edit. -->",
        "# The vehicle's file",
        "",
        "`chromadock config init vehicle.toml` writes it, `config check` says what is wrong in it, "
        "`config show` what holds,\n`chromadock run vehicle.toml` runs it. `--set table.key=value` "
        "takes precedence over a key of the file.\nFiles that it names are sought beside it.",
    ]
    for name, model in tables().items():
        parts += ["", f"## [{name}]", "", _words(model), ""]
        parts += ["| key | default | may be | meaning |", "|---|---|---|---|"]
        parts += [
            f"| `{key}` | `{toml_value(field.default)}` | {_range(field)} | {field.description} |"
            for key, field in model.model_fields.items()
        ]
    return "\n".join(parts) + "\n"


def effective(vehicle: VehicleFile) -> list[tuple[str, str, bool]]:
    """Dotted key, value as in TOML, and whether it is another than the default, of every key."""
    found = []
    for name, model in tables().items():
        table: BaseModel | None = getattr(vehicle, name)
        for key, field in model.model_fields.items() if table is not None else ():
            value = getattr(table, key)
            found.append((f"{name}.{key}", toml_value(value), value != field.default))
    return found


def as_toml(vehicle: VehicleFile) -> str:
    """A TOML file with every key as it holds, read again as the same settings."""
    parts: dict[str, list[str]] = {}
    for dotted, value, _ in effective(vehicle):
        table, _, key = dotted.partition(".")
        parts.setdefault(f"[{table}]", []).append(f"{key} = {value}")
    return "\n".join("\n".join([name, *lines, ""]) for name, lines in parts.items())


def toml_value(value: Any) -> str:
    """As it is written in a TOML file: JSON's text, number, truth and list are TOML's too."""
    return json.dumps(value, ensure_ascii=False)


def _range(field: FieldInfo) -> str:
    """What may stand there."""
    return next(part.words for part in field.metadata if isinstance(part, Wanted))


def _told(field: FieldInfo) -> str:
    """The same for the file, where the default does not show it."""
    plain = isinstance(field.default, (bool, list)) or _range(field) == TEXT_IN_QUOTES
    return "" if plain else f" ({_range(field)})"


def _words(model: type[BaseModel]) -> str:
    return " ".join((model.__doc__ or "").split())


def _comment(words: str) -> list[str]:
    return [f"# {line}" for line in textwrap.wrap(words, _WIDTH - 2)]
