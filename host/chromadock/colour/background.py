"""The water's colour: the fullest grey interval and the mean of its pixels."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock import method, method_tables
from chromadock._native import ffi, lib
from chromadock.colour.hsv import TABLES, hue_of_vector, pointer, rgb_from_hsv

_SINE = pointer(method_tables.SINE)


@dataclass(frozen=True, slots=True)
class BackgroundColour:
    """Every value on the way to the background colour, as in the C ``background_t``.

    Hue 0..1535; saturation, value, resultant (mean hue vector's length), share
    (of the image) and confidence (the product of both) 0..255; ``meaningful`` is
    False for grey water, night or a mixture of hues: the only one that differs from dock to
    vehicle.
    """

    bin_counts: tuple[int, ...]
    bin: int
    hue_x: int
    hue_y: int
    chroma_sum: int
    saturation_sum: int
    value_sum: int
    hue: int
    saturation: int
    value: int
    resultant: int
    share: int
    confidence: int
    meaningful: bool

    @property
    def rgb(self) -> tuple[int, int, int]:
        """The mean colour, 0..255 a channel."""
        return rgb_from_hsv(self.hue, self.saturation, self.value)


def grey_range(bin: int) -> tuple[int, int]:
    """Least and greatest grey 0..255 of an interval."""
    first = -(-256 * bin // method.GREY_BINS)
    after = -(-256 * (bin + 1) // method.GREY_BINS)
    return first, after - 1


def background_colour(
    image: NDArray[np.uint8], min_value: int = method.MIN_VALUE
) -> BackgroundColour:
    """The background of a smoothed working image.

    Parameters
    ----------
    image : (60, 80, 3) uint8 RGB.
    min_value : 0..255; a darker background means nothing.  The dock's unless given; the
        vehicle's, which sees the lamps glow, is ``method.MIN_VALUE_VEHICLE``.
    """
    sums = ffi.new("hue_sums_t[]", method.GREY_BINS)
    pixels = ffi.from_buffer("uint8_t[]", np.ascontiguousarray(image))
    grey = ffi.from_buffer("uint8_t[]", cv2.cvtColor(image, cv2.COLOR_RGB2GRAY))
    size = len(grey)
    lib.hue_sum(TABLES, _SINE, pixels, grey, size, method.GREY_BINS, sums)
    counts = tuple(each.count for each in sums)
    n = max(counts)
    fullest = counts.index(n)  # the first of equals: ties go to the darker
    of_fullest = sums[fullest]
    x, y, chroma_sum = of_fullest.x, of_fullest.y, of_fullest.chroma
    saturation_sum, value_sum = of_fullest.saturation, of_fullest.value

    mean_saturation = (2 * saturation_sum + n) // (2 * n)
    mean_value = (2 * value_sum + n) // (2 * n)
    share = (510 * n + size) // (2 * size)
    mean_hue = hue_of_vector(x, y)
    resultant = 0 if mean_hue is None else _resultant(x, y, mean_hue, chroma_sum)
    return BackgroundColour(
        bin_counts=counts,
        bin=fullest,
        hue_x=x,
        hue_y=y,
        chroma_sum=chroma_sum,
        saturation_sum=saturation_sum,
        value_sum=value_sum,
        hue=mean_hue or 0,
        saturation=mean_saturation,
        value=mean_value,
        resultant=resultant,
        share=share,
        confidence=(resultant * share + 127) // 255,
        meaningful=mean_saturation >= method.MIN_SATURATION
        and mean_value >= min_value
        and resultant >= method.MIN_RESULTANT,
    )


def _resultant(x: int, y: int, mean_hue: int, chroma_sum: int) -> int:
    """Length of the mean hue vector over the mean chroma, by projection, 0..255."""
    quarter = method.HUE_RANGE // 4
    along = x * int(method_tables.SINE[mean_hue + quarter]) + y * int(method_tables.SINE[mean_hue])
    length = along // method.TRIG_UNIT**2
    return min(255, (510 * length + chroma_sum) // (2 * chroma_sum))
