"""Compiles host/native into ``chromadock._native``.

The headers themselves, less their preprocessor's lines, are the declarations: nothing is
declared twice.
"""

from __future__ import annotations

import os
from pathlib import Path

from cffi import FFI

HERE = Path(__file__).resolve().parent
NATIVE = HERE / "native"
HEADERS = sorted(NATIVE.glob("*.h"))


def declarations() -> str:
    """All headers' own lines."""
    lines = (line for header in HEADERS for line in header.read_text("utf-8").splitlines())
    return "\n".join(line for line in lines if not line.startswith("#"))


ffi = FFI()
ffi.cdef(declarations())
ffi.set_source(
    "chromadock._native",
    "".join(f'#include "{header.name}"\n' for header in HEADERS),
    # Relative to setup.py's folder, as setuptools wants it.
    sources=[os.path.relpath(path, HERE) for path in sorted(NATIVE.glob("*.c"))],
    include_dirs=[str(NATIVE)],
    extra_compile_args=["-std=c11", "-O2"],
    libraries=["m"] if os.name == "posix" else [],
)

if __name__ == "__main__":
    os.chdir(HERE)
    ffi.compile(verbose=True)
