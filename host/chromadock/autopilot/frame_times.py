"""When a frame was taken, by the clock of the link."""

from __future__ import annotations

from dataclasses import dataclass, field

from chromadock.stamps import Stamps

OLD_S = 2.0
"""A frame that seems older than this, or comes from the future, has another clock's time."""


@dataclass(slots=True)
class FrameTimes:
    """Frames' times in ours, whatever clock they are of.

    Of a frame whose age is told that is known.  Of another it is its time as it is, where that may
    be of our clock; else it is mapped as ``stamps`` does it, so that the least time between a frame
    and its detection is taken for none: the attitude that goes with it is then that much too new.

    Attributes
    ----------
    foreign
        Whether frames are of another clock and tell no age; None before the first frame.
    """

    foreign: bool | None = None
    _stamps: Stamps = field(default_factory=Stamps)

    def ours(self, time_s: float, now_s: float, age_s: float | None = None) -> float:
        """The frame of ``time_s``, handed over at ``now_s`` of our clock, ``age_s`` after it was
        taken, all in seconds."""
        if age_s is not None:
            self.foreign = False
            # By the same clock but for its origin: the least difference is the true one, and
            # what else was done since the age was told does not count.
            return self._mapped(time_s, now_s - age_s)
        if self.foreign is None:
            self.foreign = not 0 <= now_s - time_s <= OLD_S
        return self._mapped(time_s, now_s) if self.foreign else time_s

    def _mapped(self, time_s: float, arrival_s: float) -> float:
        self._stamps.heard(time_s, arrival_s)
        mapped_s = self._stamps.ours(time_s)
        return arrival_s if mapped_s is None else mapped_s
