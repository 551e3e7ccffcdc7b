"""Run by PlatformIO before each build: the link's C headers, for dockcore and what uses it."""

import importlib.util
import subprocess
import sys
from pathlib import Path

from SCons.Script import DefaultEnvironment

env = DefaultEnvironment()

ROOT = Path(env.subst("$PROJECT_DIR"))
CONSTRAINTS = ROOT / "tools" / "constraints.txt"

# PlatformIO's Python is another one than .venv's where its own installer made it.
if importlib.util.find_spec("pymavlink") is None:
    pip = [env.subst("$PYTHONEXE"), "-m", "pip", "install", "-q", "-c", str(CONSTRAINTS)]
    subprocess.run([*pip, "pymavlink"], stdin=subprocess.DEVNULL)
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
