"""The frame at several scales in one image."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.native import ffi, lib

FINE_CELL = 4
"""Pixels: the lens, the halo and JPEG spread a far marker's light about as wide.  Cells of the
second scale are as large; those of the finest are half as wide, for markers close together."""

SMALL_FRAME = 400
"""Rows: a frame with fewer shows far markers closer together, and has all cells half as wide."""

BORDER: int = lib.FRONT_BORDER
"""Cells about each scale that repeat its outermost."""


def finest_cell(width: int, height: int) -> int:
    """Pixels that the finest cells of frames are wide."""
    return FINE_CELL // 4 if min(width, height) < SMALL_FRAME else FINE_CELL // 2


@dataclass(frozen=True, eq=False, slots=True)
class Layout:
    """How one image holds the frame at all scales, the finest first, below each other.

    About each is a border of BORDER cells that repeat its outermost, so that what is around a
    cell is at the same distances in memory wherever the cell is.

    ``cells``: pixels that a cell is wide; ``tops``: the first row; ``shapes``: rows and columns,
    border not counted; ``shape``: of the image; ``native``: the same as a ``front_layout_t``.
    """

    cells: tuple[int, ...]
    tops: NDArray[np.intp]
    shapes: NDArray[np.intp]
    shape: tuple[int, int]
    native: Any

    @classmethod
    @lru_cache(maxsize=4)
    def of(cls, height: int, width: int, coarsest: float) -> Layout:
        """For frames of ``height`` x ``width`` pixels and cells of up to ``coarsest``."""
        finest = finest_cell(width, height)
        cells = [finest, 2 * finest]
        while 2 * cells[-1] <= coarsest and len(cells) < lib.FRONT_SCALES:
            cells.append(2 * cells[-1])
        shapes = np.array([(height // cell, width // cell) for cell in cells])
        ends = np.cumsum(shapes[:, 0] + 2 * BORDER)
        tops = np.append(0, ends[:-1]) + BORDER
        shape = int(ends[-1]), int(shapes[0, 1]) + 2 * BORDER
        heights, widths = shapes.T.tolist()
        native = ffi.new(
            "front_layout_t *", (*shape, len(cells), cells, tops.tolist(), heights, widths)
        )
        return cls(tuple(cells), tops, shapes, shape, native)

    def inside(self, scale: int) -> tuple[slice, slice]:
        """Rows and columns of a scale without its border."""
        top, (height, width) = int(self.tops[scale]), self.shapes[scale].tolist()
        return slice(top, top + height), slice(BORDER, BORDER + width)

    def at(self, scale: int, row: NDArray[np.intp], column: NDArray[np.intp]) -> NDArray[np.intp]:
        """Index of cells of a scale in the flat image."""
        return np.asarray((self.tops[scale] + row) * self.shape[1] + column + BORDER)
