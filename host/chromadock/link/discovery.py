"""Finds the dock's port by asking for a heartbeat."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from serial.tools import list_ports

from chromadock.errors import ChromadockError
from chromadock.link.client import DockClient
from chromadock.link.connection import BAUD, Connection
from chromadock.link.messenger import PATIENCE_S, OnText
from chromadock.text import one_line


def candidates() -> list[str]:
    """Ports of USB adapters, in order; a PC's built-in ports are left alone."""
    return sorted(p.device for p in list_ports.comports() if p.vid is not None)


def open_dock(
    port: str | None = None,
    baud: int = BAUD,
    timeout_s: float = PATIENCE_S,
    log: Path | None = None,
    on_text: OnText | None = None,
    system: int | None = None,
) -> DockClient:
    """The dock at ``port``, or the only one that answers at any candidate; of that MAVLink
    ``system``, or the only one there.

    Raises
    ------
    ChromadockError
        One line: what is wrong with the port; no dock; several, by name.
    """
    if port is None:
        port = _only_dock(baud, timeout_s, system)
    return DockClient(Connection(port, baud, log), timeout_s, on_text=on_text, system=system)


def _only_dock(baud: int, timeout_s: float, system: int | None) -> str:
    ports = candidates()
    if not ports:
        raise ChromadockError(
            "no USB serial port is here: plug in the dock's adapter, or give --port"
        )
    if len(ports) == 1:  # its own fault line says more than a list
        return ports[0]
    with ThreadPoolExecutor(len(ports)) as pool:
        faults = list(pool.map(lambda p: _fault(p, baud, timeout_s, system), ports))
    docks = [p for p, fault in zip(ports, faults, strict=True) if fault is None]
    if len(docks) == 1:
        return docks[0]
    if docks:
        raise ChromadockError(f"several docks: {', '.join(docks)}: choose one with --port")
    reasons = "; ".join(one_line(fault, 120) for fault in faults)
    raise ChromadockError(f"no dock answers ({reasons}): check power and cable, or give --port")


def _fault(port: str, baud: int, timeout_s: float, system: int | None) -> str | None:
    """Why there is no dock at ``port``, None where there is one."""
    try:
        DockClient(Connection(port, baud), timeout_s, system=system).close()
    except ChromadockError as error:
        return str(error)
    return None
