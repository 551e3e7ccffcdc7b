"""Builds dockcore and its harness for the Xtensa core that QEMU emulates."""

from __future__ import annotations

import fcntl
import hashlib
import json
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LIBRARY = ROOT / "firmware" / "lib" / "dockcore"
HARNESS = ROOT / "firmware" / "xtensa"
MAVLINK = ROOT / "build" / "mavlink" / "c"
WHOLE = ROOT / "firmware" / "lib" / "wholeimage"
GOLDEN = ROOT / "tests" / "firmware"
PIXELS = ROOT / "shared" / "vectors"
BUILD = ROOT / "build" / "xtensa"
PROGRAM = BUILD / "harness.elf"
CORE = BUILD / "dockcore.elf"

PREFIX = "xtensa-lx106-elf-"
COMPILER = f"{PREFIX}gcc"
SIZE = f"{PREFIX}size"
PACKAGES = {COMPILER: "gcc-xtensa-lx106", SIZE: "binutils-xtensa-lx106"}

# The linker drops what is not reached from these: the sizes are those of a dock.
ENTRY_POINTS = (
    "dock_init",
    "dock_set_board",
    "dock_set_camera",
    "dock_frame",
    "dock_receive",
    "dock_transmit",
    "dock_take_request",
    "dock_saved",
    "dock_led_duties",
    "settings_to_blob",
    "settings_from_blob",
)

BUILD_FLAGS = ["-Werror", "-ffunction-sections", "-fdata-sections", "-mtext-section-literals"]
# Or GCC would turn memcpy's loop into a call of memcpy.
RUNTIME_FLAGS = ["-fno-builtin", "-fno-tree-loop-distribute-patterns"]


class MissingError(Exception):
    """A program that is not installed, and how to install it, in one line."""


class XtensaError(Exception):
    """What went wrong, in one line or with the failed program's output."""


def require(packages: dict[str, str]) -> None:
    """Check that programs are installed.

    Raises:
        MissingError: one is not.
    """
    for program, package in packages.items():
        if shutil.which(program) is None:
            raise MissingError(f"{program} is missing: run `sudo apt-get install {package}`")


def run(command: Sequence[str | Path], timeout_s: float) -> str:
    """Run a command in the build folder and return what it prints.

    Raises:
        XtensaError: it fails or takes too long.
    """
    name = Path(command[0]).name
    try:
        done = subprocess.run(
            [str(part) for part in command],
            cwd=BUILD,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=timeout_s,
        )
    except subprocess.TimeoutExpired as error:
        raise XtensaError(f"{name}: not finished after {timeout_s:.0f} s") from error
    if done.returncode != 0:
        raise XtensaError(f"{name}: exit status {done.returncode}\n{done.stdout.strip()}")
    return done.stdout


def library_flags() -> list[str]:
    """Return the flags that dockcore is compiled with everywhere.

    Raises:
        XtensaError: library.json does not say how to optimise, so nothing measured would count.
    """
    manifest = LIBRARY / "library.json"
    try:
        flags = [str(flag) for flag in json.loads(manifest.read_text())["build"]["flags"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise XtensaError(f"{manifest.relative_to(ROOT)}: no build flags: {error!r}") from error
    if not any(flag.startswith("-O") for flag in flags):
        raise XtensaError(f"{manifest.relative_to(ROOT)}: build.flags has no -O option")
    return flags


def build() -> None:
    """Build the harness and dockcore alone, unless they are up to date.

    Raises:
        MissingError: the compiler is not installed.
        XtensaError: the sources do not compile.
    """
    require(PACKAGES)
    flags = library_flags()
    stamp = BUILD / "stamp"
    with locked(BUILD):
        run([sys.executable, ROOT / "shared" / "mavlink.py"], 60)
        mavlink = (MAVLINK / ".stamp").read_text()
        state = digest([*flags, mavlink, run([COMPILER, "--version"], 10)])
        if stamp.is_file() and stamp.read_text() == state:
            return
        stamp.unlink(missing_ok=True)
        compile_and_link(flags)
        stamp.write_text(state)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other processes from building in the same folder."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def digest(also: Sequence[str]) -> str:
    """Digest of everything that the programs are built from."""
    total = hashlib.sha256("\n".join(also).encode())
    golden = [GOLDEN / "golden.c", GOLDEN / "golden.h", PIXELS / "frames.bin"]
    for folder in (LIBRARY / "src", WHOLE / "src", HARNESS):
        golden += sorted(path for path in folder.rglob("*") if path.is_file())
    for path in [Path(__file__), *golden]:
        total.update(f"{path.relative_to(ROOT)}\0".encode() + path.read_bytes())
    return total.hexdigest()


def compile_and_link(library: Sequence[str]) -> None:
    """Compile everything, then link the harness, and dockcore by itself."""
    for old in BUILD.glob("*.o"):
        old.unlink()
    core = sorted((LIBRARY / "src").glob("*.c"))
    whole = sorted((WHOLE / "src").glob("*.c"))
    runtime = HARNESS / "runtime.c"
    harness = sorted({*HARNESS.glob("*.c"), *HARNESS.glob("*.S")} - {runtime})
    system = [f"-isystem{HARNESS / 'include'}", f"-isystem{MAVLINK}"]
    headers = [*system, f"-I{LIBRARY / 'src'}", f"-I{WHOLE / 'src'}", f"-I{GOLDEN}"]
    compiler = [COMPILER, *library, *BUILD_FLAGS, *headers, f"-Wa,-I{PIXELS}", "-c"]
    run([*compiler, *core, *whole, *harness, GOLDEN / "golden.c"], 120)
    run([*compiler, *RUNTIME_FLAGS, runtime], 60)

    linker = [COMPILER, "-nostdlib", "-Wl,--gc-sections"]
    objects = sorted(BUILD.glob("*.o"))
    run([*linker, "-T", HARNESS / "link.ld", *objects, "-lgcc", "-o", PROGRAM], 60)
    kept = [f"-Wl,--undefined={name}" for name in ENTRY_POINTS]
    # The board's libraries are left out; a call of address 0 reaches no further than this.
    outside = ["-Wl,--unresolved-symbols=ignore-all", "-Wl,-Ttext=0x1000"]
    outside.append(f"-Wl,--entry={ENTRY_POINTS[0]}")
    core_objects = [BUILD / f"{source.stem}.o" for source in core]
    run([*linker, *kept, *outside, *core_objects, "-o", CORE], 60)


def core_sizes() -> tuple[int, int]:
    """Bytes of dockcore alone: code with constants, and variables of its own.

    Neither the harness nor the C library's or libgcc's functions are counted.
    """
    text, data, bss = run([SIZE, CORE], 10).splitlines()[1].split()[:3]
    return int(text), int(data) + int(bss)
