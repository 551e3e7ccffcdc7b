"""What all outputs share: written under a temporary name, renamed when all is done, so
that no half-written file ever stands under the name that the user gave."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from chromadock.errors import ChromadockError

_Self = TypeVar("_Self", bound="Output")


class Output(ABC):
    """A context manager: leaving it normally keeps what was written, by an error drops it."""

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.keep()
        else:
            self.drop()

    @abstractmethod
    def keep(self) -> None:
        """Finish and give the output its name; nothing is there where nothing was written."""

    @abstractmethod
    def drop(self) -> None:
        """Remove everything that was written."""


class OverlayOutput(Output):
    """Takes one HxWx3 uint8 BGR picture a frame, with the frame's name and index."""

    @abstractmethod
    def write(self, picture: NDArray[np.uint8], name: str, index: int) -> None:
        """Add a picture.

        Raises
        ------
        ChromadockError
            Where it cannot be written.
        """


def partial_name(path: Path) -> Path:
    """A hidden name in the same folder, so that renaming never crosses disks."""
    return path.with_name(f".{path.stem}.partial-{os.getpid()}{path.suffix}")


def cannot_write(path: Path, error: OSError) -> ChromadockError:
    """The error for a file that the system does not let us write."""
    return ChromadockError(f"{path}: cannot be written ({error.strerror}): check disk and folder")
