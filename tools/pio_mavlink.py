"""Run by PlatformIO before each build: the link's C headers, for dockcore and what uses it."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

from SCons.Script import DefaultEnvironment

env = DefaultEnvironment()

ROOT = Path(env.subst("$PROJECT_DIR"))
PYTHON = env.subst("$PYTHONEXE")


def installer() -> list[str]:
    """Return the command that installs into PlatformIO's Python.

    ``uv tool install platformio`` and pioarduino make environments without pip, by uv.
    """
    if importlib.util.find_spec("pip") is not None:
        return [PYTHON, "-m", "pip", "install"]
    uv = shutil.which("uv") or shutil.which("uv", path=str(Path(PYTHON).parent))
    if uv is None:
        sys.exit(
            f"error: {PYTHON} has neither pymavlink nor pip, and there is no uv: "
            "install pymavlink there"
        )
    return [uv, "pip", "install", "--python", PYTHON]


# PlatformIO's Python is another one than .venv's where its own installer made it.
if importlib.util.find_spec("pymavlink") is None:
    pinned = ["-q", "-c", str(ROOT / "tools" / "constraints.txt"), "pymavlink"]
    subprocess.run([*installer(), *pinned], stdin=subprocess.DEVNULL)
    importlib.invalidate_caches()

sys.path.insert(0, str(ROOT / "shared"))
import mavlink  # noqa: E402 - found by the line above

try:
    mavlink.generate_c()
except mavlink.MavlinkError as error:
    sys.exit(f"error: {error}")

# System headers: they would not pass dockcore's warnings.  On the ordinary path too, which the
# compiler then ignores, but where SCons looks for what an object file depends on.
headers = str(mavlink.C_HEADERS)
env.Append(CCFLAGS=[("-isystem", headers)], CPPPATH=[headers])
