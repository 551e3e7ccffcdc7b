"""How long tests wait for what must come, from a process, a socket or a thread.

It is a guard against waiting for ever and no measure of speed: a machine with other work may stand
still for half a minute, and a test that passes does not wait any longer than it has to.  What must
*not* come within some time has a time of its own.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

PATIENCE_S = 180.0


def until(true: Callable[[], Any], step_s: float = 0.02) -> None:
    """Wait until it is true."""
    end = time.monotonic() + PATIENCE_S
    while not true():
        assert time.monotonic() < end, f"not within {PATIENCE_S:g} s"
        time.sleep(step_s)
