"""Which recordings are meant, and where the results of each go."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from chromadock.errors import ChromadockError


@dataclass(frozen=True)
class Job:
    """A recording, as the user calls it, and the folder of its results (None for none)."""

    path: Path
    out: Path | None

    @property
    def absolute_out(self) -> Path | None:
        """The same for a process that runs elsewhere."""
        return None if self.out is None else self.out.absolute()


def recordings(given: Sequence[Path]) -> list[Path]:
    """Files as they are given, and all ``.mcap`` files in folders and below, by name; each once.

    Raises
    ------
    ChromadockError
        Where there is no such file, or none in a folder.
    """
    found: dict[Path, Path] = {}
    for path in given:
        for one in _in(path):
            found.setdefault(one.resolve(), one)
    return list(found.values())


def _in(path: Path) -> list[Path]:
    if not path.exists():
        raise ChromadockError(f"{path}: no such file: give a recording, as --record makes")
    if not path.is_dir():
        return [path]
    there = sorted(one for one in path.rglob("*.mcap") if one.is_file())
    if not there:
        raise ChromadockError(f"{path}: no .mcap file in it: give a folder with recordings")
    return there


def jobs_of(paths: Sequence[Path], out: Path | None) -> list[Job]:
    """The work on recordings; the results of each go into a folder of its name in ``out``,
    ``dive-2`` where that of another is ``dive``."""
    taken: set[str] = set()
    jobs = []
    for path in paths:
        name, number = path.stem, 1
        while name in taken:
            number += 1
            name = f"{path.stem}-{number}"
        taken.add(name)
        jobs.append(Job(path, None if out is None else out / name))
    return jobs
