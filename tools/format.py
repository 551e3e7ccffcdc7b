"""Formats the Python and C sources: .venv/bin/python tools/format.py."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from lint import BIN, handwritten_c_files
from step import ROOT


def main() -> int:
    """Format everything and return the exit status."""
    commands: tuple[list[str | Path], ...] = (
        [BIN / "ruff", "check", "--quiet", "--fix", "."],
        [BIN / "ruff", "format", "--quiet", "."],
        [BIN / "clang-format", "-i", *handwritten_c_files()],
    )
    # All of them, even if one finds what it cannot mend.
    return max([subprocess.run(command, cwd=ROOT).returncode for command in commands])


if __name__ == "__main__":
    sys.exit(main())
