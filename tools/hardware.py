"""The hardware-in-the-loop suite: .venv/bin/python tools/hardware.py, by way of `make hil`.

Arguments go to pytest: --port=/dev/ttyUSB0 for a board, --baud, --flash, -k ...
"""

from __future__ import annotations

import subprocess
import sys

from step import ROOT

REPORT = ROOT / "build" / "hil" / "report.xml"
COMMAND = [sys.executable, "-m", "pytest", "-c", "hil/pytest.ini", "hil", f"--junitxml={REPORT}"]
LEFT_OUT = "not on the simulator: "
"""Begins a line of its output that names a test for boards only."""

if __name__ == "__main__":
    sys.exit(subprocess.run([*COMMAND, *sys.argv[1:]], cwd=ROOT).returncode)
