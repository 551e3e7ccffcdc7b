"""Tells the raw mosaic of a colour sensor from a grey picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.errors import ChromadockError

Samples = NDArray[np.uint8] | NDArray[np.uint16]
"""A picture as it is stored: HxW grey, or HxWx3 in the order blue, green, red."""

_SIDE = 512
"""As much of the middle is looked at, in pixels."""
_BLOCK = 32
_LEAST_SHARE = 0.02
_LEAST_SHARE_OF_WHITE = 0.004
"""How strong the pattern has to be in half of the blocks, of the mean and of the range: mosaics of
photographs under water have 0.04 and more of the mean, grey pictures of the same 0.001."""


def check_no_mosaic(samples: Samples, place: str) -> None:
    """Refuse the raw mosaic of a colour sensor, in one channel or in three that are alike.

    Raises
    ------
    ChromadockError
        That names ``place`` and says what to do.
    """
    grey = _grey(samples)
    if grey is None:
        return
    white = 255.0
    if grey.dtype == np.uint16:
        white = 65535.0 if grey.max(initial=0) > 4095 else 4095.0
    if is_mosaic(grey, white):
        raise ChromadockError(
            f"{place}: looks like the raw Bayer mosaic of a colour sensor: demosaic it first, "
            "for instance with OpenCV's cvtColor"
        )


def _grey(samples: Samples) -> Samples | None:
    """The only channel there is, or what all three are; None where there is colour."""
    if samples.ndim == 2:
        return samples
    first = samples[:, :, 0]
    if np.array_equal(first, samples[:, :, 1]) and np.array_equal(first, samples[:, :, 2]):
        return first
    return None


def is_mosaic(grey: Samples, white: float) -> bool:
    """True where every other pixel, and every other row, is brighter all over the picture.

    In a Bayer mosaic the pixels of a 2x2 cell see different colours, so that a cast of colour,
    and water has one, alternates from pixel to pixel: at half of the sampling frequency along
    both axes (x and y), or along each of them.  Rows alone, as of interlaced fields, and
    textures, which do not keep their phase over a block, are no mosaic.

    Parameters
    ----------
    grey
        HxW.
    white
        The largest value that a pixel can have.
    """
    height, width = (min(side, _SIDE) // _BLOCK * _BLOCK for side in grey.shape)
    if not height or not width:
        return False
    # From an even row and column on, as the signs of the pattern are counted from there.
    top, left = (
        (have - want) // 4 * 2 for have, want in zip(grey.shape, (height, width), strict=True)
    )
    cut = grey[top : top + height, left : left + width].astype(np.float32)
    threshold = max(_LEAST_SHARE * float(cut.mean()), _LEAST_SHARE_OF_WHITE * white)
    columns, rows = _alternating(cut, 1), _alternating(cut, 0)
    both = _alternating(columns, 0)
    return _everywhere(both, threshold) or (
        _everywhere(columns, threshold) and _everywhere(rows, threshold)
    )


def _alternating(image: NDArray[np.float32], axis: int) -> NDArray[np.float32]:
    """What alternates from one pixel to the next along an axis, times +1, -1, +1, ...; its
    filter (-1, 2, -1) / 4 has nothing left of what is even or rises evenly."""
    image = np.moveaxis(image, axis, 0)
    padded = np.pad(image, ((1, 1), (0, 0)), mode="reflect")
    found: NDArray[np.float32] = (2 * image - padded[:-2] - padded[2:]) * np.float32(0.25)
    found[1::2] *= -1
    return np.moveaxis(found, 0, axis)


def _everywhere(found: NDArray[np.float32], threshold: float) -> bool:
    """Whether the means of half of the blocks are that far from 0, either way."""
    high, wide = (side // _BLOCK for side in found.shape)
    means = found.reshape(high, _BLOCK, wide, _BLOCK).mean(axis=(1, 3))
    return float(np.median(np.abs(means))) >= threshold
