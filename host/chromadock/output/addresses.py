"""From what the user typed after ``--out`` to an output."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.mounting import Mounting
from chromadock.output.lines import LinesFile, LinesUdp
from chromadock.output.results import ResultOutput

KINDS = "json:FILE, udp:HOST:PORT or mavlink:ADDRESS?receiver=NAME"


@dataclass(frozen=True, eq=False, slots=True)
class Surroundings:
    """What some outputs need to know: how the camera is mounted, None for one that looks ahead;
    whom they ``tell`` in a line what goes wrong, from any thread; whether it is a ``dry_run``, in
    which an autopilot is sent nothing."""

    mounting: Mounting | None
    tell: Callable[[str], None]
    dry_run: bool = False


def check_output(text: str) -> Callable[[Surroundings], ResultOutput]:
    """What opens the output that ``text`` names, ``KIND:PLACE``; nothing is opened yet.

    Raises
    ------
    ChromadockError
        One line, where there is no such kind or its place is none.
    """
    kind, _, place = text.partition(":")
    if kind not in _KINDS or not place:
        raise ChromadockError(f"--out {text}: no such output: give one of {KINDS}")
    return _KINDS[kind](text, place)


def open_output(text: str, surroundings: Surroundings) -> ResultOutput:
    """Open what ``text`` names.

    Raises
    ------
    ChromadockError
        As ``check_output``, or where it cannot be opened.
    """
    return check_output(text)(surroundings)


def _lines_file(text: str, place: str) -> Callable[[Surroundings], ResultOutput]:
    path = Path(place)
    if not path.resolve().parent.is_dir():
        raise ChromadockError(f"--out {text}: no such folder: create it first")
    return lambda _: LinesFile(path)


def _lines_udp(text: str, place: str) -> Callable[[Surroundings], ResultOutput]:
    host, _, port = place.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")  # as IPv6 is written before a port
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise ChromadockError(f"--out {text}: give udp:HOST:PORT, such as udp:192.168.2.1:9000")
    return lambda _: LinesUdp(host, int(port))


def _mavlink(text: str, place: str) -> Callable[[Surroundings], ResultOutput]:
    # pymavlink takes most of a second to load, which only who wants it waits for.
    from chromadock.autopilot.settings import AutopilotSettings
    from chromadock.output.mavlink import MavlinkDryRun, MavlinkOutput

    settings = AutopilotSettings.parse(text)
    return lambda around: (MavlinkDryRun if around.dry_run else MavlinkOutput)(
        settings, around.mounting, around.tell
    )


_KINDS: dict[str, Callable[[str, str], Callable[[Surroundings], ResultOutput]]] = {
    "json": _lines_file,
    "udp": _lines_udp,
    "mavlink": _mavlink,
}
