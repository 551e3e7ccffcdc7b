"""Places in a response that look like lamps: round, alone, adding light and no colour less."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.robust.response import FINEST_CELL, Response, Scale

MIN_SNR = 3.0
"""At the finest scale.  Below it noise alone has so many peaks that no constellation could
stand out.  As much more at a coarser scale as its cells are wider: what fills them is near."""

MAX_PEAKS = 56
"""The strongest are kept, so that any frame takes bounded time.  Where glitter has more, a dock
is seldom told from it: a third more peaks would find one dock in 400 more at 4 m."""

# A lamp between four cells has half its signal to noise in each; noise would seldom add more.
_CELL_SHARE = 0.7
# Looked at closely, of all that stand out.
_MAX_SUMMITS = 3 * MAX_PEAKS
# Four times determinant over squared trace of the Hessian: 1 for a round top, 0 on a ridge.
# Markers that touch half a neighbour stay above a third; struts and edges do not.
_MIN_ROUNDNESS = 0.35
# A pole goes on to both sides of its peaks: the weaker side over the peak.  Neighbouring
# markers stand on one side only; of true markers at 4 m one in a hundred has more.
_MAX_RIDGE = 0.7
# A lamp takes light away from no channel of what is behind it.  That is taken to be as dark as
# the second darkest of eight places about: a buoy beside it may be brighter, and one place may
# be a dark edge.  A lamp's dark holder takes some; but painted parts of a dock, which form
# constellations of their own where this is let pass, take more.  Standard deviations of noise.
_MOST_MISSING = 3.0

# Rings that tell ridges, in cells; eight directions, those opposite four apart.
_DOWN = np.array([0, 1, 1, 1, 0, -1, -1, -1])[:, None]
_ACROSS = np.array([1, 1, 0, -1, -1, -1, 0, 1])[:, None]
_RADII = np.array([2, 3])[:, None, None]
_BORDER = 3
_SQUARE = np.ones((3, 3), np.uint8)


@dataclass(frozen=True, slots=True)
class Peaks:
    """Strongest first.

    ``xy`` (N, 2) float64: pixels of the frame.  ``snr`` (N,) float64: signal to noise of the
    brightest 2 x 2 cells about each: wherever in a cell a lamp falls, they catch its light.
    ``noise`` (N,) float64: standard deviation of the filtered light of cells thereabouts.
    ``chroma`` (N, 2) float64: radians, see ``Response.chroma``.
    """

    xy: NDArray[np.float64]
    snr: NDArray[np.float64]
    noise: NDArray[np.float64]
    chroma: NDArray[np.float64]


_NONE = Peaks(np.empty((0, 2)), np.empty(0), np.empty(0), np.empty((0, 2)))


def find_peaks(response: Response, scale: Scale) -> Peaks:
    """Local maxima of one scale that a lamp may have made, MAX_PEAKS at most."""
    least = MIN_SNR * scale.cell / FINEST_CELL
    highest = np.asarray(cv2.dilate(scale.snr, _SQUARE))
    summits = (scale.snr > least * _CELL_SHARE) & (scale.snr >= highest)
    # One value in from the border, so that a peak has neighbours on all sides.
    summits[[0, -1]] = summits[:, [0, -1]] = False
    rows, columns = np.divmod(np.flatnonzero(summits), summits.shape[1])
    padded = cv2.copyMakeBorder(scale.snr, *(_BORDER,) * 4, cv2.BORDER_REPLICATE)
    values, stride = padded.ravel(), padded.shape[1]
    at = (rows + _BORDER) * stride + columns + _BORDER
    near, centre = values[at + _ring(stride, 1)], values[at]
    snr = _brightest(centre, near)
    bright = np.flatnonzero(snr >= least)
    if not len(bright):
        return _NONE
    order = bright[np.argsort(-snr[bright], kind="stable")[:_MAX_SUMMITS]]
    at, near, centre = at[order], near[:, order], centre[order]

    shift, roundness = _paraboloid(centre, near)
    sides = values[at + _ring(stride, _RADII)]
    ridge = np.minimum(sides[:, :4], sides[:, 4:]).max(axis=(0, 1)) / centre
    kept = np.flatnonzero((roundness > _MIN_ROUNDNESS) & (ridge < _MAX_RIDGE))
    row, column = rows[order[kept]], columns[order[kept]]
    added = gained(scale.light, row, column)
    per_channel = np.sqrt(np.diag(response.covariance))
    good = (added > -_MOST_MISSING * per_channel).all(axis=1)
    true = np.flatnonzero(good)[:MAX_PEAKS]
    if not len(true):
        return _NONE
    kept, row, column = kept[true], row[true], column[true]
    cells = np.column_stack([column, row]) + shift[:, kept].T
    noise = np.asarray(scale.excess[row, column] / centre[kept], np.float64)
    xy = (cells + 0.5) * scale.cell - 0.5
    strength = snr[order[kept]].astype(np.float64)
    chroma = response.chroma(scale, row, column)
    return Peaks(np.asarray(xy, np.float64), strength, noise, chroma)


def gained(
    light: NDArray[np.float32], row: NDArray[np.intp], column: NDArray[np.intp]
) -> NDArray[np.float32]:
    """Light (N, 3) of cells beyond what is taken to be behind them, of (h, w, 3) light."""
    height, width = light.shape[:2]
    y = np.clip(row + _BORDER * _DOWN, 0, height - 1)
    x = np.clip(column + _BORDER * _ACROSS, 0, width - 1)
    around = light.reshape(-1, 3).take(y * width + x, axis=0)
    return np.asarray(light[row, column] - _second(around), np.float32)


def _second(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """The second least of eight along the first axis: of pairs, of fours, of all."""
    least, second = np.minimum(values[:4], values[4:]), np.maximum(values[:4], values[4:])
    for half in (2, 1):
        greater = np.maximum(least[:half], least[half:])
        second = np.minimum(np.minimum(second[:half], second[half:]), greater)
        least = np.minimum(least[:half], least[half:])
    return np.asarray(second[0], np.float32)


def _ring(stride: int, radius: int | NDArray[np.intp]) -> NDArray[np.intp]:
    """Flat offsets (8, 1) of the eight directions, for each radius."""
    return np.asarray(radius * (_DOWN * stride + _ACROSS))


def _brightest(centre: NDArray[np.float32], near: NDArray[np.float32]) -> NDArray[np.float32]:
    """Signal to noise of the brightest 2 x 2 values of 3 x 3; ``near`` (8, N) are the ring."""
    quadrants = near[::2] + near[1::2] + near[[2, 4, 6, 0]]
    return np.asarray((centre + np.maximum(quadrants.max(axis=0), 0)) / 2, np.float32)


def _paraboloid(
    centre: NDArray[np.float32], near: NDArray[np.float32]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Of the top through 3 x 3 values: x, y (2, N) within half a cell, and roundness (N,).

    ``near`` (8, N) are the ring of radius 1.
    """
    ahead, behind = near[:4:2], near[4::2]  # right and down, left and up
    xx, yy = bend = 2 * centre - ahead - behind
    xy = (near[3] + near[7] - near[1] - near[5]) / 4
    roundness = 4 * (xx * yy - xy * xy) / np.maximum((xx + yy) ** 2, 1e-12)
    return np.clip((ahead - behind) / np.maximum(2 * bend, 1e-6), -0.5, 0.5), roundness
