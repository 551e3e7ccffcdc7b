"""All checks and tests: .venv/bin/python tools/test.py, by way of `make test`.

One line a step, the output of those that fail, and at the very end the sum.  pytest takes longest;
the other steps run beside it, one after the other.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import hardware
from junit import read_report
from lint import BIN, LINTS
from step import ROOT, Outcome, missing, show_step

REPORTS = ROOT / "build" / "reports"


def unity() -> Outcome:
    """Run the firmware's Unity suites."""
    reason = missing("pio test")
    if reason is not None:
        return Outcome(skips=[("pio test -e native", reason)])
    report = REPORTS / "unity.xml"
    pio_test: list[str | Path] = [BIN / "pio", "test", "-e", "native"]
    return run_suite([*pio_test, "--junit-output-path", report], report)


def pytest() -> Outcome:
    """Run the host's tests and the comparisons of C, Python, OpenCV and Xtensa."""
    report = REPORTS / "pytest.xml"
    # One more than CI has processors: many tests wait for a process or a clock of their own.
    workers = ["-n", "3", "--dist", "worksteal"]
    return run_suite(
        [sys.executable, "-m", "pytest", "-q", *workers, f"--junitxml={report}"], report
    )


def hil() -> Outcome:
    """Run the hardware suite on the simulated dock; what only a board shows is named."""
    outcome = run_suite(hardware.COMMAND, hardware.REPORT)
    lines = outcome.output.splitlines()
    outcome.notes += [line for line in lines if line.startswith(hardware.LEFT_OUT)]
    return outcome


def run_suite(command: Sequence[str | Path], report: Path) -> Outcome:
    """Run a test runner and read its report, trusting neither of them alone."""
    report.parent.mkdir(parents=True, exist_ok=True)
    report.unlink(missing_ok=True)
    done = subprocess.run(
        command,
        cwd=ROOT,
        env={**os.environ, "PLATFORMIO_SETTING_ENABLE_TELEMETRY": "no"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    outcome = read_report(report)
    outcome.output = done.stdout
    if done.returncode != 0 and not outcome.failed:
        outcome.failed = 1
        outcome.output += f"\n{Path(command[0]).name}: exit status {done.returncode}"
    elif not outcome.passed and not outcome.failed:
        outcome.failed = 1
        outcome.output += "\nno test case passed or failed: are there any?"
    return outcome


def run_steps(steps: Sequence[tuple[str, Callable[[], Outcome]]]) -> Outcome:
    """Run steps one after the other and sum up."""
    total = Outcome()
    for name, step in steps:
        total.add(show_step(name, step))
    return total


def main() -> int:
    """Run everything and return the exit status."""
    beside_pytest = (*LINTS, ("pio test -e native", unity), ("hil", hil))
    with ThreadPoolExecutor(max_workers=1) as pool:
        rest = pool.submit(run_steps, beside_pytest)
        try:
            total = run_steps([("pytest", pytest)])
            total.add(rest.result())
        except KeyboardInterrupt:
            os._exit(130)  # at once: leaving the pool would wait for the steps that are left
    for figure in total.figures:
        print(f"figure: {figure}")
    for note in total.notes:
        print(note)
    for name, reason in total.skips:
        print(f"skipped: {name}: {reason}")
    print(summary(total))
    nothing_may_be_skipped = os.environ.get("CI", "").lower() in ("1", "true")
    return 1 if total.failed or (total.skips and nothing_may_be_skipped) else 0


def summary(total: Outcome) -> str:
    """Sum up in one line."""
    skipped = f", {len(total.skips)} skipped" if total.skips else ""
    return f"{total.passed} passed, {total.failed} failed{skipped}"


if __name__ == "__main__":
    sys.exit(main())
