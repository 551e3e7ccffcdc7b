"""The link's receiver under libFuzzer, for as long as `make test` can afford."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "fuzz.py"
SECONDS = 5

MISSING = 3  # exit status of the tool


def test_five_seconds_of_fuzzing_find_nothing(
    record_property: Callable[[str, object], None],
) -> None:
    done = subprocess.run(
        [sys.executable, str(TOOL), "--seconds", str(SECONDS), "--seed", "1"],
        capture_output=True,
        text=True,
        errors="replace",
        timeout=SECONDS + 200,
    )
    if done.returncode == MISSING:
        pytest.skip(done.stderr.strip())
    assert done.returncode == 0, done.stderr[-4000:]
    executed = re.search(r"number_of_executed_units: (\d+)", done.stderr)
    assert executed is not None
    record_property("figure", f"link fuzzed: {int(executed[1]):,} inputs in {SECONDS} s")
    assert int(executed[1]) > 1000  # it ran, and not through its start alone


def test_the_corpus_is_what_its_script_writes(tmp_path: Path) -> None:
    sys.path.insert(0, str(Path(__file__).parent))
    try:
        import make_corpus
    finally:
        sys.path.pop(0)
    written = {name: steps for name, steps in make_corpus.entries().items()}
    kept = {
        path.name: path.read_bytes()[1:] for path in (Path(__file__).parent / "corpus").iterdir()
    }
    assert kept == written
