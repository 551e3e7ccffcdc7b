"""Compiles host/native into ``chromadock._native``.

The declarations that cffi needs are the headers themselves, run through the C preprocessor:
nothing is declared twice.  A macro that stands for a number can be read from Python, too.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
from pathlib import Path

from cffi import FFI

HERE = Path(__file__).resolve().parent
NATIVE = HERE / "native"
# What is in folders of NATIVE is for its own sources alone.
HEADERS = sorted(NATIVE.glob("*.h"))
INTEGER, NUMBER = "#define {} ...", "static const double {};"


def declarations() -> str:
    """What the headers declare themselves, and their numbers."""
    kept = []
    own = False
    for header in HEADERS:
        for line in preprocessed(header).splitlines():
            marker = re.match(r'#\s+\d+\s+"([^"]*)"', line)
            macro = re.match(r"#define (\w+) (.*\d.*)", line)
            if marker:
                # What another header declares is taken from that one.
                own = Path(marker.group(1)) == header
            elif own and macro:
                real = re.search(r"\d\.\d|\b\d+e[-+]?\d", macro.group(2))
                kept.append((NUMBER if real else INTEGER).format(macro.group(1)))
            elif own and not line.startswith("#"):
                kept.append(line)
    return "\n".join(kept)


def preprocessed(header: Path) -> str:
    """Text of a header with macros expanded and their definitions kept."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    command = [*compiler, "-std=c11", "-E", "-dD", str(header)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


ffi = FFI()
ffi.cdef(declarations())
ffi.set_source(
    "chromadock._native",
    "".join(f'#include "{header.name}"\n' for header in HEADERS),
    # Relative to setup.py's folder, as setuptools wants it.
    sources=[os.path.relpath(path, HERE) for path in sorted(NATIVE.glob("*.c"))],
    depends=[os.path.relpath(header, HERE) for header in sorted(NATIVE.rglob("*.h"))],
    include_dirs=[str(NATIVE)],
    # Loops over cells become vector instructions of any processor of the kind.  Nothing asks
    # for errno, for floating-point exceptions or for integers that wrap around, which would
    # prevent it.  And no other library may put functions of its own in these ones' place, so that
    # they call each other directly.
    extra_compile_args=[
        "-std=c11",
        "-O3",
        "-fno-math-errno",
        "-fno-trapping-math",
        "-fno-wrapv",
        "-fvisibility=hidden",
    ],
)
