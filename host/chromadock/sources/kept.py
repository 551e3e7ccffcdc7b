"""A camera whose controls are kept set while its pictures are taken."""

from __future__ import annotations

from collections.abc import Callable

from chromadock.controls.keeper import Keeper
from chromadock.sources.grabber import Grabber, Shot


def kept(open_grabber: Callable[[], Grabber], keeper: Keeper | None) -> Callable[[], Grabber]:
    """``open_grabber``, with the controls set each time; as it is where ``keeper`` is None."""
    return open_grabber if keeper is None else lambda: _Kept(open_grabber(), keeper)


class _Kept(Grabber):
    """Tells the keeper what becomes of a grabber."""

    def __init__(self, grabber: Grabber, keeper: Keeper) -> None:
        self._grabber = grabber
        self._keeper = keeper
        self._seen = False
        self.fps = grabber.fps
        self.monotonic = grabber.monotonic
        keeper.opened()

    def grab(self) -> Shot | None:
        """See ``Grabber``."""
        shot = self._grabber.grab()
        if shot is not None and not self._seen:
            self._seen = True
            self._keeper.seen()
        return shot

    def close(self) -> None:
        """See ``Grabber``."""
        self._keeper.lost()
        self._grabber.close()
