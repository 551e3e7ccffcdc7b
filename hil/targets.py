"""What the suite runs against: a board at a serial port, or the simulated dock."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Target:
    """What tests must know of it.

    ``reset_cause`` and ``reset_reason``: what the boot line and the dock say after
    ``Rig.reset``; ``settle_s``: until the camera's exposure, gain and white balance are locked.
    """

    name: str
    is_board: bool
    reset_cause: str
    reset_reason: int
    boot_s: float
    settle_s: float


# esp_reset_reason: 1 power on (the reset line, too), 3 restart by software.
BOARD = Target("board", True, "POWERON_RESET", 1, boot_s=10.0, settle_s=20.0)
SIMULATOR = Target("simulator", False, "SW_CPU_RESET", 3, boot_s=5.0, settle_s=5.0)


def flash(port: str) -> None:
    """Build this tree's firmware and write it to the board.

    Raises
    ------
    RuntimeError
        Where PlatformIO does not succeed.
    """
    command = [Path(sys.executable).parent / "pio", "run", "-e", "esp32cam", "-t", "upload"]
    done = subprocess.run([*command, "--upload-port", port], cwd=ROOT)
    if done.returncode != 0:
        raise RuntimeError(f"pio run -t upload: exit status {done.returncode}")
