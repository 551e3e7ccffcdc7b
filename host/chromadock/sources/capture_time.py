"""When a live picture was taken, on this computer's monotonic clock."""

from __future__ import annotations

from chromadock.stamps import Stamps

SAME_CLOCK_S = 1.0
"""A driver's stamp is no older than this when its picture arrives, and never of the future."""

_NEXT_S = 1e-4
"""Between two pictures at the least: times must grow."""


class CaptureTime:
    """Turns stamps and arrivals into times of capture.

    Parameters
    ----------
    monotonic
        Whether the stamps are of this computer's monotonic clock.
    delay_s
        Seconds >= 0 that a picture takes from capture to arrival at best, as its user has
        measured or read it: no stamp tells what happens before it is put on.
    """

    def __init__(self, monotonic: bool, delay_s: float = 0.0) -> None:
        self._monotonic = monotonic
        self._delay_s = delay_s
        self._stamps = Stamps()
        self._last_s: float | None = None

    def of(self, stamp_s: float | None, arrival_s: float) -> float:
        """Seconds of this computer's monotonic clock at which a picture was taken.

        A stamp of another clock is moved to ours by the quickest of the newest pictures (see
        ``stamps``): what a picture waited longer than that one on its way, it is older by.
        Without a stamp the arrival counts.  Times grow from picture to picture.

        Parameters
        ----------
        stamp_s : the picture's own; None where it has none.
        arrival_s : when it came, on the monotonic clock.
        """
        taken_s = self._taken(stamp_s, arrival_s)
        if self._last_s is not None:
            taken_s = max(taken_s, self._last_s + _NEXT_S)
        self._last_s = taken_s
        return taken_s

    def _taken(self, stamp_s: float | None, arrival_s: float) -> float:
        if stamp_s is None:
            return arrival_s - self._delay_s
        if self._monotonic and 0 <= arrival_s - stamp_s <= SAME_CLOCK_S:
            return stamp_s
        self._stamps.heard(stamp_s, arrival_s)
        ours_s = self._stamps.ours(stamp_s)
        assert ours_s is not None  # it has just heard one
        return ours_s - self._delay_s
