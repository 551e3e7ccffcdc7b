"""A systemd unit as its sections and keys."""

from __future__ import annotations

from configparser import ConfigParser
from pathlib import Path


def read_unit(path: Path) -> ConfigParser:
    """The unit; keys keep their case, a key has one value here."""
    unit = ConfigParser(interpolation=None, delimiters=("=",), comment_prefixes=("#",))
    unit.optionxform = str  # type: ignore[assignment,method-assign]
    unit.read(path)
    return unit
