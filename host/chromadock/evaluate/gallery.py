"""The sample frames of an evaluation, what each filter made of them, and the colours chosen."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
from cv2.typing import MatLike

from chromadock.errors import ChromadockError

FOLDER = "gallery"
SIDES = ("vehicle", "dock")
SWATCHES = {"background": "water", "pure": "pure", "marker": "marker"}
"""Keys of the file, and what they are called."""

WIDTH = 400
"""Pixels of a picture on the page; larger ones are reduced."""

_JPEG_QUALITY = 82


@dataclass(frozen=True)
class Exhibit:
    """A frame of one run: pictures as data URIs, swatches as CSS colours by side and name."""

    run: str
    frame: str
    masks: Mapping[str, str]
    swatches: Mapping[str, Mapping[str, str]]


def read_gallery(
    out: Path, runs: Sequence[str], filters: Sequence[str], width: int = WIDTH
) -> list[Exhibit]:
    """The exhibits of these runs, reduced to ``width`` pixels.

    Raises
    ------
    ChromadockError
        Where a picture or the swatches are missing or broken.
    """
    folder = out / FOLDER
    return [
        Exhibit(
            run=run,
            frame=_data_uri(folder / f"{run}.jpg", width),
            masks={name: _data_uri(folder / f"{run}.{name}.png", width) for name in filters},
            swatches=_swatches(folder / f"{run}.json"),
        )
        for run in runs
    ]


def _data_uri(path: Path, width: int) -> str:
    """A picture, reduced, as whichever is smaller of PNG and JPEG."""
    picture = cv2.imread(str(path), cv2.IMREAD_COLOR) if path.is_file() else None
    if picture is None:
        raise ChromadockError(f"{path}: no picture in it: evaluate again")
    if picture.shape[1] > width:
        size = (width, round(picture.shape[0] * width / picture.shape[1]))
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    jpeg = _encoded(picture, ".jpg", [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])
    png = _encoded(picture, ".png", [cv2.IMWRITE_PNG_COMPRESSION, 6])
    kind, data = min(("jpeg", jpeg), ("png", png), key=lambda pair: len(pair[1]))
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


def _encoded(picture: MatLike, suffix: str, options: list[int]) -> bytes:
    return bytes(cv2.imencode(suffix, picture, options)[1])


def _swatches(path: Path) -> dict[str, dict[str, str]]:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return {
            side: {
                name: "#{:02x}{:02x}{:02x}".format(*content[side][key])
                for key, name in SWATCHES.items()
            }
            for side in SIDES
        }
    except (OSError, ValueError, KeyError, TypeError, IndexError):
        raise ChromadockError(f"{path}: no swatches in it: evaluate again") from None
