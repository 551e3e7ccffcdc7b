"""How well the node does: its diagnostics, and what its log says of that."""

from __future__ import annotations

from collections.abc import Callable

from chromadock.rate import Rate
from chromadock.ros.diagnostics import diagnostics, summary
from chromadock.ros.fields import Fields
from chromadock.ros_node.finder import Seen

PERIOD_S = 1.0
"""Diagnostics come at least so often, and at every change."""

SILENCE_S = 2.0
"""Without a picture for so long there is none: the slowest camera in use has one a second."""

GRACE_S = 1.0
"""A complaint is logged when it has held for so long: at a start, or at a change of the camera's
mode, a picture may come before its CameraInfo."""


class Health:
    """Takes in what came of each picture, and tells.

    Times are seconds of any clock that does not go back.

    Parameters
    ----------
    topic : of the pictures.
    log : takes one line when something goes wrong, or right again.
    now_s : this moment.
    """

    def __init__(self, topic: str, log: Callable[[str], None], now_s: float) -> None:
        self._silent = f"no pictures on {topic}: start the camera's driver, or remap image to it"
        self._log = log
        self._picture_s = now_s
        self._rate = Rate(SILENCE_S)
        self._seen: Seen | None = None
        self._age_s: float | None = None
        self._complaint: str | None = None
        self._since_s = now_s
        self._logged: str | None = None
        self._told: tuple[str, float] | None = None

    def seen(self, seen: Seen, age_s: float, now_s: float) -> None:
        """Take in what came of a picture, ``age_s`` after it was taken."""
        self._seen, self._age_s, self._picture_s = seen, age_s, now_s
        if seen.complaint is None:
            self._rate.came(now_s)

    def told(self, dropped: int, stamp_ns: int, now_s: float) -> Fields | None:
        """The fields of ``diagnostic_msgs/DiagnosticArray`` where it is time to tell, or None.

        Parameters
        ----------
        dropped : pictures so far that were not looked at.
        stamp_ns : this moment by ROS's clock.
        """
        silent = now_s - self._picture_s > SILENCE_S
        seen = None if silent else self._seen
        complaint = self._silent if silent else seen.complaint if seen else None
        self._log_change(complaint, now_s)
        detection = seen.detection if seen else None
        age_s = None if detection is None else self._age_s
        message = summary(detection, age_s, complaint).message
        if self._told is not None:
            before, told_s = self._told
            if message == before and now_s - told_s < PERIOD_S:
                return None
        self._told = message, now_s
        rate_hz = self._rate.hz(now_s) or 0.0
        return diagnostics(detection, age_s, dropped, stamp_ns, "", rate_hz, complaint)

    def _log_change(self, complaint: str | None, now_s: float) -> None:
        if complaint != self._complaint:
            self._complaint, self._since_s = complaint, now_s
        if complaint is None and self._logged is not None:
            self._log("results are coming again")
            self._logged = None
        elif complaint != self._logged and now_s - self._since_s >= GRACE_S:
            assert complaint is not None
            self._log(complaint)
            self._logged = complaint
