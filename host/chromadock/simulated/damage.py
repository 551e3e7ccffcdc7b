"""Damages bytes on their way, the same way for the same seed."""

from __future__ import annotations

import math
import random


class Damage:
    """Changes a ``share`` of all bytes, chosen at random."""

    def __init__(self, share: float, random_source: random.Random) -> None:
        self._share = share
        self._random = random_source
        self._gap = self._draw()

    def apply(self, data: bytes) -> bytes:
        """``data`` with some bytes changed to others."""
        if self._share <= 0 or self._gap >= len(data):
            self._gap -= len(data)
            return data
        out = bytearray(data)
        while self._gap < len(out):
            out[int(self._gap)] ^= self._random.randrange(1, 256)
            self._gap += 1 + self._draw()
        self._gap -= len(out)
        return bytes(out)

    def _draw(self) -> float:
        """Whole bytes until the next one that is hit."""
        if self._share >= 1:
            return 0
        if self._share <= 0:
            return math.inf
        return math.log(1 - self._random.random()) // math.log(1 - self._share)
