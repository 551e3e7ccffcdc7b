"""What all things share that are opened and closed: files, ports, cameras, threads."""

from __future__ import annotations

from typing import TypeVar

_Self = TypeVar("_Self", bound="Closable")


class Closable:
    """A context manager that closes at the end, however that comes."""

    def close(self) -> None:
        """Let go of what is open.  A class that holds nothing open need not define it."""

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
