"""One picture, or a folder of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from PIL import Image, UnidentifiedImageError

from chromadock.errors import ChromadockError
from chromadock.sources.base import Frame, OnFault, Source
from chromadock.sources.depth import Depth
from chromadock.sources.still import count_pages, read_pages

IMAGE_SUFFIXES = frozenset(
    (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".ppm", ".pgm", ".pnm", ".avif")
)


class Pictures(Source):
    """Picture files in the given order; frame ``i`` is at ``i / fps`` seconds.

    Each page of a TIFF is a frame.  A picture that cannot be read is reported, counted in
    ``errors`` and left out; its index and time stay free.  With ``single`` it raises instead,
    where it is the first.
    """

    def __init__(
        self,
        paths: Sequence[Path],
        names: Sequence[str],
        fps: float,
        on_fault: OnFault,
        on_note: OnFault,
        single: bool = False,
    ) -> None:
        self.count = count_pages(paths[0]) if single else len(paths)
        self.fps = fps
        self.places = frozenset(paths) | frozenset(path.parent for path in paths)
        self._paths = paths
        self._names = names
        self._on_fault = on_fault
        self._on_note = on_note
        self._single = single

    def __iter__(self) -> Iterator[Frame]:
        self.errors = 0
        depth = Depth(self._on_note)
        index = 0
        for path, name in zip(self._paths, self._names, strict=True):
            for page in read_pages(path, depth):
                if not isinstance(page, ChromadockError):
                    yield Frame(page, name, index, index / self.fps)
                elif self._single and index == 0:
                    raise page
                else:
                    self.errors += 1
                    self._on_fault(f"{page} (skipped)")
                index += 1


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
