"""Photographs of real water in the place of rendered water."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.errors import ChromadockError
from chromadock.sim.sensor import Sensor
from chromadock.sources.order import natural_key
from chromadock.sources.pictures import is_picture
from chromadock.sources.still import read_still

Image = NDArray[np.float32]

HOLD_S = 5.0
"""A photograph stays this long, more than twice the rolling mean of both sides."""


class Photographs:
    """The pictures of a folder, one after the other; both cameras see the same.

    Parameters
    ----------
    folder
        Of pictures; their names give the order.
    hold_s
        How long each stays.

    Raises
    ------
    ChromadockError
        Where the folder cannot be read or has no picture; from ``light``, where one is broken.
    """

    def __init__(self, folder: str | Path, hold_s: float = HOLD_S) -> None:
        try:
            files = [path for path in Path(folder).iterdir() if path.is_file()]
        except OSError as error:
            raise ChromadockError(
                f"{folder}: cannot be read ({error.strerror}): give a folder of photographs"
            ) from None
        pictures = [path for path in files if is_picture(path)]
        if not pictures:
            raise ChromadockError(f"{folder}: no pictures in it: give a folder of photographs")
        self._paths = sorted(pictures, key=lambda path: natural_key(path.name))
        self._hold_s = hold_s
        for path in self._paths:
            read_still(path)

    def path(self, time_s: float) -> Path:
        """Which is shown at a moment; the first one again after the last."""
        return self._paths[int(time_s // self._hold_s) % len(self._paths)]

    def linear(self, time_s: float, sensor: Sensor) -> Image:
        """The photograph as light on a sensor that would give the same colours again.

        Decoded by sRGB's curve (IEC 61966-2-1), cut to the sensor's shape, and run backwards
        through its colour matrix.

        Returns
        -------
        (H, W, 3) float32 R, G, B, read-only; the mean of all is 1.
        """
        return _linear(self.path(time_s), sensor)[0]

    def colour(self, time_s: float, sensor: Sensor) -> NDArray[np.float64]:
        """(3,) the mean of ``linear`` over the image."""
        return _linear(self.path(time_s), sensor)[1]


# Both cameras of one simulation, now and a moment ago.
@lru_cache(maxsize=4)
def _linear(path: Path, sensor: Sensor) -> tuple[Image, NDArray[np.float64]]:
    """(H, W, 3) float32 light that the sensor turns into the photograph, and (3,) its mean."""
    rgb = _cut(read_still(path), sensor.width, sensor.height)[..., ::-1]
    encoded = rgb.astype(np.float32) / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    before = np.linalg.inv(sensor.colour_matrix).astype(np.float32)
    light = np.maximum(linear.astype(np.float32) @ before.T, 0)
    light /= max(float(light.mean()), 1e-6)
    light.setflags(write=False)
    return light, light.mean(axis=(0, 1), dtype=np.float64)


def _cut(picture: NDArray[np.uint8], width: int, height: int) -> NDArray[np.uint8]:
    """The largest middle part of that shape, scaled to width x height."""
    high, wide = picture.shape[:2]
    scale = max(width / wide, height / high)
    cut_wide, cut_high = min(wide, round(width / scale)), min(high, round(height / scale))
    left, top = (wide - cut_wide) // 2, (high - cut_high) // 2
    middle = picture[top : top + cut_high, left : left + cut_wide]
    method = cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR
    return np.asarray(cv2.resize(middle, (width, height), interpolation=method), np.uint8)
