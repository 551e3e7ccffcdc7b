"""Programs that come from Debian or Ubuntu packages."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Sequence
from pathlib import Path

from commands import run
from report import SetupError, Unavailable, step

PYTHON = f"python{sys.version_info.major}.{sys.version_info.minor}"

# Package -> the program by which its presence is known.
TEST_PACKAGES = {
    "gcc-xtensa-lx106": "xtensa-lx106-elf-gcc",
    "qemu-system-misc": "qemu-system-xtensa",
    "clang": "clang",
    "cppcheck": "cppcheck",
    "chromium": "chromium",
    "chromium-driver": "chromedriver",
}

# A real RTSP server for tests/host/test_streams.py, which looks for it in the same way.
STREAMER_PACKAGES = [
    "gir1.2-gst-rtsp-server-1.0",
    "python3-gst-1.0",
    "gstreamer1.0-plugins-base",
    "gstreamer1.0-plugins-good",
    "gstreamer1.0-plugins-ugly",
]
SYSTEM_PYTHON = "/usr/bin/python3"
STREAMER_PROBE = """
import gi
gi.require_version("GstRtspServer", "1.0")
from gi.repository import Gst, GstRtspServer
Gst.init(None)
assert Gst.ElementFactory.find("x264enc") and Gst.ElementFactory.find("rtph264pay")
"""


def require_python_and_compiler() -> None:
    """Check what nothing works without, and install what apt-get can.

    Raises:
        SetupError: something is missing and cannot be installed from here.
    """
    if sys.version_info < (3, 10):  # noqa: UP036 - this is run by any Python
        raise SetupError(
            f"Python {sys.version.split()[0]} is too old: give a newer one, "
            "for example `make PYTHON=python3.12 test`"
        )
    missing = [(what, packages) for what, packages, present in NECESSARY if not present()]
    if missing and why_not_install() is None:
        packages = [name for _, names in missing for name in names]
        with step(f"Debian packages: {' '.join(packages)}"):
            install(packages)
    elif missing:
        names = " ".join(name for _, names in missing for name in names)
        whats = ", ".join(what for what, _ in missing)
        raise SetupError(f"not here: {whats}; run `sudo apt-get install {names}`")


def has_venv() -> bool:
    """Tell whether virtual environments with pip can be made."""
    return importlib.util.find_spec("venv") is not None and (
        importlib.util.find_spec("ensurepip") is not None
    )


def has_headers() -> bool:
    """Tell whether Python extensions can be compiled."""
    return Path(sysconfig.get_path("include"), "Python.h").is_file()


def has_compiler() -> bool:
    """Tell whether there is a C compiler."""
    return any(shutil.which(name) for name in (os.environ.get("CC", "cc"), "gcc"))


# What nothing works without, and how its presence is known.
NECESSARY: tuple[tuple[str, list[str], Callable[[], bool]], ...] = (
    ("Python's venv module", [f"{PYTHON}-venv"], has_venv),
    ("Python's C headers", [f"{PYTHON}-dev"], has_headers),
    ("a C compiler", ["gcc", "libc6-dev"], has_compiler),
)


def install_test_packages(unavailable: Unavailable) -> None:
    """Install what compilers, emulator, checkers, browser and fuzzer are not there."""
    install_together()
    install_programs(unavailable)
    if shutil.which("clang"):
        install_fuzzer(unavailable)
    install_streamer(unavailable)


def install_together() -> None:
    """Install all that is missing at once, which is quicker than one after the other.

    What cannot be had fails them all.  Then each is installed by itself, and named.
    """
    packages = missing_programs() + ([] if has_streamer() else STREAMER_PACKAGES)
    if not packages or why_not_install() is not None:
        return
    with contextlib.suppress(SetupError), step(f"Debian packages: {' '.join(packages)}"):
        install(packages)


def missing_programs() -> list[str]:
    """List the packages whose program is not there."""
    return [name for name, program in TEST_PACKAGES.items() if not shutil.which(program)]


def install_streamer(unavailable: Unavailable) -> None:
    """Install what a real RTSP server is made of, in the tests of streams."""
    if has_streamer():
        return
    hindrance = why_not_install()
    if hindrance is not None:
        names = " ".join(STREAMER_PACKAGES)
        unavailable.add("RTSP server", f"no GStreamer here, and {hindrance.format(names)}")
        return
    try:
        with step(f"Debian packages: {' '.join(STREAMER_PACKAGES)}"):
            install(STREAMER_PACKAGES)
            if not has_streamer():
                raise SetupError("they do not serve RTSP here")
    except SetupError as error:
        unavailable.add("RTSP server", str(error))


def has_streamer() -> bool:
    """Tell whether the system's Python, whose bindings Debian has, can serve RTSP."""
    if not Path(SYSTEM_PYTHON).exists():
        return False
    probe = subprocess.run([SYSTEM_PYTHON, "-c", STREAMER_PROBE], capture_output=True)
    return probe.returncode == 0


def install_fuzzer(unavailable: Unavailable) -> None:
    """Install what clang fuzzes with, which is a package for each of its versions."""
    if has_fuzzer():
        return
    package = f"libclang-rt-{clang_resources().name.split('.')[0]}-dev"
    hindrance = why_not_install()
    if hindrance is not None:
        unavailable.add("libFuzzer", f"clang has none, and {hindrance.format(package)}")
        return
    try:
        with step(f"Debian package: {package}"):
            install([package])
            if not has_fuzzer():
                raise SetupError("it does not contain libFuzzer here")
    except SetupError as error:
        unavailable.add("libFuzzer", str(error))


def has_fuzzer() -> bool:
    """Tell whether clang can link a fuzzing program."""
    return any(clang_resources().rglob("libclang_rt.fuzzer*.a"))


def clang_resources() -> Path:
    """Return the folder of clang's own libraries, which is named after its version."""
    command = ["clang", "-print-resource-dir"]
    return Path(subprocess.run(command, capture_output=True, text=True).stdout.strip())


def install_programs(unavailable: Unavailable) -> None:
    """Install the packages that are known by a program."""
    missing = missing_programs()
    if not missing:
        return
    hindrance = why_not_install()
    if hindrance is not None:
        for name in missing:
            program = TEST_PACKAGES[name]
            unavailable.add(name, f"no {program} here, and {hindrance.format(name)}")
        return
    for name in missing:
        try:
            with step(f"Debian package: {name}"):
                install([name])
            if not shutil.which(TEST_PACKAGES[name]):
                raise SetupError(f"it does not contain {TEST_PACKAGES[name]} here")
        except SetupError as error:
            unavailable.add(name, str(error))


def why_not_install() -> str | None:
    """Say what keeps us from installing a Debian package {}, if anything does."""
    if not shutil.which("apt-get"):
        return "no apt-get to install {}"
    if os.geteuid() != 0:
        return "only root can install it: sudo apt-get install {}"
    return None


def install(packages: Sequence[str]) -> None:
    """Install packages; the package lists are only fetched if it fails without."""
    command = ["apt-get", "install", "-y", "-q", "--no-install-recommends", *packages]
    quiet = {"DEBIAN_FRONTEND": "noninteractive"}
    try:
        run(command, "apt-get install", environment=quiet)
    except SetupError:
        run(["apt-get", "update", "-q"], "apt-get update", environment=quiet)
        run(command, "apt-get install", environment=quiet)
