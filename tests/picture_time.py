"""Reads when a picture of ``rtsp_server.py`` was taken."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

COLUMNS, ROWS = 8, 4


def shown_s(image: NDArray[np.uint8]) -> float:
    """Seconds, modulo 2^32 milliseconds, of the monotonic clock."""
    high, wide = image.shape[:2]
    down, across = high // ROWS, wide // COLUMNS
    blocks = image[: down * ROWS, : across * COLUMNS].mean(axis=2)
    means = blocks.reshape(ROWS, down, COLUMNS, across).mean(axis=(1, 3)).ravel()
    bits = (means > 127).astype(np.int64)
    return int("".join(map(str, bits)), 2) / 1000


def age_s(image: NDArray[np.uint8], now_s: float) -> float:
    """How old a picture is at a moment of the monotonic clock."""
    return (now_s - shown_s(image)) % (2**32 / 1000)
