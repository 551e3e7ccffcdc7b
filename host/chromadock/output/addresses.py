"""From what the user typed after ``--out`` to an output."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.output.lines import LinesFile, LinesUdp
from chromadock.output.results import ResultOutput

KINDS = "json:FILE, udp:HOST:PORT"


def open_output(text: str) -> ResultOutput:
    """Open what ``text`` names: ``KIND:PLACE``, see ``KINDS``.

    Raises
    ------
    ChromadockError
        One line, where there is no such kind or its place is none.
    """
    kind, place = check_output(text)
    return _OPENERS[kind](place)


def check_output(text: str) -> tuple[str, str]:
    """Kind and place of what ``text`` names; nothing is opened.

    Raises
    ------
    ChromadockError
        One line, where there is no such kind.
    """
    kind, _, place = text.partition(":")
    if kind not in _OPENERS or not place:
        raise ChromadockError(f"--out {text}: no such output: give one of {KINDS}")
    return kind, place


def _lines_file(place: str) -> ResultOutput:
    path = Path(place)
    if not path.resolve().parent.is_dir():
        raise ChromadockError(f"--out json:{place}: no such folder: create it first")
    return LinesFile(path)


def _lines_udp(place: str) -> ResultOutput:
    host, _, port = place.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")  # as IPv6 is written before a port
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise ChromadockError(
            f"--out udp:{place}: give udp:HOST:PORT, such as udp:192.168.2.1:9000"
        )
    return LinesUdp(host, int(port))


_OPENERS: dict[str, Callable[[str], ResultOutput]] = {"json": _lines_file, "udp": _lines_udp}
