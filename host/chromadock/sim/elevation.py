"""Spectra are integrated for some hundred elevations a frame, and looked up for the pixels."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Image = NDArray[np.float32]


class ElevationTable:
    """Values for evenly spaced downward components d_z of the direction of sight.

    Parameters
    ----------
    d_z
        (n,) ascending, evenly spaced, -1..1.
    values
        (n, C), C at most 4.
    """

    def __init__(self, d_z: Floats, values: Floats) -> None:
        self._values = np.asarray(values, np.float32)[None]
        self._first = np.float32(d_z[0])
        self._per_step = np.float32((len(d_z) - 1) / max(float(d_z[-1] - d_z[0]), 1e-9))

    def at(self, d_z: Image) -> Image:
        """(h, w) to (h, w, C), or (h, w) if C is 1: linear between the rows, level beyond."""
        place = np.clip((d_z - self._first) * self._per_step, 0, self._values.shape[1] - 1)
        return np.asarray(cv2.remap(self._values, place, np.zeros_like(place), cv2.INTER_LINEAR))
