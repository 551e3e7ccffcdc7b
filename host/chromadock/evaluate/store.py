"""Finished pieces of an evaluation on disk, so that an interrupted one goes on where it was.

A part is a Parquet file named by the digest of everything that it was made from and by the
digest of its own bytes.  What was made from something else has another name and is never
taken; what is damaged does not fit its name and is made again.
"""

from __future__ import annotations

import hashlib
import io
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import polars as pl

from chromadock.errors import ChromadockError
from chromadock.output.base import cannot_write, partial_name

_LETTERS = 16


def digest(content: bytes) -> str:
    """SHA-256, its first 64 bits as hexadecimal."""
    return hashlib.sha256(content).hexdigest()[:_LETTERS]


def make_folder(path: Path) -> None:
    """Make sure that there is a folder of that name.

    Raises
    ------
    ChromadockError
        Where the system does not let us.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(path, error) from None


def write_whole(path: Path, content: bytes) -> None:
    """Write a file under a temporary name and rename it, so that it is whole or not there.

    Raises
    ------
    ChromadockError
        Where the system does not let us.
    """
    partial = partial_name(path)
    make_folder(path.parent)
    try:
        partial.write_bytes(content)
        partial.replace(path)
    except OSError as error:
        raise cannot_write(path, error) from None
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)


class Store:
    """The folder of parts; ``key`` is the digest of what a part is made from."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def write(self, key: str, table: pl.DataFrame) -> None:
        """Keep a part.

        Raises
        ------
        ChromadockError
            Where it cannot be written.
        """
        buffer = io.BytesIO()
        table.write_parquet(buffer)
        content = buffer.getvalue()
        write_whole(self._folder / f"{key}-{digest(content)}.parquet", content)

    def read(self, key: str) -> pl.DataFrame | None:
        """The part, or None where there is none that is whole."""
        for path in sorted(self._folder.glob(f"{key}-*.parquet")):
            try:
                content = path.read_bytes()
            except OSError as error:
                raise ChromadockError(
                    f"{path}: cannot be read ({error.strerror}): remove it, it is made again"
                ) from None
            if path.stem == f"{key}-{digest(content)}":
                return pl.read_parquet(io.BytesIO(content))
        return None

    def keep_only(self, keys: Iterable[str]) -> None:
        """Remove the parts of all other keys, and damaged ones: nothing will ever take them."""
        wanted = set(keys)
        for path in self._folder.glob("*.parquet"):
            key = path.stem.rpartition("-")[0]
            if key not in wanted or path.stem != f"{key}-{digest(path.read_bytes())}":
                path.unlink()
