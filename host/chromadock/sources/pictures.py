"""One picture, or a folder of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from PIL import Image, UnidentifiedImageError

from chromadock.errors import ChromadockError
from chromadock.sources.base import Frame, OnFault, Source
from chromadock.sources.still import read_still

IMAGE_SUFFIXES = frozenset(
    (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".ppm", ".pgm", ".pnm")
)


class Pictures(Source):
    """Picture files in the given order; frame ``i`` is at ``i / fps`` seconds.

    A file that cannot be read is reported, counted in ``errors`` and left out; its index
    and time stay free.  With ``single`` it raises instead.
    """

    def __init__(
        self,
        paths: Sequence[Path],
        names: Sequence[str],
        fps: float,
        on_fault: OnFault,
        single: bool = False,
    ) -> None:
        self.count = len(paths)
        self.fps = fps
        self.places = frozenset(paths) | frozenset(path.parent for path in paths)
        self._paths = paths
        self._names = names
        self._on_fault = on_fault
        self._single = single

    def __iter__(self) -> Iterator[Frame]:
        self.errors = 0
        for index, (path, name) in enumerate(zip(self._paths, self._names, strict=True)):
            try:
                image = read_still(path)
            except ChromadockError as error:
                if self._single:
                    raise
                self.errors += 1
                self._on_fault(f"{error} (skipped)")
                continue
            yield Frame(image, name, index, index / self.fps)


def is_picture(path: Path) -> bool:
    """True for files named like a picture, and for nameless ones that start like one."""
    if path.suffix.lower() in IMAGE_SUFFIXES:
        return True
    if path.suffix:
        return False
    try:
        with Image.open(path):
            return True
    except (UnidentifiedImageError, OSError):
        return False
