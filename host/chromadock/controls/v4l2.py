"""The controls of a camera of this computer, by the kernel's ioctl.

OpenCV's properties hide what a driver refused, and their scale depends on its back end.  Requests
and structures are those of Linux's ``videodev2.h``, as they are on x86 and ARM; V4L2 lets a device
be opened a second time beside the program that takes its pictures.
"""

from __future__ import annotations

import errno
import fcntl
import os
import struct

from chromadock.controls.base import Control, Controls, ControlsAwayError, RefusedError, Table
from chromadock.controls.features import NUMBERS

_CONTROL = struct.Struct("=Ii")
"""``v4l2_control``: number, value."""

_QUERY = struct.Struct("=II32s4iI8x")
"""``v4l2_queryctrl``: number, type, name, minimum, maximum, step, default, flags."""

_MENU = struct.Struct("=II32s4x")
"""``v4l2_querymenu``: number, index, name."""


def _request(number: int, structure: struct.Struct) -> int:
    """The kernel's ``_IOWR('V', number, structure)``."""
    return 3 << 30 | structure.size << 16 | ord("V") << 8 | number


_GET = _request(27, _CONTROL)
_SET = _request(28, _CONTROL)
_QUERY_CONTROL = _request(36, _QUERY)
_QUERY_MENU = _request(37, _MENU)

_INTEGER, _BOOLEAN, _MENU_TYPE, _INTEGER_MENU = 1, 2, 3, 9
_DISABLED, _READ_ONLY = 0x0001, 0x0004

_GONE = (errno.ENODEV, errno.ENXIO, errno.EBADF)
"""What a call on a device that was unplugged says."""


class V4l2(Controls):
    """The controls behind a device file.

    Raises
    ------
    ControlsAwayError
        Where it cannot be opened.
    """

    keeps = "the driver"

    def __init__(self, path: str) -> None:
        self._path = path
        try:
            self._file = os.open(path, os.O_RDWR | os.O_NONBLOCK | os.O_CLOEXEC)
        except OSError as error:
            raise self._away(error) from None

    def read(self) -> Table:
        """See ``Controls``."""
        found = ((number, self._control(number)) for number in sorted(NUMBERS))
        return {number: control for number, control in found if control is not None}

    def write(self, number: int, value: int) -> None:
        """See ``Controls``."""
        try:
            self._call(_SET, _CONTROL, number, value)
        except OSError as error:
            raise RefusedError(error.strerror) from None

    def close(self) -> None:
        """Let go of the device."""
        os.close(self._file)

    def _control(self, number: int) -> Control | None:
        """A control as it is now; None where this camera has none of that number to set."""
        try:
            _, kind, _, low, high, step, _, flags = self._call(
                _QUERY_CONTROL, _QUERY, number, 0, b"", 0, 0, 0, 0, 0
            )
        except OSError:
            return None
        usable = kind in (_INTEGER, _BOOLEAN, _MENU_TYPE, _INTEGER_MENU)
        if not usable or flags & (_DISABLED | _READ_ONLY):
            return None
        choices: frozenset[int] = frozenset()
        if kind == _BOOLEAN:
            choices = frozenset((0, 1))
        elif kind != _INTEGER:
            choices = frozenset(i for i in range(low, high + 1) if self._has_entry(number, i))
        return Control(self._value(number), low, high, step, choices)

    def _value(self, number: int) -> int | None:
        try:
            return int(self._call(_GET, _CONTROL, number, 0)[1])
        except OSError:
            return None

    def _has_entry(self, number: int, index: int) -> bool:
        """Whether a menu has an entry; there are gaps."""
        try:
            self._call(_QUERY_MENU, _MENU, number, index, b"")
        except OSError:
            return False
        return True

    def _call(self, request: int, structure: struct.Struct, *fields: int | bytes) -> tuple:  # type: ignore[type-arg]
        """One ioctl: the fields of the structure that the kernel gives back.

        Raises
        ------
        OSError
            What the driver said.
        ControlsAwayError
            Where the camera was unplugged.
        """
        content = bytearray(structure.pack(*fields))
        try:
            fcntl.ioctl(self._file, request, content)
        except OSError as error:
            if error.errno in _GONE:
                raise self._away(error) from None
            raise
        return structure.unpack(content)

    def _away(self, error: OSError) -> ControlsAwayError:
        return ControlsAwayError(
            f"{self._path}: its controls cannot be reached ({error.strerror}): check that it is "
            "plugged in, and `ls -l` that you may write to it"
        )
