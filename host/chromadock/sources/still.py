"""Decodes one picture file to BGR.

Pillow does it, because it notices a truncated file; OpenCV fills the rest with grey and
says nothing.
"""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps

from chromadock.errors import ChromadockError
from chromadock.text import one_line

MAX_PIXELS = 80_000_000
"""No camera frame is larger; a broken header easily claims to be."""


def read_still(path: Path) -> NDArray[np.uint8]:
    """The picture as HxWx3 uint8 BGR, turned upright as its EXIF says.

    Greyscale and palettes become three channels, transparency is dropped, and of 16 bits
    the upper 8 are taken.

    Raises
    ------
    ChromadockError
        One line, where the file is missing, broken, too large or of floating point.
    """
    return _decoded(path, str(path))


def decode_still(data: bytes, name: str) -> NDArray[np.uint8]:
    """The same of a picture file's content; messages have ``name`` in the file's place."""
    return _decoded(io.BytesIO(data), name)


def _decoded(file: Path | io.BytesIO, name: str) -> NDArray[np.uint8]:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about harmless metadata; ours is one line
            with Image.open(file) as opened:
                if opened.width * opened.height > MAX_PIXELS:
                    raise ChromadockError(
                        f"{name}: {opened.width}x{opened.height} pixels are too many: "
                        f"give frames of at most {MAX_PIXELS // 1_000_000} million"
                    )
                opened.load()
                rgb = _rgb(ImageOps.exif_transpose(opened), name)
    except (ChromadockError, MemoryError):
        raise
    except FileNotFoundError:
        raise ChromadockError(f"{name}: no such file: check the name") from None
    except Exception as error:  # each of Pillow's decoders raises its own kinds
        raise ChromadockError(
            f"{name}: not a whole picture ({_reason(error, name)}): copy it again or remove it"
        ) from None
    return np.ascontiguousarray(rgb[:, :, ::-1])


def _rgb(image: Image.Image, name: str) -> NDArray[np.uint8]:
    """HxWx3 uint8 RGB of any loaded Pillow image but floating point."""
    if image.mode == "F":
        raise ChromadockError(
            f"{name}: floating point pixels are not supported: save it with 8 or 16 bits"
        )
    if image.mode.startswith("I"):
        grey = np.asarray(image).astype(np.int64)
        if grey.size and (grey.min() < 0 or grey.max() > 0xFFFF):
            raise ChromadockError(
                f"{name}: 32 bit pixels are not supported: save it with 8 or 16 bits"
            )
        return np.repeat((grey >> 8).astype(np.uint8)[:, :, None], 3, axis=2)
    if image.mode == "P":
        # By way of RGBA, or Pillow warns of transparency that we drop anyway.
        image = image.convert("RGBA")
    return np.asarray(image.convert("RGB"))


def _reason(error: Exception, name: str) -> str:
    """Pillow's words without the path, which our line already has."""
    text = one_line(error).replace(repr(name), "the file").replace(name, "the file")
    return text or type(error).__name__
