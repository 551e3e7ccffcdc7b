"""Serial ports, and the dock behind one."""

from __future__ import annotations

import os
from collections.abc import Iterator

from serial.tools import list_ports

from chromadock.doctor.finding import Finding
from chromadock.errors import ChromadockError


def serial_ports() -> Iterator[Finding]:
    """USB serial ports, and whether we may open them."""
    ports = sorted(port.device for port in list_ports.comports() if port.vid is not None)
    if not ports:
        yield Finding("ok", "serial ports", "no USB adapter is plugged in")
    for port in ports:
        if os.access(port, os.R_OK | os.W_OK):
            yield Finding("ok", "serial ports", f"{port} is here")
        else:
            yield Finding(
                "fault",
                "serial ports",
                f"{port}: not ours to open: `sudo usermod -aG dialout $USER`, then log in again",
            )


def dock(port: str | None, timeout_s: float) -> Finding:
    """Whether a dock answers, and whether it speaks of the same colours as this vehicle."""
    from chromadock.link import open_dock

    try:
        with open_dock(port, timeout_s=timeout_s) as client:
            client.check_dialect()
            firmware = client.version.git_hash
    except ChromadockError as error:
        return Finding("fault", "dock", str(error))
    return Finding("ok", "dock", f"answers, firmware {firmware}, the same colour method as here")
