"""When a frame was taken, by the clock of the link."""

from __future__ import annotations

from dataclasses import dataclass, field

from chromadock.autopilot.stamps import Stamps

OLD_S = 2.0
"""A frame that seems older than this, or comes from the future, has another clock's time."""


@dataclass(slots=True)
class FrameTimes:
    """Frames' times as they are, where they are of this computer's monotonic clock; else mapped.

    Mapped as ``stamps`` does it, so that the least time between a frame and its detection is taken
    for none: the attitude that goes with it is then that much too new.

    Attributes
    ----------
    foreign
        Whether they are another clock's; None before the first frame.
    """

    foreign: bool | None = None
    _stamps: Stamps = field(default_factory=Stamps)

    def ours(self, time_s: float, now_s: float) -> float:
        """The frame of ``time_s``, handed over at ``now_s``, in seconds of our clock."""
        if self.foreign is None:
            self.foreign = not 0 <= now_s - time_s <= OLD_S
        if not self.foreign:
            return time_s
        self._stamps.heard(time_s, now_s)
        mapped = self._stamps.ours(time_s)
        return now_s if mapped is None else mapped
