"""What the results depend on besides the experiment: the code."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterator
from functools import lru_cache
from importlib import metadata
from pathlib import Path

import chromadock
import chromadock_firmware

_PACKAGES = ("colour", "geometry", "link", "paper", "results", "robust", "sim", "track")
_MODULES = (
    *("filters", "finders", "measure", "picture", "plan", "runs", "target"),
    *("tuned", "tuning", "tuning_frames", "view", "work"),
)
"""Of this package; the others tell and draw what these came to."""

_LIBRARIES = ("numpy", "opencv-python-headless", "jerlov")


def versions() -> dict[str, str]:
    """What computes the results, by name; empty where a library has another name here."""
    return {
        "chromadock": _version("chromadock"),
        "code": code_digest(),
        "Python": platform.python_version(),
        **{library: _version(library) for library in _LIBRARIES},
    }


@lru_cache(maxsize=1)
def code_digest() -> str:
    """Digest of the sources and data, the compiled C and the libraries behind a row."""
    total = hashlib.sha256()
    for file in _files():
        total.update(file.name.encode() + b"\0" + file.read_bytes())
    total.update("".join(_version(library) for library in _LIBRARIES).encode())
    return total.hexdigest()[:16]


def _files() -> Iterator[Path]:
    package, firmware = (Path(m.__file__ or "").parent for m in (chromadock, chromadock_firmware))
    for name in _PACKAGES:
        yield from sorted((package / name).rglob("*.py"))
        yield from sorted((package / name).rglob("*.toml"))
    yield from (package / "evaluate" / f"{name}.py" for name in _MODULES)
    yield from sorted(package.glob("*.py"))
    yield from sorted(package.glob("*.toml"))
    yield from sorted(package.glob("_native.*.so"))
    yield from sorted(firmware.glob("*.py"))
    yield from sorted(firmware.glob("*.so"))


def _version(library: str) -> str:
    try:
        return metadata.version(library)
    except metadata.PackageNotFoundError:  # OpenCV has several names
        return ""
