"""Faults on request: ``camera-timeout@10s``, ``corrupt=0.01``."""

from __future__ import annotations

import re
from dataclasses import dataclass

from chromadock.errors import ChromadockError
from chromadock.text import one_line

KINDS = {
    "camera-timeout": "one grab takes 4 s and fails, then the camera is back",
    "camera-lost": "every grab fails from then on",
    "noise": "256 random bytes to the host",
    "boot-text": "the boot loader's text to the host, without a restart",
    "driver-text": "camera driver text from then on, inside messages as well",
    "reboot": "the dock loses power for a moment",
    "storage": "settings cannot be saved from then on",
    "corrupt": "share of the bytes damaged, both directions: corrupt=0.01",
}


@dataclass(frozen=True)
class Fault:
    """One of ``KINDS``, from ``at_s`` seconds after the simulation's start on; ``share`` of
    bytes, for ``corrupt``."""

    kind: str
    at_s: float = 0.0
    share: float = 0.0


def parse_fault(text: str) -> Fault:
    """``KIND``, ``KIND@10s`` or ``corrupt=SHARE``.

    Raises
    ------
    ChromadockError
        Where it is something else.
    """
    match = re.fullmatch(r"([a-z-]+)(?:=([0-9.]+))?(?:@([0-9.]+)s?)?", text)
    if not match or match.group(1) not in KINDS:
        raise ChromadockError(
            f"--fault {one_line(text, 40)}: give one of {', '.join(KINDS)}, with a time if you "
            "like: camera-lost@10s"
        )
    kind, share, at = match.groups()
    if (share is not None) != (kind == "corrupt"):
        raise ChromadockError(
            f"--fault {text}: only corrupt takes a share, and needs one: corrupt=0.01"
        )
    fault = Fault(kind, _number(text, at), _number(text, share))
    if fault.share > 1:
        raise ChromadockError(f"--fault {text}: the share of bytes is 0 .. 1: corrupt=0.01")
    return fault


def _number(whole: str, text: str | None) -> float:
    try:
        return 0.0 if text is None else float(text)
    except ValueError:
        raise ChromadockError(
            f"--fault {whole}: {text} is no number: write it like camera-lost@10s"
        ) from None
