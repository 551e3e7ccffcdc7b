"""The vehicle's computer: its clock, disk and load."""

from __future__ import annotations

import os
import shutil
import time
from pathlib import Path

from chromadock.doctor.finding import Finding
from chromadock.processors import processors

BUILT_S = Path(__file__).stat().st_mtime
"""When this file was installed: no clock that is right is before it."""

_SYNCHRONISED = Path("/run/systemd/timesync/synchronized")

FREE_GIB = 5.0
"""Of the disk: a recorded dive of half an hour takes one or two."""

MOST_LOAD = 0.7
"""Share of the processors that others may be busy with."""


def clock(now_s: float | None = None) -> Finding:
    """Whether recordings will have the right date; ``now_s``: of the epoch."""
    now_s = time.time() if now_s is None else now_s
    if now_s < BUILT_S - 86400:
        day = time.strftime("%Y-%m-%d", time.gmtime(now_s))
        return Finding(
            "warning",
            "clock",
            f"it is {day} here, before this program was installed: set it with "
            "`timedatectl set-time`, or let it reach a time server, or recordings are misdated",
        )
    if Path("/run/systemd/system").is_dir() and not _SYNCHRONISED.exists():
        return Finding(
            "warning", "clock", "not set by a time server yet: compare it before a recording"
        )
    return Finding("ok", "clock", time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(now_s)))


def disk(folder: Path) -> Finding:
    """Whether there is room for logs and recordings in a folder."""
    try:
        free_gib = shutil.disk_usage(folder).free / 2**30
    except OSError as error:
        return Finding(
            "fault", "disk", f"{folder}: cannot be looked at ({error.strerror}): create the folder"
        )
    if not os.access(folder, os.W_OK):
        return Finding(
            "fault", "disk", f"{folder}: cannot be written to: allow it, or go elsewhere"
        )
    if free_gib < FREE_GIB:
        return Finding(
            "warning", "disk", f"{free_gib:.1f} GiB are free: delete old recordings before a dive"
        )
    return Finding("ok", "disk", f"{free_gib:.0f} GiB are free")


def load() -> Finding:
    """Whether other programs leave the processors to us."""
    count = processors()
    share = os.getloadavg()[0] / count
    if share > MOST_LOAD:
        return Finding(
            "warning",
            "load",
            f"{100 * share:.0f} % of {count} processors have been busy for a minute: "
            "look with `top`, and stop what is not needed",
        )
    return Finding("ok", "load", f"{100 * share:.0f} % of {count} processors")
