"""Outputs that take each frame's result as it comes, any number at once."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from chromadock.closable import Closable
from chromadock.results.detection import Detection
from chromadock.sources import Frame
from chromadock.track.attitude import Attitude


class ResultOutput(Closable, ABC):
    """Somewhere results go while the detection runs: a file, the network, an autopilot.

    A context manager that closes at the end.
    """

    def attitude(self, time_s: float, age_s: float | None) -> Attitude | None:
        """The vehicle's own attitude when a frame was taken, from whoever is at the other end.

        Parameters
        ----------
        time_s : the frame's.
        age_s : how old its picture is by now, seconds; None of a recording.

        Returns
        -------
        None where nobody there tells it.
        """
        return None

    @abstractmethod
    def write(self, frame: Frame, detection: Detection, age_s: float | None) -> None:
        """Pass one result on; never waits for a slow or dead receiver.

        Parameters
        ----------
        age_s : how old the picture of a live source is by now, seconds; None of a recording.

        Raises
        ------
        ChromadockError
            Where it cannot; a later write may go well again.
        """

    def trouble(self) -> str | None:
        """What keeps the results from their receiver at this moment, for the user; None where
        all is well.  Called from any thread."""
        return None

    def beside(self, outputs: Mapping[str, ResultOutput]) -> None:
        """Told once, before the first result: all outputs of the run by what the user called
        them, this one too."""


def result_record(frame: Frame, detection: Detection, age_s: float | None) -> dict[str, Any]:
    """One frame's result as a JSON object, alike wherever it goes.

    ``file``, ``frame`` and ``time_s`` say which frame it is; ``age_s``, of a live source only, how
    old its picture was when its result was out; ``attitude``, where the vehicle told it, roll,
    pitch and yaw (see ``Attitude``) with which the frame was looked at; the rest is
    ``Detection.to_dict``.
    """
    which = {"file": frame.name, "frame": frame.index, "time_s": round(frame.time_s, 6)}
    age = {} if age_s is None else {"age_s": round(age_s, 4)}
    angles = {} if frame.attitude is None else {"attitude": _angles(frame.attitude)}
    return {**which, **age, **angles, **detection.to_dict()}


def _angles(attitude: Attitude) -> dict[str, float | None]:
    """To a microradian."""
    return {
        name: None if angle is None else round(angle, 6) for name, angle in asdict(attitude).items()
    }
