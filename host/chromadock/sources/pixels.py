"""The pixels of a loaded picture as the detector's order of channels has them, as deep as stored.

Pillow drops 8 of 16 bits where there are colours, so these are read by OpenCV.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from PIL import Image, ImageOps
from PIL.ImageFile import ImageFile

from chromadock.errors import ChromadockError
from chromadock.sources.mosaic import Samples

_SHOWN = ("LA", "P", "PA", "RGB", "RGBA", "RGBX", "CMYK", "YCbCr", "HSV")
"""Pillow's modes that become RGB without a choice of ours."""


def _transposed(samples: Samples) -> Samples:
    return np.swapaxes(samples, 0, 1)


_ORIENTATION = 0x0112
_TURNS: dict[int, tuple[Callable[[Samples], Samples], ...]] = {
    2: (np.fliplr,),
    3: (np.flipud, np.fliplr),
    4: (np.flipud,),
    5: (_transposed,),
    6: (_transposed, np.fliplr),
    7: (_transposed, np.fliplr, np.flipud),
    8: (_transposed, np.flipud),
}
"""What makes a picture upright, by the value of that EXIF tag."""


def loaded(image: ImageFile, number: int, path: Path, place: str) -> Samples:
    """The page that ``image`` stands at, turned upright as its EXIF says.

    Parameters
    ----------
    image
        As Pillow opened it, at page ``number`` from 0 of ``path``.
    place
        Stands in messages.

    Raises
    ------
    ChromadockError
        Where its pixels are of a kind that is not supported.
    Exception
        Of Pillow's, where the picture is not whole.
    """
    deep = _is_deep_colour(image)
    image.load()  # fails where the end is missing
    samples = _deep_colour(path, number, image) if deep else None
    return shown(ImageOps.exif_transpose(image), place) if samples is None else samples


def shown(image: Image.Image, place: str) -> Samples:
    """HxW grey of 8 or 16 bits, or HxWx3 BGR of 8, of any loaded Pillow image."""
    if image.mode == "F":
        raise floating(place)
    if image.mode.startswith("I"):
        grey = np.asarray(image)
        if grey.size and (grey.min() < 0 or grey.max() > 0xFFFF):
            raise too_deep(place)
        return grey.astype(np.uint16)
    if image.mode in ("1", "L"):
        return np.asarray(image.convert("L"))
    if image.mode not in _SHOWN:
        raise ChromadockError(f"{place}: colours of the kind {image.mode}: save it as RGB")
    if image.mode == "P":
        # By way of RGBA, or Pillow warns of transparency that we drop anyway.
        image = image.convert("RGBA")
    return np.asarray(image.convert("RGB"))[:, :, ::-1]


def _is_deep_colour(image: ImageFile) -> bool:
    """True for 16 bits in each of several channels, which Pillow would cut to 8."""
    if image.mode not in ("RGB", "RGBA") or not image.tile:
        return False
    arguments = image.tile[0][3]
    raw, *rest = arguments if isinstance(arguments, tuple) else (arguments,)
    # PPMs with a largest value of their own are scaled rightly by Pillow.
    return str(raw).startswith(("RGB;16", "RGBA;16", "RGBX;16")) or (
        image.format == "PPM" and rest == [0xFFFF]
    )


def _deep_colour(path: Path, number: int, image: ImageFile) -> Samples | None:
    """HxWx3 uint16 BGR as OpenCV reads it, turned upright; None where it cannot."""
    flags = cv2.IMREAD_ANYDEPTH | cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION
    _, pages = cv2.imreadmulti(str(path), number, 1, flags=flags)
    if not pages or pages[0].dtype != np.uint16:
        return None
    samples: Samples = pages[0].astype(np.uint16, copy=False)
    for turn in _TURNS.get(int(image.getexif().get(_ORIENTATION, 1)), ()):
        samples = turn(samples)
    return samples


def floating(place: str) -> ChromadockError:
    """The error for pixels of floating point."""
    return ChromadockError(
        f"{place}: floating point pixels are not supported: save it with 8 or 16 bits"
    )


def too_deep(place: str) -> ChromadockError:
    """The error for pixels of 32 bits."""
    return ChromadockError(f"{place}: 32 bit pixels are not supported: save it with 8 or 16 bits")
