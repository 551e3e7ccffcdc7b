"""Results as JSON, one object a line."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any, TextIO

from chromadock.output.base import Output, cannot_write, partial_name


class JsonLines(Output):
    """One JSON object a line, into a file or (``path`` None) to standard output at once."""

    def __init__(self, path: str | Path | None = None) -> None:
        self._path = None if path is None else Path(path)
        self._file: TextIO = sys.stdout
        if self._path is not None:
            self._partial = partial_name(self._path)
            try:
                self._file = self._partial.open("w", encoding="utf-8")
            except OSError as error:
                raise cannot_write(self._path, error) from None

    def write(self, record: dict[str, Any]) -> None:
        """Write one line, at once: whoever reads along must not wait for a full buffer."""
        print(json_line(record), file=self._file, flush=True)

    def keep(self) -> None:
        """Give the file its name."""
        if self._path is not None:
            self._file.close()
            self._partial.replace(self._path)

    def drop(self) -> None:
        """Remove the file."""
        if self._path is not None:
            self._file.close()
            self._partial.unlink(missing_ok=True)


def json_line(record: dict[str, Any]) -> str:
    """The record as one line of strict JSON; ``ValueError`` for NaN or infinity."""
    return json.dumps(record, allow_nan=False)
