"""Reads the text files that users write, as their editors save them."""

from __future__ import annotations

import codecs
from pathlib import Path


def read_text(path: str | Path) -> str:
    """A file's text: UTF-8, with a byte-order mark or without, or UTF-16 with one.

    Windows' editors put the mark before the text, and its PowerShell writes UTF-16 where output
    goes to a file (``ros2 topic echo ... > camera.yaml``).

    Raises
    ------
    OSError
        Where it cannot be read.
    UnicodeDecodeError
        Where it is no such text.
    """
    raw = Path(path).read_bytes()
    marked = raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    return raw.decode("utf-16" if marked else "utf-8-sig").replace("\r\n", "\n")
