"""The link's receiver under libFuzzer: .venv/bin/python tools/fuzz.py [--seconds N] [--seed N].

It starts from tests/fuzz/corpus and keeps what it learns in build/fuzz/corpus.

Exit status: 0 nothing found, 1 a finding, 2 it could not be built, 3 clang or its runtime for
fuzzing is not installed.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from step import ROOT

FUZZ = ROOT / "build" / "fuzz"
PROGRAM = FUZZ / "fuzz_receive"
HARNESS = ROOT / "tests" / "fuzz"
SEEDS = HARNESS / "corpus"
CORE = ROOT / "firmware" / "lib" / "dockcore" / "src"
MAVLINK = ROOT / "build" / "mavlink" / "c"
NOTHING_FOUND, FOUND, NOT_BUILT, MISSING = range(4)

FLAGS = ["-std=c11", "-g", "-O2", "-fno-omit-frame-pointer", "-Wall", "-Wextra", "-Werror"]
# Loops over pixels: sanitized, but not watched for new paths, which would take most of the time.
PIXELS = ("background", "hsv", "qqvga", "smooth", "working_image")
LIMITS = ["-max_len=2048", "-timeout=10", "-rss_limit_mb=1024"]


def what_is_missing() -> str | None:
    """Say why there can be no fuzzing here, in one line."""
    if not shutil.which("clang"):
        return "clang is not installed (Debian: clang)"
    command = ["clang", "-print-resource-dir"]
    resources = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    if not any(Path(resources).rglob("libclang_rt.fuzzer*.a")):
        version = Path(resources).name.split(".")[0]
        return f"clang has no libFuzzer (Debian: libclang-rt-{version}-dev)"
    return None


def build() -> str | None:
    """Compile harness and core together; return the compiler's output if it fails."""
    FUZZ.mkdir(parents=True, exist_ok=True)
    headers = subprocess.run(
        [sys.executable, ROOT / "shared" / "mavlink.py"], capture_output=True, text=True
    )
    if headers.returncode != 0:
        return headers.stdout + headers.stderr
    # Under names of its own first: another run may be at work with the program.
    with tempfile.TemporaryDirectory(dir=FUZZ) as scratch:
        new = Path(scratch) / PROGRAM.name
        pixels = [CORE / f"{name}.c" for name in PIXELS]
        others = [file for file in sorted(CORE.glob("*.c")) if file not in pixels]
        failure = compile_c([*pixels, "-c"], "address,undefined", Path(scratch))
        objects = sorted(Path(scratch).glob("*.o"))
        program = [*sorted(HARNESS.glob("*.c")), *others, *objects, "-o", new]
        failure = failure or compile_c(program, "fuzzer,address,undefined", Path(scratch))
        if failure is None:
            new.replace(PROGRAM)
    return failure


def compile_c(arguments: Sequence[str | Path], sanitizers: str, folder: Path) -> str | None:
    """Run clang in a folder; return its output if it fails."""
    sanitize = [f"-fsanitize={sanitizers}", "-fno-sanitize-recover=all"]
    includes = ["-isystem", MAVLINK, f"-I{CORE}"]
    done = subprocess.run(
        ["clang", *FLAGS, *sanitize, *includes, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    return None if done.returncode == 0 else done.stderr


def main() -> int:
    """Build, run, and return the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split(":")[0])
    parser.add_argument("--seconds", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0, help="0: another one each time")
    options = parser.parse_args()
    reason = what_is_missing()
    if reason is not None:
        print(reason, file=sys.stderr)
        return MISSING
    failure = build()
    if failure is not None:
        print(failure, file=sys.stderr)
        return NOT_BUILT
    learned = FUZZ / "corpus"
    learned.mkdir(exist_ok=True)
    command: list[str | Path] = [PROGRAM, learned, SEEDS, *LIMITS, f"-seed={options.seed}"]
    command += [f"-max_total_time={options.seconds}", "-print_final_stats=1", "-verbosity=1"]
    done = subprocess.run([*command, f"-artifact_prefix={FUZZ}/"], cwd=ROOT)
    return NOTHING_FOUND if done.returncode == 0 else FOUND


if __name__ == "__main__":
    sys.exit(main())
