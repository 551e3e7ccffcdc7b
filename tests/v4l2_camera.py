"""Cameras of a kernel that is not there: ``tests/v4l2``, preloaded into the program under test."""

from __future__ import annotations

import mmap
import os
import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

SOURCES = Path(__file__).resolve().parent / "v4l2"
HEADER = Path("/usr/include/linux/videodev2.h")

INTEGER, BOOLEAN, MENU = 1, 2, 3
NONE, IGNORES, BUSY, COARSE, UNREADABLE, FORGETS = range(6)
"""What is wrong with a control, as in ``camera.h``."""

# As Linux's v4l2-controls.h numbers them.
GAIN, WHITE_BALANCE_AUTO, WHITE_BALANCE = 0x00980913, 0x0098090C, 0x0098091A
EXPOSURE_AUTO, EXPOSURE, EXPOSURE_PRIORITY = 0x009A0901, 0x009A0902, 0x009A0903
FOCUS, FOCUS_AUTO = 0x009A090A, 0x009A090C
MANUAL, APERTURE_PRIORITY = 1, 3

_HEAD = struct.Struct("=II")
_CONTROL = struct.Struct("=IIiiiiiIII")
_CONTROLS = 16


@dataclass
class Knob:
    """A control as ``camera.h`` has it."""

    number: int
    kind: int
    low: int
    high: int
    initial: int
    step: int = 1
    menu: int = 0
    automatic: int = 0
    fault: int = NONE


def usual(**faults: int) -> list[Knob]:
    """A UVC camera that has not been set, with everything automatic; by name what is wrong."""
    f = faults.get
    return [
        Knob(GAIN, INTEGER, 0, 100, 0, fault=f("gain", NONE)),
        Knob(WHITE_BALANCE_AUTO, BOOLEAN, 0, 1, 1, fault=f("white_balance_auto", NONE)),
        Knob(
            WHITE_BALANCE, INTEGER, 2800, 6500, 4600, 10, automatic=WHITE_BALANCE_AUTO,
            fault=f("white_balance", NONE),
        ),
        Knob(
            EXPOSURE_AUTO, MENU, 0, 3, APERTURE_PRIORITY, menu=0b1010,
            fault=f("exposure_auto", NONE),
        ),
        Knob(
            EXPOSURE, INTEGER, 1, 5000, 156, automatic=EXPOSURE_AUTO, fault=f("exposure", NONE)
        ),
        Knob(EXPOSURE_PRIORITY, BOOLEAN, 0, 1, 1, fault=f("exposure_priority", NONE)),
        Knob(FOCUS, INTEGER, 0, 250, 30, 5, automatic=FOCUS_AUTO, fault=f("focus", NONE)),
        Knob(FOCUS_AUTO, BOOLEAN, 0, 1, 1, fault=f("focus_auto", NONE)),
    ]  # fmt: skip


class Camera:
    """One that is plugged in as ``videoN`` of a folder, its state shared with whoever opens it."""

    def __init__(self, folder: Path, index: int, knobs: list[Knob] | None = None) -> None:
        self._knobs = usual() if knobs is None else knobs
        self.path = folder / f"video{index}"
        self._state = folder / f"video{index}.state"
        packed = [
            _CONTROL.pack(
                k.number, k.kind, k.low, k.high, k.step, k.initial, k.initial, k.menu, k.automatic,
                k.fault,
            )
            for k in self._knobs
        ]  # fmt: skip
        packed += [bytes(_CONTROL.size)] * (_CONTROLS - len(packed))
        self._state.write_bytes(_HEAD.pack(0, 0) + b"".join(packed))
        with self._state.open("r+b") as file:
            self._map = mmap.mmap(file.fileno(), 0)
        self.path.symlink_to("/dev/null")  # a character device, as cameras are

    def unplug(self) -> None:
        """Programs that have it open hear of it at their next call."""
        self._map[:4] = struct.pack("=I", 1)
        self.path.unlink()
        self._state.unlink()

    @property
    def pictures(self) -> int:
        """How many were taken so far."""
        return int(_HEAD.unpack_from(self._map)[1])

    def __getitem__(self, number: int) -> int:
        return int(_CONTROL.unpack_from(self._map, self._place(number))[6])

    def __setitem__(self, number: int, value: int) -> None:
        struct.pack_into("=i", self._map, self._place(number) + 24, value)

    def _place(self, number: int) -> int:
        index = next(i for i, knob in enumerate(self._knobs) if knob.number == number)
        return _HEAD.size + index * _CONTROL.size


def compiled(folder: Path) -> Path:
    """The library to preload."""
    library = folder / "kernel.so"
    flags = ["-shared", "-fPIC", "-O1", "-Wall", "-Wextra", "-Werror"]
    sources = sorted(SOURCES.glob("*.c"))
    subprocess.run(["gcc", *flags, "-o", library, *sources, "-ldl"], check=True)
    return library


def started(library: Path, folder: Path, *arguments: object) -> subprocess.Popen[str]:
    """Python with these arguments, to which the cameras of the folder are there."""
    around = {**os.environ, "LD_PRELOAD": str(library), "CHROMADOCK_TEST_CAMERAS": str(folder)}
    return subprocess.Popen(
        [sys.executable, *map(str, arguments)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=around,
    )  # fmt: skip
