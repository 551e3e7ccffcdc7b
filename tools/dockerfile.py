"""Reads a Dockerfile, as far as the project's own goes: to run its commands where no Docker is."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from typing import Any


def instructions(path: Path) -> list[tuple[str, str]]:
    """Name and text of each instruction, in order; a line that goes on is joined to its next."""
    lines = [line for line in path.read_text().splitlines() if not line.lstrip().startswith("#")]
    whole = re.sub(r"\\\n", "", "\n".join(lines))
    parts = (line.strip().partition(" ") for line in whole.splitlines() if line.strip())
    return [(name, text.strip()) for name, _, text in parts]


def labels(path: Path) -> dict[str, str]:
    """The last stage's labels."""
    found = {}
    for name, text in instructions(path):
        if name == "FROM":
            found.clear()
        elif name == "LABEL":
            (pair,) = shlex.split(text)
            key, _, value = pair.partition("=")
            found[key] = value
    return found


def copied(path: Path) -> list[str]:
    """What is copied from the context, as it stands there."""
    found = []
    for name, text in instructions(path):
        if name == "COPY" and not text.startswith("--from="):
            found += text.split()[:-1]
    return found


def runs(path: Path) -> list[list[str]]:
    """The shell commands of each stage."""
    stages: list[list[str]] = []
    for name, text in instructions(path):
        if name == "FROM":
            stages.append([])
        elif name == "RUN":
            stages[-1].append(text)
    return stages


def exec_form(path: Path, name: str) -> list[str]:
    """The arguments of CMD, or of HEALTHCHECK's CMD."""
    (text,) = [text for given, text in instructions(path) if given == name]
    arguments: Any = json.loads(text[text.index("[") :])
    return [str(argument) for argument in arguments]
