"""A new file that is at every moment the beginning of what was written to it."""

from __future__ import annotations

import os
from pathlib import Path

from chromadock.output.base import cannot_write


class GrowingFile:
    """Keeps what is written until ``flush``, and then what the disk did not take, for the next.

    So after a disk that was full for a while the file goes on without a gap.
    """

    def __init__(self, path: Path) -> None:
        """Make the file: ``path``, or where that is there already, ``dive-2.mcap`` and so on.

        Raises
        ------
        ChromadockError
            Where the system does not let us.
        """
        self.path, self._descriptor = _created(path)
        self._pending = bytearray()
        self._length = 0

    def write(self, data: bytes) -> int:
        """Take bytes."""
        self._pending += data
        self._length += len(data)
        return len(data)

    def tell(self) -> int:
        """How many bytes have been taken."""
        return self._length

    def flush(self) -> None:
        """Give the system what is kept; ``OSError`` where it does not take all."""
        while self._pending:
            written = os.write(self._descriptor, self._pending)
            del self._pending[:written]

    def sync(self) -> None:
        """Wait until the disk has it, so that it outlives the loss of power."""
        if self.path.is_file():
            os.fsync(self._descriptor)

    def close(self) -> None:
        """Close the file; what the disk did not take is gone."""
        os.close(self._descriptor)


def _created(path: Path) -> tuple[Path, int]:
    """A file that was not there before, and its descriptor; what is no file, a pipe, is opened."""
    flags = os.O_WRONLY | os.O_CREAT | getattr(os, "O_BINARY", 0)
    number, free = 1, path
    while True:
        exclusive = 0 if free.exists() and not free.is_file() else os.O_EXCL
        try:
            return free, os.open(free, flags | exclusive, 0o666)
        except FileExistsError:
            number += 1
            free = path.with_name(f"{path.stem}-{number}{path.suffix}")
        except OSError as error:
            raise cannot_write(path, error) from None
