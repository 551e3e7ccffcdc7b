"""Folders of photographs that stand behind the dock."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from pathlib import Path


@lru_cache(maxsize=8)
def folder_digest(folder: Path) -> str:
    """Of the files' names and contents."""
    total = hashlib.sha256()
    for file in sorted(f for f in folder.iterdir() if f.is_file()):
        total.update(file.name.encode() + b"\0" + file.read_bytes())
    return total.hexdigest()
