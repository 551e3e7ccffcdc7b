"""The flash of the simulated dock: a file with the settings' blob."""

from __future__ import annotations

import os
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.output.base import partial_name

_MOST_BYTES = 4096


class Storage:
    """Settings in ``path``, or in memory where it is None: gone with the process."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._blob: bytes | None = None

    def load(self) -> bytes | None:
        """The blob, valid or not; None where nothing was ever saved.

        Raises
        ------
        ChromadockError
            Where the file is there but cannot be read.
        """
        if self._path is None:
            return self._blob
        try:
            with self._path.open("rb") as file:
                return file.read(_MOST_BYTES)
        except FileNotFoundError:
            return None
        except OSError as error:
            raise ChromadockError(
                f"{self._path}: cannot be read ({error.strerror}): give another --settings file"
            ) from None

    def save(self, blob: bytes) -> bool:
        """Keep the blob, whole or not at all; False where the file system refuses."""
        if self._path is None:
            self._blob = blob
            return True
        partial = partial_name(self._path)
        try:
            with partial.open("wb") as file:
                file.write(blob)
                file.flush()
                os.fsync(file.fileno())
            partial.replace(self._path)
        except OSError:
            partial.unlink(missing_ok=True)
            return False
        return True
