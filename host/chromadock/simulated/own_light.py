"""What the simulated dock's camera sees of the dock's own lamps."""

from __future__ import annotations

from collections import deque

import numpy as np

from chromadock.link.rgb565 import HEIGHT, WIDTH, from_rgb565, to_rgb565

_GAMMA = 2.2
"""Of the camera's encoding; it need not be more exact than the board's lens is known."""

RGB = tuple[float, float, float]


class OwnLight:
    """Scattered light of the lamps, even over the picture.

    Parameters
    ----------
    share
        Of the camera's full scale, 0..1, that a lamp at full power gives.
    """

    def __init__(self, share: float) -> None:
        self._share = share
        self._driven: deque[tuple[float, RGB]] = deque([(float("-inf"), (0.0, 0.0, 0.0))])

    def drive(self, lamps: RGB, now_s: float) -> None:
        """The lamps give this from ``now_s`` on: R, G, B, each a share of its full power."""
        if lamps != self._driven[-1][1]:
            self._driven.append((now_s, lamps))

    def forget(self, before_s: float) -> None:
        """No frame that begins before ``before_s`` is asked for any more."""
        while len(self._driven) > 1 and self._driven[1][0] <= before_s:
            self._driven.popleft()

    def exposed(self, data: bytes, from_s: float, to_s: float) -> bytes:
        """A frame of ``WIDTH`` x ``HEIGHT`` in RGB565 with the light of that time in it."""
        if self._share == 0:
            return data
        light = np.zeros(3)
        ends = [at for at, _ in list(self._driven)[1:]] + [to_s]
        for (at, lamps), end in zip(self._driven, ends, strict=True):
            light += max(0.0, min(end, to_s) - max(at, from_s)) * np.array(lamps)
        light *= self._share / (to_s - from_s)
        water = (from_rgb565(data, WIDTH, HEIGHT) / 255.0) ** _GAMMA
        seen = 255 * np.clip(water + light[::-1], 0, 1) ** (1 / _GAMMA)
        return to_rgb565(np.rint(seen).astype(np.uint8))
