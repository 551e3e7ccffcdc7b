"""The detector once more over one recording."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from chromadock.errors import ChromadockError
from chromadock.output.base import cannot_write
from chromadock.output.jsonlines import JsonLines
from chromadock.output.results import result_record
from chromadock.replay.compared import Compared, compared
from chromadock.replay.recorded import read_recorded
from chromadock.replay.summary import Summary, summarised
from chromadock.sources import Frame, Source, open_source

Tell = Callable[[str], None]
"""Takes a line that the user should see."""


@dataclass(frozen=True)
class Replayed:
    """Every frame, and whether all of the recording could be read."""

    frames: list[Compared]
    whole: bool

    @property
    def summary(self) -> Summary:
        """The figures."""
        return summarised(self.frames)


def replayed(
    path: Path,
    changes: Mapping[str, Any],
    out: Path | None,
    tell: Tell,
    watched: Callable[[Source], Iterable[Frame]] = iter,
) -> Replayed:
    """Run the detector over a recording, and compare with what is recorded.

    Parameters
    ----------
    path : of the recording.
    changes : settings by dotted key, before the recorded ones.
    out : folder, made if need be, for ``comparison.json``, ``frames.jsonl`` and
        ``comparison.svg``; None for none.
    tell : takes a line of what could not be read or drawn.
    watched : the source again, for whoever wants to see how it goes.

    Raises
    ------
    ChromadockError
        Where it is no recording, a change is none, or ``out`` cannot be written.
    """
    recorded = read_recorded(path, changes)
    found = []
    with ExitStack() as stack:
        frames = stack.enter_context(
            open_source(str(path), on_fault=lambda line: tell(f"error: {line}"))
        )
        if out is not None:
            make_folder(out)
        lines = None if out is None else stack.enter_context(JsonLines(out / "frames.jsonl"))
        for frame in watched(frames):
            new = recorded.detector.process(frame.image, frame.time_s, frame.attitude)
            found.append(compared(frame.time_s, recorded.results.at(frame.time_s), new))
            if lines is not None:
                lines.write(result_record(frame, new, None))
    result = Replayed(found, not (frames.errors or frames.cut_short))
    if out is not None:
        _write(out, result, tell)
    return result


def make_folder(out: Path) -> None:
    """For results; its own folder must be there.

    Raises
    ------
    ChromadockError
        Where it cannot be made.
    """
    try:
        out.mkdir(exist_ok=True)
    except OSError as error:
        raise ChromadockError(
            f"--out {out}: no folder can be made there ({error.strerror}): give another"
        ) from None


def _write(out: Path, result: Replayed, tell: Tell) -> None:
    with JsonLines(out / "comparison.json") as file:
        file.write(result.summary.to_dict())
    if find_spec("matplotlib") is None:
        tell("no picture: matplotlib is not installed: pip install chromadock[sim]")
        return
    from chromadock.replay.picture import write_picture

    try:
        write_picture(out / "comparison.svg", result.frames)
    except OSError as error:
        raise cannot_write(out / "comparison.svg", error) from None
