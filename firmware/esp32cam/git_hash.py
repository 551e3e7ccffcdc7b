"""Run by PlatformIO before each build: the commit, for the firmware's own sources alone.

They get the macro GIT_HASH; a new commit does not rebuild Arduino.
"""

import subprocess

from SCons.Script import DefaultEnvironment

LETTERS = 8


def git_hash(folder: str) -> str:
    """Return the first letters of the commit; "unknown" outside git, or without it."""
    command = ["git", "rev-parse", f"--short={LETTERS}", "HEAD"]
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return done.stdout.strip()[:LETTERS]


env = DefaultEnvironment()
macro = env.StringifyMacro(git_hash(env.subst("$PROJECT_DIR")))
env.Append(SRC_BUILD_FLAGS=[f"-DGIT_HASH={macro}"])
