"""From what the user typed after ``--out`` to an output."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from chromadock.errors import ChromadockError
from chromadock.output.lines import LinesFile, LinesUdp
from chromadock.output.results import ResultOutput

if TYPE_CHECKING:
    from chromadock.output.run_setup import RunSetup

KINDS = "json:FILE, mcap:FILE, udp:HOST:PORT, http:[HOST:]PORT or mavlink:ADDRESS?receiver=NAME"


@dataclass(frozen=True, eq=False, slots=True)
class Surroundings:
    """What some outputs need to know.

    ``setup``: what the run is set to, None where nobody knows; ``tell``: takes a line for the
    user, from any thread; ``dry_run``: whether an autopilot is sent nothing.
    """

    setup: RunSetup | None
    tell: Callable[[str], None]
    dry_run: bool = False


Opener = Callable[[Surroundings], ResultOutput]


def check_output(text: str) -> Opener:
    """What opens the output that ``text`` names, ``KIND:PLACE``; nothing is opened yet.

    Raises
    ------
    ChromadockError
        One line, where there is no such kind, no such folder, or no such form of an address.
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


def _lines_file(text: str, place: str) -> Opener:
    path = _in_a_folder(text, place)
    return lambda _: LinesFile(path)


def _recording(text: str, place: str) -> Opener:
    path = _in_a_folder(text, place)

    def opened(around: Surroundings) -> ResultOutput:
        from chromadock.output.recording import Recording  # takes long to load

        recording = Recording(path, around.setup)
        if recording.path != path:
            around.tell(f"{path} is there already: recording into {recording.path}")
        return recording

    return opened


def _lines_udp(text: str, place: str) -> Opener:
    host, port = _host_and_port(place)
    if not host or port is None:
        raise ChromadockError(f"--out {text}: give udp:HOST:PORT, such as udp:192.168.2.1:9000")
    return lambda _: LinesUdp(host, port)


def _page(text: str, place: str) -> Opener:
    host, port = _host_and_port(place)
    if port is None:
        raise ChromadockError(
            f"--out {text}: give http:PORT for this computer alone, or http:0.0.0.0:PORT for all "
            "that can reach it, such as http:8642"
        )

    def opened(around: Surroundings) -> ResultOutput:
        from chromadock.output.page.output import PageOutput  # takes long to load

        page = PageOutput(host or "127.0.0.1", port)
        page.begin(around.setup)
        return page

    return opened


def _mavlink(text: str, place: str) -> Opener:
    # pymavlink takes most of a second to load, which only who wants it waits for.
    from chromadock.autopilot.settings import AutopilotSettings
    from chromadock.output.mavlink import MavlinkDryRun, MavlinkOutput
    from chromadock.vehicle.building import mounting_of

    settings = AutopilotSettings.parse(text)

    def opened(around: Surroundings) -> ResultOutput:
        setup = around.setup
        mounting = None if setup is None else mounting_of(setup.settings.mounting)
        kind = MavlinkDryRun if around.dry_run else MavlinkOutput
        return kind(settings, mounting, around.tell)

    return opened


def _host_and_port(place: str) -> tuple[str, int | None]:
    """Of ``HOST:PORT`` or ``PORT``, the host (empty without one) and the port (None: no number)."""
    host, _, port = place.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")  # as IPv6 is written before a port
    known = port.isdecimal() and 0 < int(port) < 65536
    return host, int(port) if known else None


def _in_a_folder(text: str, place: str) -> Path:
    path = Path(place)
    if not path.resolve().parent.is_dir():
        raise ChromadockError(f"--out {text}: no such folder: create it first")
    return path


_KINDS: dict[str, Callable[[str, str], Opener]] = {
    "json": _lines_file,
    "mcap": _recording,
    "udp": _lines_udp,
    "http": _page,
    "mavlink": _mavlink,
}
