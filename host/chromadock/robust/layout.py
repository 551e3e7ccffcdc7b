"""The frame at several scales in one image."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

_Number = TypeVar("_Number", np.uint8, np.float32)

FINE_CELL = 4
"""Pixels: the lens, the halo and JPEG spread a far marker's light about as wide, so that a
finer grid only adds noise."""

SMALL_FRAME = 400
"""Rows: a frame with fewer shows far markers closer together, and has finest cells half as wide."""

BORDER = 3
"""Cells about each scale that repeat its outermost."""


def finest_cell(width: int, height: int) -> int:
    """Pixels that the finest cells of frames are wide."""
    return FINE_CELL // 2 if min(width, height) < SMALL_FRAME else FINE_CELL


@dataclass(frozen=True, eq=False, slots=True)
class Places:
    """N cells: ``at`` (N,): index in the flat image; ``scale`` (N,); ``xy`` (N, 2): in cells."""

    at: NDArray[np.intp]
    scale: NDArray[np.intp]
    xy: NDArray[np.intp]


@dataclass(frozen=True, eq=False, slots=True)
class Layout:
    """How one image holds the frame at all scales, the finest first, below each other.

    About each is a border of BORDER cells that repeat its outermost, so that what is around a
    cell is at the same distances in memory wherever the cell is.

    ``cells``: pixels that a cell is wide; ``tops``: the first row; ``shapes``: rows and columns,
    border not counted; ``shape``: of the image.
    """

    cells: tuple[int, ...]
    tops: NDArray[np.intp]
    shapes: NDArray[np.intp]
    shape: tuple[int, int]

    @classmethod
    @lru_cache(maxsize=4)
    def of(cls, height: int, width: int, coarsest: float) -> Layout:
        """For frames of ``height`` x ``width`` pixels and cells of up to ``coarsest``."""
        cells = [finest_cell(width, height)]
        while 2 * cells[-1] <= coarsest:
            cells.append(2 * cells[-1])
        shapes = np.array([(height // cell, width // cell) for cell in cells])
        ends = np.cumsum(shapes[:, 0] + 2 * BORDER)
        tops = np.append(0, ends[:-1]) + BORDER
        return cls(tuple(cells), tops, shapes, (int(ends[-1]), int(shapes[0, 1]) + 2 * BORDER))

    def inside(self, scale: int) -> tuple[slice, slice]:
        """Rows and columns of a scale without its border."""
        top, (height, width) = int(self.tops[scale]), self.shapes[scale].tolist()
        return slice(top, top + height), slice(BORDER, BORDER + width)

    def at(self, scale: int, row: NDArray[np.intp], column: NDArray[np.intp]) -> NDArray[np.intp]:
        """Index of cells of a scale in the flat image."""
        return np.asarray((self.tops[scale] + row) * self.shape[1] + column + BORDER)

    def places(self, at: NDArray[np.intp]) -> Places:
        """Where cells (N,) are, by their index."""
        row, column = np.divmod(at, self.shape[1])
        scale = np.searchsorted(self.tops, row, side="right") - 1
        return Places(at, scale, np.array([column - BORDER, row - self.tops[scale]]).T)

    def together(self, images: list[NDArray[_Number]]) -> NDArray[_Number]:
        """One image of all scales' (h, w, ...), each with its border."""
        together = np.zeros(self.shape + images[0].shape[2:], images[0].dtype)
        for top, image in zip(self.tops.tolist(), images, strict=True):
            height, width = image.shape[:2]
            place = together[top - BORDER : top + height + BORDER, : width + 2 * BORDER]
            cv2.copyMakeBorder(image, *(BORDER,) * 4, cv2.BORDER_REPLICATE, place)
        return together
