"""Where exactly a lamp is: the top of its light, smoothed as wide as the lamp is large."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.robust.response import FINEST_CELL, filtered, linear

WIDTHS = tuple(1.4 * 2 ** (k / 2) for k in range(7))
"""Standard deviations of the smoothing, half an octave apart, in steps of a pixel for finest
cells and of as many more for coarser ones: from the lens's blur to a core of a cell's radius,
and the surround of that."""

WIDTH_PER_SPACING = 0.12
"""At most, of the distance to the nearest marker, so that its light hardly pulls."""
SURROUND = 2.0
"""Width of the smoothing that is taken away again, by the first: a neighbour's halo slopes, but
hardly bends, and so no longer pulls the tops of close markers together (0.2 pixels at 5 m)."""
SHIFT_PER_SPACING = 1 / 3
MAX_SHIFT = 8.0
"""A lamp's top is looked for within this of where it was supposed: steps; half the plateau of a
lamp that fills its cells."""

SAMPLING = 0.11
"""Standard error in pixels that a sensor's colour mosaic leaves a small lamp of one colour: of
red and of blue light it sees every fourth pixel."""
FLOOR = 0.03
"""Standard error left to the brightest lamp, by the smoothing's width: what stands behind it
is not flat, and shifts the top."""
INFLATION = 1.4
"""True errors are so much larger than independent noise makes them: water's and JPEG's is not."""

# Standard deviation of the slope of white noise so smoothed, for a width of 1: two Gaussians of
# widths a and b have slopes of the covariance 1 / (2 pi (a^2 + b^2)^2).
_NOISE_SLOPE = float(
    np.sqrt((1 / 4 + 1 / (2 * SURROUND**2) ** 2 - 2 / (1 + SURROUND**2) ** 2) / (2 * np.pi))
)


def refined(
    frame_bgr: NDArray[np.uint8],
    xy: NDArray[np.float64],
    cell: int,
    weights: NDArray[np.float32],
    noise: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Subpixel places of n lamps.

    The light is smoothed by differences of Gaussians of growing width, the top nearby climbed
    to, and the width kept that locates best.  That is the one that fits the lamp (Lindeberg,
    IJCV 30 (1998) 79: the maximum of the scale-normalised Laplacian), so that a core which the
    sensor clips to a plateau is located by its outline and halo, which clip to no side.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    xy : (n, 2) pixels, about where they are.
    cell : pixels, of the scale they were found at.
    weights : (1, 3), the response's filter.
    noise : (n,) standard deviation of the filtered light of cells about each.

    Returns
    -------
    (n, 2) pixels and (n,) standard deviations in x as in y; None where one has no top.
    """
    step = cell // FINEST_CELL
    apart = np.linalg.norm(xy[:, None] - xy[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    spacings = (apart.min(axis=1) / step).tolist()
    tops = [
        _top(frame_bgr, place, step, weights, spacing)
        for place, spacing in zip(xy, spacings, strict=True)
    ]
    found = [top for top in tops if top is not None]
    if len(found) < len(tops):
        return None
    places, per_noise, widths = (np.array(values) for values in zip(*found, strict=True))
    # A cell is so many steps wide, and independent noise averages out by as much.
    sigma = INFLATION * noise * FINEST_CELL * per_noise
    return places, np.hypot(SAMPLING, step * np.hypot(FLOOR * widths, sigma))


def _top(
    frame_bgr: NDArray[np.uint8],
    xy: NDArray[np.float64],
    step: int,
    weights: NDArray[np.float32],
    spacing: float,
) -> tuple[NDArray[np.float64], float, float] | None:
    """The best located top near ``xy``: place, pixels; standard error, steps; width, steps.

    The error is for light whose noise is 1 a step; ``spacing``: in steps, to the next marker.
    """
    reach = min(max(2.0, SHIFT_PER_SPACING * spacing), MAX_SHIFT)
    widths = [w for w in WIDTHS[:-2] if w <= max(WIDTHS[0], WIDTH_PER_SPACING * spacing)]
    side = int(reach + 3 * SURROUND * widths[-1]) + 2
    centre = np.rint(xy)
    across = (2 * side + 1) * step
    corner = np.floor(centre) - across // 2
    patch = cv2.getRectSubPix(frame_bgr, (across, across), (corner + (across - 1) / 2).tolist())
    colour = linear(np.asarray(patch, np.uint8))
    if step > 1:
        colour = np.asarray(
            cv2.resize(colour, (2 * side + 1,) * 2, interpolation=cv2.INTER_AREA), np.float32
        )
    light = filtered(colour, weights)
    best = None
    # The surround of a width is the smoothing of one two places on.
    smoothed = _smoothed(light, len(widths) + 2)
    for width, narrow, wide in zip(widths, smoothed, smoothed[2:], strict=False):
        smooth = narrow - wide
        at = _climbed(smooth, side, max(1, round(width)), reach)
        if at is None:
            continue
        x, y = at
        near = smooth[y - 1 : y + 2, x - 1 : x + 2].astype(np.float64)
        slope = 0.5 * np.array([near[1, 2] - near[1, 0], near[2, 1] - near[0, 1]])
        bend = 2 * near[1, 1] - np.array([near[1, 0] + near[1, 2], near[0, 1] + near[2, 1]])
        if (bend <= 0).any():
            continue
        # A top moves by noise's slope over the bend.
        error = float(_NOISE_SLOPE / (width**2 * bend.min()))
        if best is not None and error >= best[1]:
            continue
        offset = np.array(at) + np.clip(slope / bend, -1, 1)
        best = corner + (offset + 0.5) * step - 0.5, error, width
    return best


def _smoothed(light: NDArray[np.float32], count: int) -> list[NDArray[np.float32]]:
    """The light smoothed by each of the first ``count`` widths, each on top of the one before."""
    layers, before = [light], 0.0
    for width in WIDTHS[:count]:
        more = float(np.sqrt(width**2 - before**2))
        size = 2 * round(3 * more) + 1
        layers.append(np.asarray(cv2.GaussianBlur(layers[-1], (size, size), more), np.float32))
        before = width
    return layers[1:]


def _climbed(
    smooth: NDArray[np.float32], start: int, stride: int, reach: float
) -> tuple[int, int] | None:
    """The top (x, y) uphill of the middle, or None where it is out of reach."""
    x = y = start
    while True:
        window = smooth[y - stride : y + stride + 1, x - stride : x + stride + 1]
        _, _, _, (dx, dy) = cv2.minMaxLoc(window)
        if dx == stride and dy == stride:
            return x, y
        x, y = x + dx - stride, y + dy - stride
        if max(abs(x - start), abs(y - start)) > reach:
            return None
