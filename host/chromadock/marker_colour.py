"""The colour of a dock's lamps where it is known beforehand, not worked out from the water."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np

from chromadock import method
from chromadock.colour.hsv import hsv_from_rgb
from chromadock.errors import ChromadockError
from chromadock.text import one_line

ColourKind = Literal["hue", "white", "any"]
"""``hue``: lamps of one hue; ``white``: of none; ``any``: of a colour that nobody knows."""

WANTED = '"#RRGGBB" such as "#0000FF", white or any'
"""What a user may write."""

# The sign may be left out: unquoted it begins a comment in a shell.
_SRGB = re.compile(r"#?([0-9a-f]{6})")


@dataclass(frozen=True, slots=True)
class MarkerColour:
    """What the markers shine in.

    Parameters
    ----------
    kind
        See ``ColourKind``.
    hue
        0..1535 of kind ``hue``; None of the others.
    text
        As it is shown to users: ``#RRGGBB``, ``white`` or ``any``.
    """

    kind: ColourKind
    hue: int | None
    text: str

    @classmethod
    def parse(cls, text: str, what: str = "marker colour") -> MarkerColour:
        """The colour that a user wrote; case does not count, nor whether ``#`` leads.

        A colour less saturated than water must be to have a hue is ``white``.

        Parameters
        ----------
        text : ``#RRGGBB`` (red, green, blue, two hexadecimal digits each), ``white`` or ``any``.
        what : the option or the file and key that it comes from, for the message.

        Raises
        ------
        ChromadockError
            One line with what may be written; also for black, which no lamp shines in.
        """
        word = text.strip().lower()
        if word == "white":
            return cls("white", None, "white")
        if word == "any":
            return cls("any", None, "any")
        digits = _SRGB.fullmatch(word)
        if digits is None:
            raise ChromadockError(f"{what} is '{one_line(text, 40)}': give {WANTED}")
        shown = f"#{digits[1].upper()}"
        rgb = np.frombuffer(bytes.fromhex(digits[1]), np.uint8)
        hue, saturation, value, _ = (int(part) for part in hsv_from_rgb(rgb))
        if value == 0:
            raise ChromadockError(f"{what} is {shown}, which no lamp shines in: give {WANTED}")
        if saturation < method.MIN_SATURATION:
            return cls("white", None, shown)
        return cls("hue", hue, shown)
