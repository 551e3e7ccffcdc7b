"""A kept row is used again only while the code that made it is the same."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import chromadock
from chromadock.evaluate.version import _files

ROOT = Path(chromadock.__file__).parent
NO_ROWS = ("controls", "evaluate", "output", "sources")
"""Left out on purpose: what keeps, draws or writes rows, what reads pictures unchanged, and what
sets a live camera."""
LOADED = """
import sys
import chromadock.evaluate.work
for name, module in list(sys.modules.items()):
    if name.startswith("chromadock.") and getattr(module, "__file__", None):
        print(module.__file__)
"""


def test_the_digest_covers_all_that_computing_a_row_loads() -> None:
    done = subprocess.run(
        [sys.executable, "-c", LOADED], capture_output=True, text=True, check=True
    )
    loaded = {Path(line).relative_to(ROOT) for line in done.stdout.splitlines()}
    makes_rows = {path for path in loaded if path.parts[0] not in NO_ROWS}
    assert Path("geometry", "pose.py") in makes_rows
    digested = {path.resolve() for path in _files()}
    assert {path for path in makes_rows if (ROOT / path).resolve() not in digested} == set()
