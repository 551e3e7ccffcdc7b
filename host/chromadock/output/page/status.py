"""What the live page shows: the newest frame, its result, and how the run goes."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from chromadock.output.results import ResultOutput, result_record
from chromadock.output.run_setup import RunSetup, chromadock_version
from chromadock.rate import Rate
from chromadock.results.detection import Detection
from chromadock.sources import Frame

STALE_S = 5.0
"""A run without a new result for so long has a camera that delivers nothing."""


@dataclass(frozen=True, slots=True, eq=False)
class Newest:
    """A frame, its result, how old its picture was then (seconds; None of a recording), and when
    it came, on the monotonic clock."""

    frame: Frame
    detection: Detection
    age_s: float | None
    came_s: float


class Status:
    """Written by the run, read by the threads of the server; all methods may be called by any.

    Times ``now_s`` are of the monotonic clock.
    """

    def __init__(self) -> None:
        self._changed = threading.Lock()
        self._setup: RunSetup | None = None
        self._vehicle = ""
        self._outputs: Mapping[str, ResultOutput] = {}
        self._fault: str | None = None
        self._newest: Newest | None = None
        self._forget()

    def _forget(self) -> None:
        self._frames = self._dropped = self._next_index = 0
        self._rate = Rate(STALE_S)

    def begin(self, setup: RunSetup | None) -> None:
        """A run begins, set to this; None where nobody knows."""
        vehicle = "" if setup is None else setup.vehicle()
        with self._changed:
            self._setup, self._vehicle, self._fault, self._newest = setup, vehicle, None, None
            self._outputs = {}
            self._forget()

    def beside(self, outputs: Mapping[str, ResultOutput]) -> None:
        """The run has these outputs."""
        with self._changed:
            self._outputs = outputs

    def fails(self, line: str) -> None:
        """The run could not begin, or broke off."""
        with self._changed:
            self._fault, self._outputs = line, {}

    def take(self, frame: Frame, detection: Detection, age_s: float | None, now_s: float) -> None:
        """A frame and its result came."""
        with self._changed:
            self._frames += 1
            self._dropped += max(frame.index - self._next_index, 0)
            self._next_index = frame.index + 1
            self._rate.came(now_s)
            self._newest = Newest(frame, detection, age_s, now_s)

    @property
    def setup(self) -> RunSetup | None:
        """What the run is set to."""
        return self._setup

    @property
    def newest(self) -> Newest | None:
        """The newest frame of this run."""
        return self._newest

    def trouble(self, now_s: float) -> str | None:
        """Why no results come at this moment; None where they do."""
        with self._changed:
            newest, fault = self._newest, self._fault
        if fault is not None:
            return fault
        if newest is None:
            return "no picture yet"
        silent_s = now_s - newest.came_s
        return None if silent_s < STALE_S else f"no new picture for {silent_s:.0f} s"

    def record(self, now_s: float) -> dict[str, Any]:
        """All of it but the picture, as a JSON object.

        ``trouble``, of the run and of each output, is null where all is well; ``age_s`` is how old
        the newest picture is now, ``dropped`` counts frames that gave way to newer ones, ``result``
        is a line of ``detect --json``, ``vehicle`` the settings as they hold.
        """
        trouble = self.trouble(now_s)
        with self._changed:
            newest, outputs, rate_hz = self._newest, self._outputs, self._rate.hz(now_s)
            answer: dict[str, Any] = {
                "version": chromadock_version(),
                "trouble": trouble,
                "frames": self._frames,
                "dropped": self._dropped,
                "rate_hz": None if rate_hz is None else round(rate_hz, 1),
                "vehicle": self._vehicle,
            }
        answer["outputs"] = [
            {"name": name, "trouble": _without_name(output.trouble(), name)}
            for name, output in outputs.items()
        ]
        if newest is not None:
            age_s = None if newest.age_s is None else newest.age_s + now_s - newest.came_s
            answer["age_s"] = None if age_s is None else round(age_s, 3)
            answer["result"] = result_record(newest.frame, newest.detection, newest.age_s)
        return answer


def _without_name(trouble: str | None, name: str) -> str | None:
    """A trouble beside whose name it is shown: messages begin with ``KIND:PLACE``, as the user
    called the output, or with the place alone."""
    if trouble is None:
        return None
    place = name.partition(":")[2]
    return trouble.removeprefix(f"{name}: ").removeprefix(f"{place}: ")
