"""Runs a simulated dock at its port."""

from __future__ import annotations

import time
from collections.abc import Callable
from threading import Event

from chromadock.link.connection import BAUD
from chromadock.simulated.device import SimulatedDock
from chromadock.simulated.transport import Port

CLOCK = time.monotonic
_TICK_S = 0.01
_SLOW_READER_S = 0.5
_BYTES_A_SECOND = BAUD / 10


def serve(dock: SimulatedDock, port: Port, stop: Event, clock: Callable[[], float] = CLOCK) -> None:
    """Until ``stop`` is set.  Bytes go out no faster than on the board's serial port.

    Raises
    ------
    ChromadockError
        Where the dock's source of frames breaks off.
    """
    pending = b""
    moved_s = sent_until_s = clock()
    while not stop.is_set():
        now = clock()
        wait = max(0.0, min(_TICK_S, dock.next_due_s() - now))
        if pending or sent_until_s > now:
            wait = min(wait, 0.001)
        data = port.read(wait)
        now = clock()
        if data:
            dock.receive(data, now)
        dock.step(now)
        if not pending and sent_until_s <= now:
            pending = dock.transmit(now)
            sent_until_s = max(sent_until_s, now - _TICK_S) + len(pending) / _BYTES_A_SECOND
            moved_s = now
        if pending:
            sent = port.write(pending)
            pending = pending[sent:]
            if sent:
                moved_s = now
            elif now - moved_s > _SLOW_READER_S:
                pending = b""  # nobody listens: a serial port does not wait either
