"""The checks of the source code: .venv/bin/python tools/lint.py.

Each counts as one test.
"""

from __future__ import annotations

import itertools
import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from step import ROOT, Outcome, missing, show_step

# The programs that pip installed beside this Python.
BIN = Path(sys.executable).parent
C_FOLDERS = ("firmware", "host/native", "tests/firmware", "tests/fuzz", "tests/shell", "tests/v4l2")
C_SUFFIXES = (".c", ".h", ".cpp")
DOCKCORE = ROOT / "firmware" / "lib" / "dockcore"
NATIVE = ROOT / "host" / "native"
SHELL = ROOT / "firmware" / "esp32cam"
VENDOR = ROOT / "tests" / "shell" / "vendor"
MAVLINK = ROOT / "build" / "mavlink" / "c"
CPPCHECK_CACHE = ROOT / "build" / "cppcheck"


def handwritten_c_files() -> list[str]:
    """List C and C++ sources and headers, less the generated ones, which say so at their top."""
    files = (file for folder in C_FOLDERS for file in (ROOT / folder).rglob("*"))
    return sorted(
        str(file.relative_to(ROOT))
        for file in files
        if file.suffix in C_SUFFIXES
        and "build" not in file.parts[len(ROOT.parts) :]
        and not is_generated(file)
    )


def is_generated(file: Path) -> bool:
    """Tell whether a file is written by a program."""
    with file.open(errors="replace") as text:
        return "do not edit" in text.readline().lower()


def check(*command: str | Path) -> Outcome:
    """Run one check; it passes if it exits with 0."""
    done = subprocess.run(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if done.returncode == 0:
        return Outcome(passed=1)
    return Outcome(failed=1, output=done.stdout)


def contract() -> Outcome:
    """Check that the generated tables are what shared/method.toml says."""
    return check(sys.executable, "shared/generate.py", "--check")


def mavlink() -> Outcome:
    """Write the headers that the C checks after it include."""
    return check(sys.executable, "shared/mavlink.py")


def ruff_check() -> Outcome:
    """Check the Python sources."""
    return check(BIN / "ruff", "check", "--output-format=concise", ".")


def ruff_format() -> Outcome:
    """Check the format of the Python sources."""
    return check(BIN / "ruff", "format", "--check", "--output-format=concise", ".")


def mypy() -> Outcome:
    """Check the types of the host package."""
    return check(BIN / "mypy", "--strict", "host/chromadock")


def clang_format() -> Outcome:
    """Check the format of the C sources."""
    outcome = check(BIN / "clang-format", "--dry-run", "--Werror", *handwritten_c_files())
    # The first place in each file; `make format` mends them all anyway.
    places = [line for line in outcome.output.splitlines() if ": error:" in line]
    firsts = {place.split(":")[0]: place for place in reversed(places)}
    outcome.output = "\n".join(reversed(firsts.values()))
    return outcome


def cppcheck() -> Outcome:
    """Look for faults in the C sources."""
    reason = missing("cppcheck")
    if reason is not None:
        return Outcome(skips=[("cppcheck", reason)])
    CPPCHECK_CACHE.mkdir(parents=True, exist_ok=True)
    # It takes a header for C: those in C++ are checked where they are included.
    cpp_headers = (str(SHELL.relative_to(ROOT)), "tests/shell")
    files = [
        file
        for file in handwritten_c_files()
        if not (file.endswith(".h") and file.startswith(cpp_headers))
    ]
    return check(
        "cppcheck",
        "--quiet",
        "--std=c11",
        "--std=c++11",
        "--enable=warning,performance,portability",
        "--inline-suppr",
        "--suppress=missingIncludeSystem",
        # Those of ESP-IDF 4 and of 5, which no program has both of.
        f"--suppress=ctuOneDefinitionRuleViolation:{VENDOR.relative_to(ROOT)}/*",
        "--error-exitcode=1",
        f"--cppcheck-build-dir={CPPCHECK_CACHE.relative_to(ROOT)}",
        "-j2",
        "-Ifirmware/lib/dockcore/src",
        "-Ifirmware/lib/wholeimage/src",
        f"-I{VENDOR.relative_to(ROOT)}",
        *files,
    )


def compiles_with(compiler: str) -> Outcome:
    """Compile dockcore and the host's C with dockcore's flags; a warning fails (a user's build
    only prints it)."""
    reason = missing(compiler)
    if reason is not None:
        return Outcome(skips=[(f"{compiler} -Werror", reason)])
    manifest = json.loads((DOCKCORE / "library.json").read_text())
    flags = [*manifest["build"]["flags"], "-Werror", "-isystem", MAVLINK]
    total = Outcome(passed=1)
    with tempfile.TemporaryDirectory() as scratch:
        for source in [*sorted((DOCKCORE / "src").glob("*.c")), *sorted(NATIVE.glob("*.c"))]:
            target = Path(scratch) / f"{source.stem}.o"
            one = check(compiler, *flags, "-c", source, "-o", target)
            if one.failed:
                total = Outcome(failed=1, output=total.output + one.output)
    return total


def gcc() -> Outcome:
    """Compile the C for this computer with gcc."""
    return compiles_with("gcc")


def clang() -> Outcome:
    """Compile the C for this computer with clang."""
    return compiles_with("clang")


def shell_compiles() -> Outcome:
    """Compile the ESP32-CAM's shell as both Arduino cores do, against declarations of theirs.

    True compilers for the board are PlatformIO's; what is tested here needs none.
    """
    compilers = [name for name in ("g++", "clang++") if shutil.which(name)]
    if not compilers:
        return Outcome(skips=[("shell -Werror", "no C++ compiler")])
    flags = ["-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-fno-exceptions", "-fno-rtti"]
    folders = ["-isystem", VENDOR, "-I", DOCKCORE / "src"]
    sources = sorted(SHELL.glob("*.cpp"))
    total = Outcome(passed=1)
    for compiler, standard, idf in itertools.product(compilers, ("gnu++11", "gnu++17"), (4, 5)):
        versions = [f"-std={standard}", f"-DESP_IDF_VERSION_MAJOR={idf}"]
        one = check(compiler, *versions, *flags, *folders, *sources)
        if one.failed:
            title = f"{compiler} {' '.join(versions)}:\n"
            total = Outcome(failed=1, output=total.output + title + one.output)
    return total


LINTS: Sequence[tuple[str, Callable[[], Outcome]]] = (
    ("contract", contract),
    ("mavlink", mavlink),
    ("ruff check", ruff_check),
    ("ruff format", ruff_format),
    ("mypy --strict", mypy),
    ("clang-format", clang_format),
    ("cppcheck", cppcheck),
    ("gcc -Werror", gcc),
    ("clang -Werror", clang),
    ("shell -Werror", shell_compiles),
)


def main() -> int:
    """Run all checks and return the exit status."""
    total = Outcome()
    for name, step in LINTS:
        total.add(show_step(name, step))
    for name, reason in total.skips:
        print(f"skipped: {name}: {reason}")
    return 1 if total.failed else 0


if __name__ == "__main__":
    sys.exit(main())
