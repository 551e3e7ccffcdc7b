"""The dock's firmware core, the very C that runs on the board, inside Python.

``Dock`` is the whole dock; ``decide`` gives every intermediate value of one frame;
``lib`` and ``ffi`` are the C functions themselves for anything else.
"""

from __future__ import annotations

from chromadock_firmware._dockcore import ffi, lib
from chromadock_firmware.dock import Dock, Settings
from chromadock_firmware.stages import Decision, decide, hsv_from_rgb

__all__ = ["Decision", "Dock", "Settings", "decide", "ffi", "hsv_from_rgb", "lib"]
