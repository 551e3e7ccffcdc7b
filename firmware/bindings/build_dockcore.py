"""Compiles firmware/lib/dockcore, as it is, into ``chromadock_firmware._dockcore``.

The declarations that cffi needs are the headers themselves, run through the C
preprocessor: nothing is declared twice.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from cffi import FFI

HERE = Path(__file__).resolve().parent
DOCKCORE = HERE.parent / "lib" / "dockcore" / "src"
WHOLE_IMAGE = HERE.parent / "lib" / "wholeimage" / "src"
SHARED = HERE.parents[1] / "shared"

sys.path.insert(0, str(SHARED))
import mavlink  # noqa: E402 - found by the line above


def declarations() -> str:
    """dockcore.h preprocessed: dockcore's own lines and numbers, no function bodies."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    headers = (
        DOCKCORE / "dockcore.h",
        WHOLE_IMAGE / "whole_image.h",
        HERE / "hsv_convert.h",
    )
    kept, own = [], False
    for header in headers:
        text = subprocess.run(
            [*compiler, "-std=c11", "-E", "-dD", f"-I{DOCKCORE}", str(header)],
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for line in text.splitlines():
            marker = re.match(r'#\s+\d+\s+"([^"]*)"', line)
            if marker:
                own = marker.group(1).startswith(f"{header.parent}/")
            elif own and line.strip():
                kept.append(re.sub(r"^#define (\w+) +[^,]+$", r"#define \1 ...", line))
    kept = [k for k in kept if not k.startswith("#") or k.endswith(" ...")]
    # Inline functions are compiled into their callers, Python cannot call them.
    return re.sub(r"static inline[^{]*\{.*?\n\}", "", "\n".join(kept), flags=re.DOTALL)


# For the link's sources alone: no declaration in dockcore.h needs them.
try:
    mavlink.generate_c()
except mavlink.MavlinkError as error:
    sys.exit(f"error: {error}")

ffi = FFI()
ffi.cdef(declarations())
ffi.set_source(
    "chromadock_firmware._dockcore",
    '#include "dockcore.h"\n#include "whole_image.h"\n#include "hsv_convert.h"\n',
    # Relative to setup.py's folder, as setuptools wants it.
    sources=[
        os.path.relpath(path, HERE)
        for path in [
            *sorted(DOCKCORE.glob("*.c")),
            WHOLE_IMAGE / "whole_image.c",
            HERE / "hsv_convert.c",
        ]
    ],
    include_dirs=[str(DOCKCORE), str(WHOLE_IMAGE), str(HERE)],
    extra_compile_args=["-std=c11", "-O2", "-isystem", str(mavlink.C_HEADERS)],
)

if __name__ == "__main__":
    ffi.compile(verbose=True)
