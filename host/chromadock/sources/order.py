"""The order in which pictures are shown."""

from __future__ import annotations

import re

Key = tuple[tuple[tuple[int, int, str], ...], str]

_SUFFIX = re.compile(r"\.[A-Za-z][A-Za-z0-9]*$")
_NUMBERS = re.compile(r"([0-9]+(?:\.[0-9]+)*)")


def natural_key(name: str) -> Key:
    """Sorting key of a file's name or path: by the numbers in it, as people count.

    ``img2.png`` comes before ``img10.png`` and ``0.25.png`` before ``0.5.png``: digits with one
    point among them are a decimal number, of seconds, say.  Digits with several points, as
    in ``2026.05.01``, are whole numbers one after the other, and a hyphen is no minus.  Capital
    letters count as small ones and the suffix not at all, unless all else is alike.
    """
    key: list[tuple[int, int, str]] = []
    for part in _NUMBERS.split(_SUFFIX.sub("", name)):
        numbers = part.split(".")
        if not part[:1].isdecimal():
            if part:
                key.append((1, 0, part.lower()))
        elif len(numbers) == 2:  # a fraction's digits are in order as they stand
            key.append((0, int(numbers[0]), numbers[1].rstrip("0")))
        else:
            key.extend((0, int(number), "") for number in numbers)
    return tuple(key), name
