"""Two halves of all scenes: one to develop on, the other to report."""

from __future__ import annotations

import zlib
from enum import Enum
from pathlib import Path


class Half(Enum):
    """Its seeds are even or odd, and its photographs are its own."""

    DEVELOP = "develop"
    REPORT = "report"

    def seed(self, number: int) -> int:
        """The seed of this half's n-th series."""
        return 2 * number + (self is Half.REPORT)

    def has(self, photograph: Path) -> bool:
        """Whether a photograph is this half's: by its name alone, on any machine."""
        return bool(zlib.crc32(photograph.name.encode()) % 2) == (self is Half.REPORT)
