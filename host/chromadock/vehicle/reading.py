"""Reads a vehicle's file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from chromadock.errors import ChromadockError
from chromadock.toml_file import one_line_error, read_toml
from chromadock.vehicle.keys import VehicleFile

_MEND = "give a vehicle's file, which `chromadock config init` writes"
_FILES = (("camera", "calibration"), ("dock", "file"))
"""Keys that name files beside the vehicle's own."""


def read_vehicle(path: Path, changes: Mapping[str, Any] | None = None) -> VehicleFile:
    """The settings of a file, with defaults for what is not there.

    Parameters
    ----------
    path
        A TOML file; other files that it names are sought beside it.
    changes
        Values by dotted key that go before the file's, such as those of ``--set``; files among
        them are sought in the working directory.

    Raises
    ------
    ChromadockError
        One line with the file, the key, what stands there and what may stand there.
    """
    content = read_toml(path, _MEND)
    for table, key in _FILES:
        named = content.get(table, {}) if isinstance(content.get(table, {}), dict) else {}
        if isinstance(named.get(key), str) and named[key]:
            named[key] = str(path.parent / named[key])
    return _validated(str(path), content, changes or {})


def settings_of(changes: Mapping[str, Any], name: str = "--set") -> VehicleFile:
    """The defaults, but for ``changes``; see ``read_vehicle``.  ``name`` stands in messages.

    Raises
    ------
    ChromadockError
        As there.
    """
    return _validated(name, {}, changes)


def with_whole_paths(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Changes whose files are named from the root on, for a process that runs elsewhere."""
    files = {f"{table}.{key}" for table, key in _FILES}
    return {
        key: str(Path(value).absolute()) if key in files and value else value
        for key, value in changes.items()
    }


def _validated(name: str, content: dict[str, Any], changes: Mapping[str, Any]) -> VehicleFile:
    for dotted, value in changes.items():
        _put(content, dotted, value)
    try:
        return VehicleFile.model_validate(content)
    except ValidationError as error:
        raise one_line_error(name, error) from None


def _put(content: dict[str, Any], dotted: str, value: Any) -> None:
    """Set the value of a dotted key; a text where a number was meant to be one, as `--set
    camera.source=0`, stays what the key wants."""
    table, _, key = dotted.partition(".")
    model = VehicleFile.model_fields.get(table)
    if not key or "." in key or model is None:
        known = ", ".join(VehicleFile.model_fields)
        raise ChromadockError(f"--set {dotted}: no such key: write table.key, of {known}")
    keys = content.setdefault(table, {})
    if not isinstance(keys, dict):
        raise ChromadockError(f"--set {dotted}: {table} is no table of keys in the file")
    keys[key] = str(value) if _is_text(table, key) and type(value) in (int, float) else value


def _is_text(table: str, key: str) -> bool:
    """Whether a key takes a text."""
    field = tables()[table].model_fields.get(key)
    return field is not None and field.annotation is str


def tables() -> dict[str, type[BaseModel]]:
    """The models of the file's tables by their names, in the file's order."""
    return {name: _model(field.annotation) for name, field in VehicleFile.model_fields.items()}


def _model(annotation: Any) -> type[BaseModel]:
    """Of a table that may be left out, the table."""
    choices = getattr(annotation, "__args__", (annotation,))
    model: type[BaseModel] = next(c for c in choices if c is not type(None))
    return model
