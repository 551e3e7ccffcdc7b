"""The commands of the documents, as a reader would type them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = [
    ROOT / "README.md",
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "deploy").rglob("*.md")),
    ROOT / "hil" / "README.md",
]
_FENCE = re.compile(r"\s*```(\w*)\s*")
OF_THE_SHELL = {"", "sh", "bash", "console"}
"""Languages of blocks that have commands and nothing else; `text` is for what is none."""


def blocks(document: Path) -> Iterator[tuple[str, list[str]]]:
    """Language and lines of each fenced block."""
    language: str | None = None
    lines: list[str] = []
    for line in document.read_text().splitlines():
        fence = _FENCE.fullmatch(line)
        if fence is None:
            lines.append(line)
        elif language is None:
            language, lines = fence[1], []
        else:
            yield language, lines
            language = None
    assert language is None, f"{document.name}: a block without an end"


def commands(document: Path) -> list[str]:
    """Each command, without its comment."""
    found = []
    for language, lines in blocks(document):
        if language in OF_THE_SHELL:
            text = re.sub(r"\\\n\s*", "", "\n".join(lines))
            found += [_without_comment(line) for line in text.splitlines()]
    return [command for command in found if command]


def _without_comment(line: str) -> str:
    """A comment begins with a # at the start of a word."""
    return re.sub(r"(^|\s+)#\s.*$", "", line).strip()
