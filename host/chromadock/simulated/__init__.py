"""The dock without a board: the same core as on the board, in a process with a port."""

from __future__ import annotations

from chromadock.simulated.device import SimulatedDock
from chromadock.simulated.faults import Fault, parse_fault
from chromadock.simulated.loop import serve
from chromadock.simulated.transport import PtyPort, TcpPort

__all__ = ["Fault", "PtyPort", "SimulatedDock", "TcpPort", "parse_fault", "serve"]
