"""Runs the experiments and writes docs/results.md: `make results`.

Nothing in the document is written by hand: figures and tables come from the frames of the
run, the words about them, with the explanations, from results.md.jinja beside this file.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path

from results_approach import run_approaches
from results_document import Run, document, figures

from chromadock.errors import ChromadockError
from chromadock.evaluate.drawings import Drawing
from chromadock.evaluate.store import write_whole

ROOT = Path(__file__).resolve().parents[1]
EXPERIMENTS = ROOT / "experiments"
OUT = ROOT / "out" / "results"
DOCS = ROOT / "docs"


def write(docs: Path, text: str, shown: Mapping[str, Drawing]) -> Path:
    """Write ``results.md`` and ``images/results-*.svg`` below ``docs``; remove older figures.

    Raises:
        ChromadockError: it cannot be written.
    """
    wanted = {docs / "images" / f"results-{name}.svg": each.svg for name, each in shown.items()}
    for path, svg in wanted.items():
        write_whole(path, svg.encode())
    for path in (docs / "images").glob("results-*.svg"):
        if path not in wanted:
            path.unlink()
    path = docs / "results.md"
    write_whole(path, text.encode())
    return path


def main() -> int:
    """Run, write, and return the exit status."""
    start = time.monotonic()
    experiments = sorted(EXPERIMENTS.glob("*.toml"))
    evaluate: list[str | Path] = [sys.executable, "-m", "chromadock", "evaluate"]
    status = subprocess.run([*evaluate, *experiments, "--out", OUT], cwd=ROOT).returncode
    if status:
        return status
    try:
        run = Run.read(OUT)
        run_approaches(OUT)
        shown = figures(run)
        path = write(DOCS, document(run, shown), shown)
    except ChromadockError as error:
        print(f"results: error: {error}", file=sys.stderr)
        return 2
    minutes = (time.monotonic() - start) / 60
    print(f"wrote {path.relative_to(ROOT)} and its figures, {minutes:.1f} min")
    return 0


if __name__ == "__main__":
    sys.exit(main())
