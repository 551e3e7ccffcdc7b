"""The results in a recording, each when its frame is looked at again."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from chromadock.errors import ChromadockError
from chromadock.results.detection import Detection
from chromadock.ros.mcap_bag import McapBag
from chromadock.ros.topics import RECORD

MOST_WAITING = 100
"""Results whose frames may still come, where another program has changed the order of a file."""


@dataclass(frozen=True, slots=True)
class Result:
    """What the run said of a frame.

    ``age_s``: how old the picture was when the result was out, seconds; None of no live source.
    """

    detection: Detection
    age_s: float | None


class Results:
    """Reads a recording beside its frames, for the results of an hour do not fit into memory.

    Parameters
    ----------
    path : of the recording, an MCAP file.
    start_ns : Unix nanoseconds at which ``Frame.time_s`` was 0.
    """

    def __init__(self, path: Path, start_ns: int) -> None:
        self._path = path
        self._start_ns = start_ns
        self._coming = self._all()
        self._waiting: dict[float, Result] = {}
        self._newest_s = float("-inf")

    def at(self, time_s: float) -> Result | None:
        """The result of the frame of that time; None where there is none.

        Parameters
        ----------
        time_s : ``Frame.time_s``, as ``sources`` reads it.  Frames are asked for in their order.

        Raises
        ------
        ChromadockError
            Where what is recorded is no result that this version reads.
        """
        while time_s not in self._waiting and self._newest_s < time_s:
            coming = next(self._coming, None)
            if coming is None:
                break
            self._newest_s, result = coming
            self._waiting[self._newest_s] = result
            if len(self._waiting) > MOST_WAITING:
                del self._waiting[next(iter(self._waiting))]
        return self._waiting.pop(time_s, None)

    def _all(self) -> Iterator[tuple[float, Result]]:
        with McapBag(self._path) as bag:
            for logged_ns, message in bag.messages(RECORD):
                try:
                    result = _result(json.loads(message.data))
                except ChromadockError as error:
                    raise ChromadockError(f"{self._path}: {RECORD}: {error}") from None
                yield (logged_ns - self._start_ns) / 1e9, result


def _result(line: dict[str, Any]) -> Result:
    return Result(Detection.from_dict(line), line.get("age_s"))
