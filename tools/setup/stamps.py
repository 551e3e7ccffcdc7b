"""Remembers what is done, so that a second run does nothing.

A step's stamp holds the digest of all that the step depends on.  The stamp lies
inside the folder that the step fills: who deletes the folder deletes the stamp.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from paths import ROOT

# Left behind in source folders by builds and by Python.
LEFTOVERS = {"build", "__pycache__"}
LEFTOVER_SUFFIXES = {".so", ".o", ".pyc", ".egg-info"}


class Stamp:
    """The stamp of one step."""

    def __init__(self, folder: Path, name: str, depends_on: Iterable[Path | str]) -> None:
        self.file = folder / f".{name}.stamp"
        self.key = digest(depends_on)

    def fresh(self) -> bool:
        """Tell whether the step was done with the same dependencies."""
        return self.file.is_file() and self.file.read_text() == self.key

    def set(self) -> None:
        """Remember that the step is done."""
        self.file.parent.mkdir(parents=True, exist_ok=True)
        self.file.write_text(self.key)


def digest(items: Iterable[Path | str]) -> str:
    """Digest texts, files and whole folders, by content and by path in the tree."""
    total = hashlib.sha256()
    for item in items:
        if isinstance(item, str):
            total.update(f"text {item}\n".encode())
            continue
        for file in source_files(item):
            total.update(f"file {file.relative_to(ROOT)}\n".encode())
            total.update(hashlib.sha256(file.read_bytes()).digest())
    return total.hexdigest()


def source_files(path: Path) -> list[Path]:
    """List a file, or all files below a folder that are not left over from builds."""
    if path.is_file():
        return [path]
    return sorted(file for file in path.rglob("*") if file.is_file() and not is_leftover(file))


def is_leftover(file: Path) -> bool:
    """Tell whether a file below the root was made by a build."""
    parts = [Path(part) for part in file.relative_to(ROOT).parts]
    return any(part.name in LEFTOVERS or part.suffix in LEFTOVER_SUFFIXES for part in parts)
