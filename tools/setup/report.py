"""What the set-up tells its user: one short line a step, and what is missing."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager

from paths import STATE


class SetupError(Exception):
    """Something that cannot be worked around: what, where and the mend, in one line."""


def running_in_ci() -> bool:
    """Tell whether this is a CI run, where nothing may be missing."""
    return os.environ.get("CI", "").lower() in ("1", "true")


def say(text: str) -> None:
    """Print one line of progress."""
    print(f"setup: {text}\n", end="", flush=True)


@contextmanager
def step(text: str) -> Iterator[None]:
    """Announce a step that takes a while, and how long it took.

    Each is a line of its own, since other steps may run at the same time.
    """
    say(f"{text} ...")
    start = time.monotonic()
    try:
        yield
    except BaseException:
        say(f"{text}: failed")
        raise
    say(f"{text}: {time.monotonic() - start:.0f} s")


class Unavailable:
    """The optional things that could not be had, each with its reason.

    They are written to build/setup.json, from which the tests that need one of
    them take the reason of their skip.
    """

    def __init__(self) -> None:
        self.reasons: dict[str, str] = {}

    def add(self, name: str, reason: str) -> None:
        """Report that `name` cannot be had."""
        self.reasons[name] = reason
        say(f"not available: {name}: {reason}")

    def save(self) -> None:
        """Write the record, and stop a CI run if anything is missing."""
        STATE.parent.mkdir(exist_ok=True)
        STATE.write_text(json.dumps({"unavailable": self.reasons}, indent=2) + "\n")
        if self.reasons and running_in_ci():
            raise SetupError(f"CI=true, but not available: {', '.join(self.reasons)}")
