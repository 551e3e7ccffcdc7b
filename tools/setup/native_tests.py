"""Makes `pio test -e native` work: by PlatformIO's registry, or without it."""

from __future__ import annotations

import shutil
from pathlib import Path

import offline_kit
from commands import run
from paths import CONSTRAINTS, TOOLS, VENV_BIN, VENV_PYTHON
from report import SetupError, Unavailable, say, step
from stamps import Stamp

PROBE = TOOLS / "setup" / "registry_probe.py"
KIT_SOURCES = [
    TOOLS / "setup" / name
    for name in ("native_tests.py", "offline_kit.py", "native_builder.py", "unity_source.py")
]


def set_up(unavailable: Unavailable) -> None:
    """Fetch PlatformIO's packages for native tests, or build the offline kit."""
    stamp = Stamp(offline_kit.KIT, "done", [CONSTRAINTS, *KIT_SOURCES])
    if stamp.fresh():
        return
    try:
        if not from_registry():
            with step("PlatformIO offline kit, Unity from Debian's sources"):
                offline_kit.build_kit()
        stamp.set()
    except SetupError as error:
        shutil.rmtree(offline_kit.KIT, ignore_errors=True)
        unavailable.add("pio test", f"Unity: {error}")


def from_registry() -> bool:
    """Install from PlatformIO's registry, the ordinary way; tell whether it worked."""
    pio: list[str | Path] = [VENV_BIN / "pio", "pkg", "install", "-e", "native"]
    shutil.rmtree(offline_kit.KIT, ignore_errors=True)
    try:
        run([VENV_PYTHON, PROBE], "no answer", timeout_s=60)
        with step("PlatformIO packages"):
            run(pio, "pio pkg install", timeout_s=600)
    except SetupError as error:
        say(f"PlatformIO's registry is not used: {error}")
        return False
    return True
