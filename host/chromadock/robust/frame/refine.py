"""Where exactly a lamp is: the top of its light, smoothed as wide as the lamp is large."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.layout import FINE_CELL
from chromadock.robust.frame.overexposure import CLIPPED, clipped_at
from chromadock.robust.frame.response import filtered, linear

WIDTHS = tuple(1.4 * 2 ** (k / 2) for k in range(7))
"""Standard deviations of the smoothing, half an octave apart, in steps of a pixel for finest
cells and of as many more for coarser ones: from the lens's blur to a core of a cell's radius,
and the surround of that."""

WIDTH_PER_SPACING = 0.12
"""At most, of the distance between the closest markers, so that a neighbour's light hardly
pulls."""
LARGE_WIDTH_PER_SPACING = 0.24
"""The same of lamps that were found in cells wider than FINE_CELL, and so are large themselves, and
of overexposed ones: a narrower smoothing has its top at the plateau's rim, away from a neighbour
whose halo makes it seem to slope."""
ROOMY = 2.0
"""Markers with so many times the room of the closest ones, as those out of the others' plane, are
looked at for themselves; the rest alike, by the closest."""
SURROUND = 2.0
"""Width of the smoothing that is taken away again, by the first: a neighbour's halo slopes, but
hardly bends, and so no longer pulls the tops of close markers together (0.2 pixels at 5 m)."""
CUT_OFF = 1.5
"""Smoothing reaches so many of its own widths: what is beyond changes no place that matters."""
SHIFT_PER_SPACING = 1 / 3
MAX_SHIFT = 6.0
"""A lamp's top is looked for within this of where it was supposed: steps; half the diagonal of the
plateau of a lamp that fills 2 x 2 cells."""

SAMPLING = 0.17
"""Standard error in pixels that a sensor's colour mosaic leaves the sharpest lamp: of red and of
blue light it sees every fourth pixel."""
FLOOR = 0.03
"""Standard error left to the brightest lamp, by the smoothing's width: what stands behind it
is not flat, and shifts the top."""
INFLATION = 1.4
"""True errors are so much larger than independent noise makes them: water's and JPEG's is not."""
# Bend over height of a top at the least width, in steps: of a lamp that falls between the
# mosaic's samples, and of one spread over several; the share of SAMPLING that is left then.
_SHARP, _BLUNT, _LEAST_SAMPLING = 0.37, 0.1, 0.4

DRIFT = 1.0
"""Standard error of a place, in its top's way from one smoothing to the next one half an octave
narrower or wider, whichever is shorter.  The top of a round lamp stays where it is; that of the
corner of two bright bars, or of a lamp that a bar draws aside, goes on with each width, and is off
by two or three such steps."""

MAX_TOPS = 3
"""Places that a lamp is supposed in at most."""
OTHER = 0.35
"""Height of another top near a small lamp, of the highest's, that may be the lamp: a glint beside
it or the edge of a strut may be the brighter one.  Which of them it is the whole dock tells."""
_SMALL = 2  # widths at most that fit between the markers: then a top is a lamp, not a speck of one

# Standard deviation of the slope of white noise so smoothed, for a width of 1: two Gaussians of
# widths a and b have slopes of the covariance 1 / (2 pi (a^2 + b^2)^2).
_NOISE_SLOPE = float(
    np.sqrt((1 / 4 + 1 / (2 * SURROUND**2) ** 2 - 2 / (1 + SURROUND**2) ** 2) / (2 * np.pi))
)


@dataclass(frozen=True, eq=False, slots=True)
class Tops:
    """Where a lamp may be, the likeliest first.

    ``xy`` (k, 2) pixels; ``sigma`` (k,): standard deviations in x as in y, pixels, if it is a lamp
    and round; ``drift`` (k,): those of what may draw it aside, see DRIFT.
    """

    xy: NDArray[np.float64]
    sigma: NDArray[np.float64]
    drift: NDArray[np.float64]

    def nearest(self, place: NDArray[np.float64]) -> tuple[NDArray[np.float64], float, float]:
        """The one nearest to ``place`` (2,), pixels: its own place, error and drift."""
        k = int(np.linalg.norm(self.xy - place, axis=1).argmin())
        return self.xy[k], float(self.sigma[k]), float(self.drift[k])


def refined(
    frame_bgr: NDArray[np.uint8],
    xy: NDArray[np.float64],
    cell: int,
    weights: NDArray[np.float32],
    noise: NDArray[np.float64],
) -> list[Tops] | None:
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
    weights : (1, 3), of the response's filters that which the lamps answer most.
    noise : (n,) standard deviation of the filtered light of cells about each.

    Returns
    -------
    n of them; None where one has no top, or none that says more than where it was supposed.
    """
    step = max(cell // FINE_CELL, 1)
    patches: dict[int, _Patch] = {}
    for lamps, spacing in _by_spacing(xy):
        cut = _patches(frame_bgr, xy[lamps], step, weights, spacing / step)
        patches.update(zip(lamps, cut, strict=True))
    found = []
    for lamp, spread in enumerate(noise.tolist()):
        patch = patches[lamp]
        tops = _tops(patch)
        if not tops:
            return None
        # A cell is so many steps wide, and independent noise averages out by as much.
        per_noise = INFLATION * cell / step * spread
        places = _in_pixels(tops, patch.corner, step, per_noise)
        if places.sigma[0] > MAX_SHIFT * step:
            return None
        found.append(places)
    return found


def _by_spacing(xy: NDArray[np.float64]) -> list[tuple[list[int], float]]:
    """Which of (n, 2) places have about as little room as any, and which more; and the least
    distance of each to another place, pixels."""
    places = xy.tolist()
    room = [min(math.dist(a, b) for b in places if b is not a) for a in places]
    crowded = [k for k, own in enumerate(room) if own < ROOMY * min(room)]
    others = [k for k in range(len(room)) if k not in crowded]
    return [(which, min(room[k] for k in which)) for which in (crowded, others) if which]


@dataclass(frozen=True, slots=True)
class _Top:
    """``at`` (x, y): steps in the patch; ``error``: standard, for noise of 1 a step; ``width``;
    ``sharpness``: bend over height; ``drift``: steps, see DRIFT."""

    at: tuple[float, float]
    error: float
    width: float
    sharpness: float
    drift: float = 0.0

    @classmethod
    def of(cls, smooth: NDArray[np.float32], x: int, y: int, width: float) -> _Top | None:
        """Through 3 x 3 values of the light as smoothed; None where they have no top."""
        # Nine numbers: Python's own arithmetic is the faster.
        (_, up, _), (left, height, right), (_, down, _) = smooth[
            y - 1 : y + 2, x - 1 : x + 2
        ].tolist()
        across, along = 2 * height - left - right, 2 * height - up - down
        if min(across, along, height) <= 0:
            return None
        # A top moves by noise's slope over the bend.
        error = _NOISE_SLOPE / (width**2 * min(across, along))
        shift_x = min(max(0.5 * (right - left) / across, -1.0), 1.0)
        shift_y = min(max(0.5 * (down - up) / along, -1.0), 1.0)
        sharpness = 0.5 * (across + along) / height
        return cls((x + shift_x, y + shift_y), error, width, sharpness)


@dataclass(frozen=True, eq=False, slots=True)
class _Patch:
    """Filtered light about a lamp, smoothed; ``corner`` (2,): pixels, of its first step.

    ``layers``: a difference of Gaussians for each of ``widths``.  ``middle``: index of the
    supposed place, both ways; ``reach``: steps from it that the lamp may be.
    """

    corner: NDArray[np.intp]
    layers: list[NDArray[np.float32]]
    widths: list[float]
    middle: int
    reach: float


def _patches(
    frame_bgr: NDArray[np.uint8],
    xy: NDArray[np.float64],
    step: int,
    weights: NDArray[np.float32],
    spacing: float,
) -> list[_Patch]:
    """Of lamps near ``xy``, (n, 2) pixels; the closest has ``spacing`` steps to the next marker."""
    reach = min(max(2.0, SHIFT_PER_SPACING * spacing), MAX_SHIFT)
    large = step > 1 or clipped_at(frame_bgr, xy).all()
    widest = (LARGE_WIDTH_PER_SPACING if large else WIDTH_PER_SPACING) * spacing
    widths = [w for w in WIDTHS[:-2] if w <= max(WIDTHS[0], widest)]
    middle = int(reach + widths[-1]) + 1
    around = middle + int(CUT_OFF * SURROUND * widths[-1])
    side = 2 * around + 1
    corners = np.rint(xy).astype(np.intp) - side * step // 2
    cuts = [_cut(frame_bgr, left, top, side * step) for left, top in corners.tolist()]
    light = _shining(np.concatenate(cuts), weights)
    if step > 1:
        size = (side, side * len(xy))
        light = np.asarray(cv2.resize(light, size, interpolation=cv2.INTER_AREA), np.float32)
    smoothers = _smoothers(middle, around, len(widths) + 2)
    # So many small products, and not one large one: OpenBLAS, numpy's as OpenCV's, would start
    # threads for that, which wait for each other where other processes are busy.
    across = light.reshape(len(xy), 1, side, side) @ smoothers.transpose(0, 2, 1)
    smoothed = smoothers @ across
    # The surround of a width is the smoothing of one two places on.
    layers = smoothed[:, :-2] - smoothed[:, 2:]
    corners += (around - middle) * step
    return [
        _Patch(corner, list(lamp), widths, middle, reach)
        for corner, lamp in zip(corners, layers, strict=True)
    ]


def _shining(pixels: NDArray[np.uint8], weights: NDArray[np.float32]) -> NDArray[np.float32]:
    """Filtered light (h, w) of (h, w, 3) pixels.

    What a clipped channel says is too little.  Where one is, the others take nothing away: or a
    lamp's core, which clips in more of them than its halo, would be a hole in it.
    """
    colour = linear(pixels)
    light = filtered(colour, weights)
    clipped = cv2.inRange(pixels, (0, 0, 0), 3 * (CLIPPED - 1,)) == 0
    if clipped.any():
        light[clipped] = filtered(colour, np.maximum(weights, 0))[clipped]
    return light


def _cut(image: NDArray[np.uint8], left: int, top: int, side: int) -> NDArray[np.uint8]:
    """A square of an image that may reach beyond its border, which is repeated there."""
    height, width = image.shape[:2]
    inside = image[max(top, 0) : top + side, max(left, 0) : left + side]
    beyond = (max(-top, 0), max(top + side - height, 0), max(-left, 0), max(left + side - width, 0))
    return np.asarray(cv2.copyMakeBorder(inside, *beyond, cv2.BORDER_REPLICATE), np.uint8)


@lru_cache
def _smoothers(middle: int, around: int, count: int) -> NDArray[np.float32]:
    """(count, 2 middle + 1, 2 around + 1): what smooths the rows of a patch by each of the first
    ``count`` widths, and leaves its middle.  Sums over so few places take less time than to
    filter all of the patch."""
    off = np.arange(-around, around + 1) - np.arange(-middle, middle + 1)[:, None]
    weights = np.exp(-0.5 * (off / np.array(WIDTHS[:count])[:, None, None]) ** 2)
    return np.asarray(weights / weights.sum(axis=2, keepdims=True), np.float32)


def _tops(patch: _Patch) -> list[_Top]:
    """Where the lamp may be: the best located top uphill of the middle, then others about."""
    sharpness = 0.0
    by_width: list[_Top] = []
    for smooth, width in zip(patch.layers, patch.widths, strict=True):
        summit = _climbed(smooth, patch.middle, max(1, round(width)), patch.reach)
        top = None if summit is None else _Top.of(smooth, *summit, width)
        if top is None:
            continue
        by_width.append(top)
        if width == WIDTHS[0]:
            sharpness = top.sharpness
    if not by_width:
        return []
    best = min(by_width, key=lambda top: top.error)
    tops = [replace(best, sharpness=sharpness, drift=_drift(best, by_width))]
    if len(patch.widths) <= _SMALL:
        for top in _others(patch):
            far = [math.dist(top.at, other.at) > WIDTHS[0] for other in tops]
            if all(far) and len(tops) < MAX_TOPS:
                tops.append(top)
    return tops


def _drift(best: _Top, by_width: list[_Top]) -> float:
    """Steps from a top to that at the next width, narrower or wider: the shorter of both ways, for
    a narrow smoothing is led astray by noise, and one wider than the lamp by what is beside it.  0
    where no wider one has a top: then the lamp may be as wide as the widest, and a narrower one
    finds any place on it."""
    octaves = {top: math.log2(top.width / best.width) for top in by_width}
    beside = [top for top, off in octaves.items() if 0 < abs(off) < 0.75]
    if not any(octaves[top] > 0 for top in beside):
        return 0.0
    return min(math.dist(best.at, top.at) for top in beside)


def _others(patch: _Patch) -> Iterator[_Top]:
    """All tops within reach at the least width, the highest first."""
    smooth, width = patch.layers[0], patch.widths[0]
    inside = slice(patch.middle - int(patch.reach), patch.middle + int(patch.reach) + 1)
    window = smooth[inside, inside]
    highest = cv2.dilate(smooth, np.ones((3, 3), np.uint8))[inside, inside]
    rows, columns = np.nonzero((window >= highest) & (window > OTHER * window.max()))
    for k in np.argsort(-window[rows, columns], kind="stable").tolist():
        top = _Top.of(smooth, inside.start + int(columns[k]), inside.start + int(rows[k]), width)
        if top is not None:
            yield top


def _in_pixels(tops: list[_Top], corner: NDArray[np.intp], step: int, noise: float) -> Tops:
    """Tops of a patch, for light whose noise is ``noise`` a step."""
    sigma = []
    for top in tops:
        sharp = (top.sharpness - _BLUNT) / (_SHARP - _BLUNT) if step == 1 else 0.0
        sampling = SAMPLING * min(max(sharp, _LEAST_SAMPLING), 1.0)
        sigma.append(math.hypot(sampling, step * FLOOR * top.width, step * noise * top.error))
    at = np.array([top.at for top in tops])
    drift = step * DRIFT * np.array([top.drift for top in tops])
    return Tops(corner + (at + 0.5) * step - 0.5, np.array(sigma), drift)


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
