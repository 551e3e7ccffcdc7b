"""Run by PlatformIO before a build of an environment that is for tests alone."""

import sys

from SCons.Script import DefaultEnvironment

env = DefaultEnvironment()

if "test" not in env.GetBuildType():
    name = env["PIOENV"]
    sys.exit(
        f"error: [env:{name}] has tests and no firmware: run `pio test -e {name}`, "
        "or `pio run` to build for the board"
    )
