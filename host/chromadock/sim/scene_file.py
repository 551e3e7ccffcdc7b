"""Reads a scene's TOML file: over its base, with the names of other files resolved."""

from __future__ import annotations

import copy
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from chromadock.errors import ChromadockError
from chromadock.sim.camera_spec import SHIPPED as SHIPPED_CAMERAS
from chromadock.sim.scene_models import SceneFile
from chromadock.toml_file import one_line_error, read_toml
from chromadock.validation import shown

SHIPPED = ("pool", "lake", "sea")
"""Files in ``scenes/``, to take by name or to copy."""

_MEND = f"give the TOML file of a scene, or one of {', '.join(SHIPPED)}"
_FILES = {
    ("dock", "geometry"): (),
    ("vehicle_camera", "model"): SHIPPED_CAMERAS,
    ("dock_camera", "model"): SHIPPED_CAMERAS,
}
"""Keys that name files, and names that are none."""


class SceneTables:
    """The tables of a scene's file over those of its base, which they replace whole.

    Raises
    ------
    ChromadockError
        Where a file cannot be read, or is its own base.
    """

    def __init__(self, name_or_path: str) -> None:
        self._content: dict[str, Any] = {}
        self._sources: dict[str, str] = {}
        self.source = self._read(name_or_path, ())

    def put(self, dotted: str, value: Any) -> None:
        """Set the value of a dotted key; numbers count in lists, from 0, and + adds to one.

        Raises
        ------
        ChromadockError
            Where there is no such place.
        """
        *path, last = dotted.split(".")
        table: Any = self._content
        for i, key in enumerate(path):
            if isinstance(table, dict):
                table = table.setdefault(key, {})
            elif isinstance(table, list) and key.isdecimal() and int(key) < len(table):
                table = table[int(key)]
            if not isinstance(table, (dict, list)):
                raise self._no_place(dotted, f"{'.'.join(path[: i + 1])} is not a table")
        if isinstance(table, dict):
            table[last] = copy.deepcopy(value)
        elif last == "+":
            table.append(copy.deepcopy(value))
        elif last.isdecimal() and int(last) < len(table):
            table[int(last)] = copy.deepcopy(value)
        else:
            raise self._no_place(dotted, f"{'.'.join(path)} has numbers 0 to {len(table) - 1}")

    def validated(self) -> SceneFile:
        """The tables, checked.

        Raises
        ------
        ChromadockError
            One line with the file, the key, what is wrong and what is allowed.
        """
        try:
            return SceneFile.model_validate(self._content)
        except ValidationError as error:
            place = error.errors()[0]["loc"]
            raise one_line_error(self.source_of(str(place[0]) if place else ""), error) from None

    def source_of(self, key: str) -> str:
        """The file that a top-level key stands in."""
        return self._sources.get(key, self.source)

    def _read(self, name_or_path: str, above: tuple[str, ...]) -> str:
        """Add a file's tables over its base's; what messages call it."""
        if name_or_path in SHIPPED:
            source = f"{name_or_path}.toml"
            with resources.as_file(resources.files("chromadock.sim") / "scenes" / source) as path:
                own = read_toml(path, _MEND)
        else:
            source = name_or_path
            own = read_toml(name_or_path, _MEND)
            _resolve(own, Path(name_or_path).parent)
        if "base" in own:
            base = own.pop("base")
            if not isinstance(base, str):
                raise ChromadockError(f"{source}: base is {shown(base)}: {_MEND}")
            if base not in SHIPPED:
                base = str(Path(name_or_path).parent / base)
            if base in (*above, name_or_path):
                raise ChromadockError(f"{source}: base is {shown(base)}, which builds on this file")
            self._read(base, (*above, name_or_path))
        self._content.update(own)
        self._sources.update(dict.fromkeys(own, source))
        return source

    def _no_place(self, dotted: str, why: str) -> ChromadockError:
        return ChromadockError(f"{self.source}: {dotted} cannot be set: {why}")


def _resolve(tables: dict[str, Any], folder: Path) -> None:
    """Take the names of other files from the folder of the one that names them."""
    for (table, key), names in _FILES.items():
        section = tables.get(table)
        name = section.get(key) if isinstance(section, dict) else None
        if isinstance(section, dict) and isinstance(name, str) and name not in ("", *names):
            section[key] = str(folder / name)
