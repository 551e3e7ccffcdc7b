"""Maxima of the scale-normalised Laplacian of Gaussian of a mask, over place and scale."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from cv2.typing import MatLike
from numpy.typing import NDArray

# Standard deviations of the Gaussians, pixels, half an octave apart: spots of 1.4 to 23
# pixels radius, a marker from beyond five metres to half a metre at 640 x 480.
SIGMAS = tuple(2 ** (k / 2) for k in range(9))

# A disc answers with up to 2/e = 0.74, a long bar with at most 0.48, an edge with 0.24:
# halfway between disc and bar asks for roundness.
MIN_RESPONSE = 0.5

# Side of the blocks, pixels, that tell where a mask has anything at all; a multiple of 8.
_BLOCK = 32

_Box = tuple[int, int, int, int]  # x0, y0, x1, y1


@dataclass(frozen=True, slots=True)
class Spot:
    """Centre and radius in pixels; response of the scale-normalised filter, 0..1."""

    x: float
    y: float
    radius: float
    response: float


def find_peaks(mask: NDArray[np.uint8]) -> list[Spot]:
    """Local maxima of at least MIN_RESPONSE at each of SIGMAS.

    ``mask`` is (H, W) uint8, 0 or 255.  The order is that of the scales, then row by row.
    """
    height, width = mask.shape
    unit = np.asarray(mask.astype(np.float32) / 255, np.float32)
    regions = _regions(mask)
    grids = {1: unit}
    peaks = []
    for sigma in SIGMAS:
        # A wide Gaussian needs no fine grid; a quarter of the work each octave.
        step = 1 << max(0, int(np.log2(sigma)) - 1)
        columns, rows = max(1, width // step), max(1, height // step)
        if step not in grids:
            coarse = cv2.resize(unit, (columns, rows), interpolation=cv2.INTER_AREA)
            grids[step] = np.asarray(coarse, np.float32)
        boxes = regions if step == 1 else [(0, 0, columns, rows)]
        scale_x, scale_y = width / columns, height / rows
        for x, y, response in _maxima(grids[step], sigma / step, boxes):
            peaks.append(
                Spot(
                    (x + 0.5) * scale_x - 0.5,
                    (y + 0.5) * scale_y - 0.5,
                    float(np.sqrt(2) * sigma),
                    response,
                )
            )
    return peaks


def _regions(mask: NDArray[np.uint8]) -> list[_Box]:
    """Boxes that hold all pixels that are set; one box where many are."""
    height, width = mask.shape
    rows, columns = -(-height // _BLOCK), -(-width // _BLOCK)
    padded = np.zeros((rows * _BLOCK, columns * _BLOCK), np.uint8)
    padded[:height, :width] = mask
    words = padded.view(np.uint64).reshape(rows, _BLOCK, columns, -1)
    filled = np.asarray(np.bitwise_or.reduce(words, axis=(1, 3)) != 0, np.uint8)
    if 3 * np.count_nonzero(filled) > filled.size:  # overlapping boxes would cost more
        return [(0, 0, width, height)]
    _, _, boxes, _ = cv2.connectedComponentsWithStats(filled, connectivity=8)
    return [
        (_BLOCK * x, _BLOCK * y, min(width, _BLOCK * (x + w)), min(height, _BLOCK * (y + h)))
        for x, y, w, h, _ in boxes[1:].tolist()
    ]


def _maxima(
    grid: NDArray[np.float32], sigma: float, boxes: list[_Box]
) -> list[tuple[int, int, float]]:
    """Column, row and response of the maxima in and about the boxes, row by row.

    Every cell that is not empty is in a box.
    """
    # A maximum lies among set cells, within a radius of one; the filter reaches 4 sigma.
    near, reach = int(2 * sigma) + 1, int(6 * sigma) + 4
    found = {}
    for x0, y0, x1, y1 in boxes:
        left, top = max(0, x0 - reach), max(0, y0 - reach)
        window = grid[top : y1 + reach, left : x1 + reach]
        for x, y, response in _maxima_of_window(window, sigma):
            x, y = x + left, y + top
            if x0 - near <= x < x1 + near and y0 - near <= y < y1 + near:
                found[y, x] = response
    return [(x, y, response) for (y, x), response in sorted(found.items())]


def _maxima_of_window(grid: NDArray[np.float32], sigma: float) -> list[tuple[int, int, float]]:
    """Those of the grid as it is; only cells that answer strongly are compared with others."""
    curvature = np.asarray(
        cv2.Laplacian(cv2.GaussianBlur(grid, (0, 0), sigma), cv2.CV_32F), np.float32
    )
    # The comparison with rounding to spare; the exact one follows on the few that are left.
    enough = -MIN_RESPONSE / sigma**2 * (1 - 1e-5)
    strong: MatLike | None = cv2.findNonZero((curvature <= enough).view(np.uint8))
    if strong is None:
        return []
    xs, ys = strong.reshape(-1, 2).T
    bordered = cv2.copyMakeBorder(curvature, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=[np.inf])
    around = [bordered[ys + dy, xs + dx] for dy in range(3) for dx in range(3)]
    response = -(sigma**2) * np.stack(around)
    centre = response[4]
    kept = (centre == response.max(axis=0)) & (centre >= MIN_RESPONSE)
    return list(zip(xs[kept].tolist(), ys[kept].tolist(), centre[kept].tolist(), strict=True))
