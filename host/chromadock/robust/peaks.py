"""Places in a response that look like lamps: round, alone, adding light and no colour less."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.robust.layout import BORDER, Layout
from chromadock.robust.likeness import Looks, log_likeness
from chromadock.robust.response import Response

MIN_SNR = 3.0
"""At the finest scale.  Below it noise alone has so many peaks that no constellation could
stand out.  As much more at a coarser scale as its cells are wider: what fills them is near."""

MAX_PEAKS = 112
"""The strongest of each scale are kept, so that any frame takes bounded time."""

MAX_PROMISING = 56
"""Of these so many are searched for markers."""

# A lamp between four cells has half its signal to noise in each; noise would seldom add more.
_CELL_SHARE = 0.7
# Looked at closely, of all that stand out.
_MAX_SUMMITS = 3 * MAX_PEAKS
# Clutter grows rarer with about this power of its strength.
_WORTH = 2.0
# Natural log: less is kept by no lamp that matters.
_LEAST_LIKENESS = -5.0
# Cells within which a peak may belong to a higher one, and where the way there is looked at.
_NEARBY = 12
_STEPS = np.arange(1, 8)[:, None] / 8

# Rings that tell ridges, in cells; eight directions, those opposite four apart.
_DOWN = np.array([0, 1, 1, 1, 0, -1, -1, -1])[:, None]
_ACROSS = np.array([1, 1, 0, -1, -1, -1, 0, 1])[:, None]
_RADII = np.array([2, 3])[:, None, None]
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
    likeness: NDArray[np.float64]
    best: NDArray[np.uint8]
    promising: NDArray[np.intp]


def find_peaks(response: Response) -> dict[int, Peaks]:
    """Local maxima that a lamp may have made, MAX_PEAKS at most of each scale; by its cells."""
    layout, snr, stride = response.layout, response.snr, response.layout.shape[1]
    least, worth = _thresholds(layout)
    at = np.flatnonzero((snr > worth) & (snr >= cv2.dilate(snr, _SQUARE)))
    values = snr.ravel()
    near, centre = values[at + _ring(stride, 1)], values[at]
    strength = _brightest(centre, near)
    bright = np.flatnonzero(strength >= least[at // stride])
    order = bright[np.argsort(-strength[bright], kind="stable")[:_MAX_SUMMITS]]
    at, near, centre = at[order], near[:, order], centre[order]

    shift, flatness = _paraboloid(centre, near)
    places = layout.places(at)
    looks = _looks(response, at, centre, flatness, places.scale)
    likeness = log_likeness(looks, strength[order], places.scale)
    cell = np.array(layout.cells)[places.scale]
    noise = np.maximum(response.excess(at), 1e-6) / centre
    xy = (places.xy + shift.T + 0.5) * cell[:, None] - 0.5
    chroma = response.chroma(response.added_at(at))
    strongest = strength[order].astype(np.float64)
    found = {}
    for k, width in enumerate(layout.cells):
        these = np.flatnonzero(places.scale == k)[:MAX_PEAKS]
        found[width] = Peaks(
            xy[these],
            strongest[these],
            noise[these],
            chroma[these],
            likeness[these],
            response.best.ravel()[at[these]],
            _promising(strongest[these], likeness[these]),
        )
    return found


def _promising(snr: NDArray[np.float64], likeness: NDArray[np.float64]) -> NDArray[np.intp]:
    """Which peaks are searched for markers: likelier lamps than clutter as strong is common."""
    score = likeness + _WORTH * np.log(snr)
    score[likeness < _LEAST_LIKENESS] = -np.inf
    best = np.argsort(-score, kind="stable")[:MAX_PROMISING]
    return np.sort(best[np.isfinite(score[best])])


def _looks(
    response: Response,
    at: NDArray[np.intp],
    centre: NDArray[np.float32],
    flatness: NDArray[np.float32],
    scale: NDArray[np.intp],
) -> Looks:
    """What is seen about N peaks, the strongest first."""
    values, stride = response.snr.ravel(), response.layout.shape[1]
    sides = values[at + _ring(stride, _RADII)] / centre
    ridge = np.minimum(sides[:, :4], sides[:, 4:]).max(axis=(0, 1))
    light = response.light.reshape(-1, 3)
    around = np.sort(light.take(at + _ring(stride, BORDER), axis=0), axis=0)
    deviation = np.sqrt(np.diag(response.covariance)).astype(np.float32)
    missing = np.maximum((around[1] - light[at]) / deviation, 0).max(axis=1)
    adds = np.maximum((light[at] - around[6]) / deviation, 0).max(axis=1)
    return Looks(
        flatness,
        ridge,
        sides[1].mean(axis=0),
        np.sort(sides[1], axis=0)[-2],
        _saddles(values, at, centre, stride, scale),
        missing / (adds + missing + 1),
    )


def _saddles(
    values: NDArray[np.float32],
    at: NDArray[np.intp],
    centre: NDArray[np.float32],
    stride: int,
    scale: NDArray[np.intp],
) -> NDArray[np.float64]:
    """(N,) the least on the straight way to a higher peak nearby over each peak's own height; of
    several the largest, 0 where there is none."""
    y, x = np.divmod(at, stride)
    apart = np.hypot(y[:, None] - y, x[:, None] - x)
    higher = (centre > centre[:, None]) & (scale == scale[:, None])
    own, other = np.nonzero((apart < _NEARBY) & higher)
    down = np.rint(y[own] + (y[other] - y[own]) * _STEPS).astype(np.intp)
    across = np.rint(x[own] + (x[other] - x[own]) * _STEPS).astype(np.intp)
    saddles = np.zeros(len(at))
    np.maximum.at(saddles, own, values[down * stride + across].min(axis=0) / centre[own])
    return saddles


@lru_cache(maxsize=4)
def _thresholds(layout: Layout) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The least signal to noise of peaks in each row, and of cells (H, W) worth a look.

    One in from the border of each scale, so that a peak has neighbours on all sides.
    """
    least = np.full(layout.shape[0], np.inf, np.float32)
    worth = np.full(layout.shape, np.inf, np.float32)
    for scale, cell in enumerate(layout.cells):
        rows, columns = layout.inside(scale)
        least[rows] = MIN_SNR * cell / layout.cells[0]
        inner = slice(rows.start + 1, rows.stop - 1), slice(columns.start + 1, columns.stop - 1)
        worth[inner] = _CELL_SHARE * MIN_SNR * cell / layout.cells[0]
    return least, worth


def gained(response: Response, at: NDArray[np.intp]) -> NDArray[np.float32]:
    """Light (N, 3) of cells beyond what is taken to be behind them, by their index."""
    light = response.light.reshape(-1, 3)
    around = light.take(at + _ring(response.layout.shape[1], BORDER), axis=0)
    return np.asarray(light[at] - _second(around), np.float32)


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
    """Of the top through 3 x 3 values: x, y (2, N) within half a cell, and flatness (N,).

    ``near`` (8, N) are the ring of radius 1.
    """
    ahead, behind = near[:4:2], near[4::2]  # right and down, left and up
    xx, yy = bend = 2 * centre - ahead - behind
    xy = (near[3] + near[7] - near[1] - near[5]) / 4
    flatness = 1 - 4 * (xx * yy - xy * xy) / np.maximum((xx + yy) ** 2, 1e-12)
    return np.clip((ahead - behind) / np.maximum(2 * bend, 1e-6), -0.5, 0.5), flatness
