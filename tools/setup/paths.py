"""Where the set-up puts things."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools"
VENV = ROOT / ".venv"
BUILD = ROOT / "build"

VENV_BIN = VENV / "bin"
VENV_PYTHON = VENV_BIN / "python"
CONSTRAINTS = TOOLS / "constraints.txt"
LOG = BUILD / "setup.log"
STATE = BUILD / "setup.json"
