"""``chromadock dock flash``: build the firmware and write it to a board."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Annotated

import typer

from chromadock.cli.dock_options import Port
from chromadock.errors import ChromadockError

ENVIRONMENT = "esp32cam"
_CONFIGURATION = "platformio.ini"


def flash(
    port: Port = None,
    project: Annotated[
        Path | None,
        typer.Option(
            help="Folder with the firmware's platformio.ini.",
            show_default="this folder or one above",
        ),
    ] = None,
) -> None:
    """Build the firmware and write it to the board, by PlatformIO."""
    folder = _project(project)
    pio = _platformio()
    command = [pio, "run", "--project-dir", str(folder), "-e", ENVIRONMENT, "-t", "upload"]
    if port is not None:
        if "://" in port:
            raise ChromadockError(f"{port}: PlatformIO flashes by a serial port only: give that")
        if not Path(port).exists():
            raise ChromadockError(f"{port}: no such port: check the cable and `ls /dev/ttyUSB*`")
        command += ["--upload-port", port]
    status = subprocess.run(command, check=False).returncode
    if status:
        raise ChromadockError(
            f"PlatformIO ended with status {status}: see its lines above; on an ESP32-CAM without "
            "programmer board connect IO0 to GND and press reset first"
        )


def _project(given: Path | None) -> Path:
    here = Path.cwd()
    for folder in [given] if given is not None else [here, *here.parents]:
        configuration = folder / _CONFIGURATION
        try:
            if f"[env:{ENVIRONMENT}]" in configuration.read_text(encoding="utf-8"):
                return folder
        except (OSError, UnicodeDecodeError):
            continue
    raise ChromadockError(
        f"{given or here}: no {_CONFIGURATION} of Chromadock's firmware: "
        "give its folder with --project"
    )


def _platformio() -> str:
    """Beside this Python, or in the PATH."""
    beside = Path(sys.executable).with_name("pio")
    found = str(beside) if beside.exists() else shutil.which("pio") or shutil.which("platformio")
    if found is None:
        raise ChromadockError(
            "PlatformIO is not installed: `pip install platformio`, then try again"
        )
    return found
