"""What a step of the tests came to, and how it is shown."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@dataclass
class Outcome:
    """Counts of a step, and all it has to say if something failed."""

    passed: int = 0
    failed: int = 0
    skips: list[tuple[str, str]] = field(default_factory=list)
    figures: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    output: str = ""

    def add(self, other: Outcome) -> None:
        """Sum up."""
        self.passed += other.passed
        self.failed += other.failed
        self.skips += other.skips
        self.figures += other.figures
        self.notes += other.notes


def show_step(name: str, step: Callable[[], Outcome]) -> Outcome:
    """Run a step, print its status line, and its output if it failed."""
    start = time.monotonic()
    outcome = step()
    seconds = time.monotonic() - start
    status = "FAIL" if outcome.failed else "ok" if outcome.passed else "skip"
    count = outcome.passed + outcome.failed
    cases = f"{count} cases" if count > 1 else ""
    lines = [f"{status:5} {name:24} {cases:>10} {seconds:6.1f} s"]
    if outcome.failed:
        lines.append(outcome.output.rstrip())
    # At one stroke: another step may run at the same time.
    print("".join(f"{line}\n" for line in lines), end="", flush=True)
    return outcome


def missing(name: str) -> str | None:
    """Say why the set-up could not install something; None if it could."""
    state = ROOT / "build" / "setup.json"
    if not state.is_file():
        return None
    reason = json.loads(state.read_text())["unavailable"].get(name)
    return None if reason is None else str(reason)
