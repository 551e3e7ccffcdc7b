"""Words for messages that must stay on one line."""

from __future__ import annotations


def one_line(value: object, limit: int = 160) -> str:
    """``str(value)`` with every run of white space made one blank, cut at ``limit`` letters."""
    text = " ".join(str(value).split())
    return text if len(text) <= limit else text[: limit - 3] + "..."


def plural(count: int, noun: str) -> str:
    """``1 frame``, ``2 frames``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"
