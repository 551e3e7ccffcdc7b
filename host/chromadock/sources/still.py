"""Decodes picture files to BGR.

Pillow does it, because it notices a truncated file; OpenCV fills the rest with grey and
says nothing.
"""

from __future__ import annotations

import io
import itertools
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps, UnidentifiedImageError
from PIL.ImageFile import ImageFile

from chromadock.errors import ChromadockError
from chromadock.sources.depth import Depth
from chromadock.sources.kinds import check_readable, check_tiff, tiff_tags
from chromadock.sources.mosaic import check_no_mosaic
from chromadock.sources.pixels import floating, loaded, shown, too_deep
from chromadock.text import one_line

MAX_PIXELS = 80_000_000
"""No camera frame is larger; a broken header easily claims to be."""

_STACKS = ("TIFF", "PNG", "WEBP")
"""Kinds of files whose pages are frames; a JPEG's are other views and previews of the first."""
_SUBFILE = 254
_NO_FRAME = 1 | 4
"""Bits of that TIFF tag: a smaller copy of another page, a mask."""


def read_still(path: Path) -> NDArray[np.uint8]:
    """The picture as HxWx3 uint8 BGR, turned upright as its EXIF says; the first of several.

    Greyscale and palettes become three channels, transparency is dropped, and of 16 bits
    the upper 8 are taken, of 12 in 16 the upper 8 of the 12.

    Raises
    ------
    ChromadockError
        One line, where the file is missing, broken, too large, or of another kind.
    """
    for page in read_pages(path, Depth()):
        if isinstance(page, ChromadockError):
            raise page
        return page
    raise ChromadockError(f"{path}: no picture in it: copy it again or remove it")


def read_pages(path: Path, depth: Depth) -> Iterator[NDArray[np.uint8] | ChromadockError]:
    """Each page of the file as ``read_still`` has it, or why it cannot be read.

    ``depth`` is that of all the source's pictures.
    """
    opened = _opened(path)
    if isinstance(opened, ChromadockError):
        yield opened
        return
    with opened:
        for number in _frames(opened, path):
            if isinstance(number, ChromadockError):
                yield number
            else:
                yield _page(opened, number, path, depth)


def count_pages(path: Path) -> int:
    """How many pictures are in the file; 1 where it cannot be read."""
    opened = _opened(path)
    if isinstance(opened, ChromadockError):
        return 1
    with opened:
        return sum(1 for _ in _frames(opened, path))


def _opened(path: Path) -> ImageFile | ChromadockError:
    try:
        with _quiet():
            check_readable(path)
            return Image.open(path)
    except Exception as error:  # each of Pillow's decoders raises its own kinds
        return _fault(error, path)


def _frames(image: ImageFile, path: Path) -> Iterator[int | ChromadockError]:
    """The numbers of the pages that are frames; last, where it is so, why there are no more."""
    yield 0
    if image.format not in _STACKS:
        return
    for number in itertools.count(1):
        try:
            with _quiet():
                image.seek(number)
        except EOFError:
            return
        except Exception as error:
            yield _fault(error, _place(path, number))
            return
        if not int(tiff_tags(image).get(_SUBFILE, 0)) & _NO_FRAME:
            yield number


def _page(
    image: ImageFile, number: int, path: Path, depth: Depth
) -> NDArray[np.uint8] | ChromadockError:
    place = _place(path, number)
    try:
        with _quiet():
            image.seek(number)
            _check_size(image, place)
            check_tiff(path, image)
            samples = loaded(image, number, path, place)
        check_no_mosaic(samples, place)
        return depth.bgr(samples, place)
    except Exception as error:
        return _fault(error, place)


def _check_size(image: ImageFile, place: str) -> None:
    if image.width * image.height > MAX_PIXELS:
        raise ChromadockError(
            f"{place}: {image.width}x{image.height} pixels are too many: "
            f"give frames of at most {MAX_PIXELS // 1_000_000} million"
        )


def _place(path: Path, number: int) -> str:
    return f"{path}, page {number + 1}" if number else str(path)


@contextmanager
def _quiet() -> Iterator[None]:
    """Pillow warns of harmless metadata; what we have to say is one line."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def _fault(error: Exception, place: Path | str) -> ChromadockError:
    """The line about a file or page that cannot be read."""
    if isinstance(error, ChromadockError):
        return error
    if isinstance(error, MemoryError):
        raise error
    if isinstance(error, FileNotFoundError):
        return ChromadockError(f"{place}: no such file: check the name")
    if isinstance(error, UnidentifiedImageError) and isinstance(place, Path):
        decoded = cv2.imread(str(place), cv2.IMREAD_UNCHANGED)
        if decoded is not None and decoded.dtype.kind == "f":  # three channels are none to Pillow
            return floating(str(place))
        if decoded is not None and decoded.dtype.itemsize > 2:
            return too_deep(str(place))
    return ChromadockError(
        f"{place}: not a whole picture ({_reason(error, place)}): copy it again or remove it"
    )


def decode_still(data: bytes, name: str) -> NDArray[np.uint8]:
    """A picture file's content HxWx3 uint8 BGR; messages have ``name`` in the file's place.

    Raises
    ------
    ChromadockError
        One line, where it is broken, too large, or of another kind.
    """
    try:
        with _quiet(), Image.open(io.BytesIO(data)) as image:
            _check_size(image, name)
            image.load()
            return Depth().bgr(shown(ImageOps.exif_transpose(image), name), name)
    except Exception as error:
        raise _fault(error, name) from None


def _reason(error: Exception, path: Path | str) -> str:
    """Pillow's words without the path, which our line already has."""
    text = one_line(error).replace(repr(str(path)), "the file").replace(str(path), "the file")
    return text or type(error).__name__
