"""One line of the doctor's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Level = Literal["ok", "warning", "fault"]


@dataclass(frozen=True, slots=True)
class Finding:
    """What was looked at, how it is, and, unless it is well, what to do.

    ``level``: a ``fault`` keeps the vehicle from finding the dock or from telling anybody, a
    ``warning`` makes it worse or could not be looked into.
    """

    level: Level
    subject: str
    words: str
