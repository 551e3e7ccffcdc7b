"""Overlays as picture files."""

from __future__ import annotations

import shutil
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.errors import ChromadockError
from chromadock.output.base import OverlayOutput, cannot_write, partial_name
from chromadock.sources.pictures import IMAGE_SUFFIXES

PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg")


class PictureFile(OverlayOutput):
    """The overlay of a source with one frame."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._partial = partial_name(path)

    def write(self, picture: NDArray[np.uint8], name: str, index: int) -> None:
        """Write the picture under the temporary name."""
        if self._partial.exists():  # the number of frames was a guess
            raise ChromadockError(
                f"{self._path}: one picture cannot hold many frames: give a folder or a .mp4"
            )
        _write_picture(self._partial, picture, self._path)

    def keep(self) -> None:
        """Rename the picture to its final name."""
        if self._partial.exists():
            self._partial.replace(self._path)

    def drop(self) -> None:
        """Remove the picture."""
        self._partial.unlink(missing_ok=True)


class PictureFolder(OverlayOutput):
    """A PNG for each frame, named like the frame's file, or by number for a video.

    Pictures gather in a hidden folder beside the final one; files of an earlier run keep
    their place until new ones of the same name replace them.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._partial = partial_name(path)
        self._names: set[str] = set()

    def write(self, picture: NDArray[np.uint8], name: str, index: int) -> None:
        """Write one picture into the temporary folder."""
        try:
            self._partial.mkdir(exist_ok=True)
        except OSError as error:
            raise cannot_write(self._path, error) from None
        target = self._partial / self._free_name(name, index)
        _write_picture(target, picture, self._path)

    def keep(self) -> None:
        """Move the pictures to the final folder."""
        if not self._partial.exists():
            return
        if not self._path.exists():
            self._partial.replace(self._path)
            return
        for picture in self._partial.iterdir():
            picture.replace(self._path / picture.name)
        self._partial.rmdir()

    def drop(self) -> None:
        """Remove the pictures of this run."""
        shutil.rmtree(self._partial, ignore_errors=True)

    def _free_name(self, name: str, index: int) -> str:
        """Unique among this run's: a.png and a.jpg both want to be a.png."""
        stem = Path(name.replace("/", "_").replace("\\", "_"))
        base = stem.stem if stem.suffix.lower() in IMAGE_SUFFIXES else f"{index:06d}"
        if f"{base}.png" in self._names:
            base = f"{base}_{index:06d}"
        self._names.add(f"{base}.png")
        return f"{base}.png"


def _write_picture(target: Path, picture: NDArray[np.uint8], wanted: Path) -> None:
    suffix = target.suffix.lower()
    ok, encoded = cv2.imencode(suffix, picture)
    if not ok:
        raise ChromadockError(f"{wanted}: OpenCV cannot encode {suffix}: give a .png")
    try:
        target.write_bytes(encoded.tobytes())
    except OSError as error:
        raise cannot_write(wanted, error) from None
