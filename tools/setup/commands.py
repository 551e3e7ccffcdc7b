"""Runs other programs without their noise."""

from __future__ import annotations

import os
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from paths import LOG, ROOT
from report import SetupError

# What a program prints last is often a summary; these say what went wrong.
TELLING = ("error:", "E:", "Error:", "fatal:")


def run(
    command: Sequence[str | Path],
    what: str,
    *,
    environment: Mapping[str, str] | None = None,
    timeout_s: float | None = None,
) -> str:
    """Run a command and return its output, which is shown nowhere but in the log.

    Raises:
        SetupError: it cannot be started, fails or takes too long.
    """
    arguments = [str(part) for part in command]
    line = f"$ {shlex.join(arguments)}\n"
    try:
        done = subprocess.run(
            arguments,
            cwd=ROOT,
            env={**os.environ, **(environment or {})},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=timeout_s,
        )
    except OSError as error:
        log(line)
        raise SetupError(f"{what}: {error.strerror}: {arguments[0]}") from error
    except subprocess.TimeoutExpired as error:
        log(line)
        raise SetupError(f"{what}: not finished after {timeout_s:.0f} s") from error
    log(line + done.stdout)
    if done.returncode != 0:
        reason = telling_line(done.stdout) or f"exit status {done.returncode}"
        raise SetupError(f"{what}: {reason} (see {LOG.relative_to(ROOT)})")
    return done.stdout


def telling_line(output: str) -> str:
    """Pick the line of a failed program's output that says most."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    telling = [line for line in lines if any(word in line for word in TELLING)]
    return (telling or lines or [""])[-1]


def log(text: str) -> None:
    """Append to the set-up's log, a command with all it said at once: others may run beside it."""
    LOG.parent.mkdir(exist_ok=True)
    with LOG.open("a") as file:
        file.write(text)
