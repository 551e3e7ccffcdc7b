"""From what the user typed after ``--out`` to an output."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from chromadock.errors import ChromadockError
from chromadock.output.lines import LinesFile, LinesUdp
from chromadock.output.results import ResultOutput
from chromadock.output.run_setup import RunSetup
from chromadock.sources import ignore

Tell = Callable[[str], None]

KINDS = "json:FILE, mcap:FILE, udp:HOST:PORT"
RECORDING = "mcap"


def open_output(text: str, setup: RunSetup | None = None, tell: Tell = ignore) -> ResultOutput:
    """Open what ``text`` names: ``KIND:PLACE``, see ``KINDS``.

    Parameters
    ----------
    setup : what the run is set to, for a recording.
    tell : takes one line where the output has another name than was asked for.

    Raises
    ------
    ChromadockError
        One line, where there is no such kind or its place is none.
    """
    kind, place = check_output(text)
    return _OPENERS[kind](place, setup, tell)


def check_output(text: str) -> tuple[str, str]:
    """Kind and place of what ``text`` names; nothing is opened.

    Raises
    ------
    ChromadockError
        One line, where there is no such kind, no such folder, or no such form of an address.
    """
    kind, _, place = text.partition(":")
    if kind not in _OPENERS or not place:
        raise ChromadockError(f"--out {text}: no such output: give one of {KINDS}")
    if kind == "udp":
        _host_and_port(place)
    elif not Path(place).resolve().parent.is_dir():
        raise ChromadockError(f"--out {text}: no such folder: create it first")
    return kind, place


def _host_and_port(place: str) -> tuple[str, int]:
    host, _, port = place.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")  # as IPv6 is written before a port
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise ChromadockError(
            f"--out udp:{place}: give udp:HOST:PORT, such as udp:192.168.2.1:9000"
        )
    return host, int(port)


def _lines_file(place: str, _setup: RunSetup | None, _tell: Tell) -> ResultOutput:
    return LinesFile(Path(place))


def _lines_udp(place: str, _setup: RunSetup | None, _tell: Tell) -> ResultOutput:
    return LinesUdp(*_host_and_port(place))


def _recording(place: str, setup: RunSetup | None, tell: Tell) -> ResultOutput:
    from chromadock.output.recording import Recording  # takes long to load

    path = Path(place)
    recording = Recording(path, setup)
    if recording.path != path:
        tell(f"{path} is there already: recording into {recording.path}")
    return recording


_OPENERS: dict[str, Callable[[str, RunSetup | None, Tell], ResultOutput]] = {
    "json": _lines_file,
    RECORDING: _recording,
    "udp": _lines_udp,
}
