"""Where exactly a lamp is: the top of its light, smoothed as wide as the lamp is large."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock._native import ffi, lib
from chromadock.native import doubles
from chromadock.robust.frame.bars import lean_by_bars
from chromadock.robust.frame.layout import FINE_CELL
from chromadock.robust.frame.overexposure import clipped_at, have_cores
from chromadock.robust.frame.response import Response, linear

WIDTHS = tuple(1.4 * 2 ** (k / 2) for k in range(7))
"""Standard deviations of the smoothing, half an octave apart, in steps of a pixel for finest
cells and of as many more for coarser ones: from the lens's blur to a core of a cell's radius,
and the surround of that."""

WIDTH_PER_SPACING = 0.12
"""At most, of the distance between the closest markers, so that a neighbour's light hardly
pulls."""
LARGE_WIDTH_PER_SPACING = 0.24
"""The same of lamps that were found in cells wider than FINE_CELL, and so are large themselves, of
overexposed ones, and of dark holders with a lamp in their middle: a narrower smoothing has its top
at the rim, of a plateau away from a neighbour whose halo makes it seem to slope."""
ROOMY = 2.0
"""Markers with so many times the room of the closest ones, as those out of the others' plane, are
looked at for themselves; the rest alike, by the closest."""
SURROUND = 2.0
"""Width of the smoothing that is taken away again, by the first: a neighbour's halo slopes, but
hardly bends, and so no longer pulls the tops of close markers together (0.2 pixels at 5 m)."""
CUT_OFF = 1.5
"""Smoothing reaches so many of its own widths: what is beyond changes no place that matters."""
SHIFT_PER_SPACING = 1 / 3
MAX_SHIFT: int = lib.TOPS_FARTHEST
"""A lamp's top is looked for within this of where it was supposed: steps."""

CORE_ERROR_PX = 0.1
CORE_ERROR_SHARE = 0.3
"""Standard error of the centroid of an overexposed lamp's core: pixels, and of how far it is from
the top of the smoothed light, which neighbours and bars pull more."""

INFLATION = 1.05
"""True errors are so much larger than independent noise makes them: water's and JPEG's is not."""

_LAMP = 3.0 * WIDTHS[0]  # steps: what is nearer to a supposed place is the lamp, no noise
# Variance of linear light in the dark that 8 bits leave, as the least smoothing leaves it.
_ROUNDING = 1e-8

# Of a smoothing's weights, as a share of the largest: nothing to 8 bits.
_NO_WEIGHT = 1e-9

_WIDTHS = doubles(np.array(WIDTHS))

# Standard deviation of the slope of white noise so smoothed, for a width of 1: two Gaussians of
# widths a and b have slopes of the covariance 1 / (2 pi (a^2 + b^2)^2).
_NOISE_SLOPE = float(
    np.sqrt((1 / 4 + 1 / (2 * SURROUND**2) ** 2 - 2 / (1 + SURROUND**2) ** 2) / (2 * np.pi))
)


@dataclass(frozen=True, eq=False, slots=True)
class Tops:
    """Where a lamp may be, the likeliest first.

    ``xy`` (k, 2) pixels; ``sigma`` (k,): standard deviations in x as in y, pixels, if it is a lamp
    and round; ``drift`` (k,): those of what may draw it aside.  ``width`` (k,) pixels, of the
    smoothing; ``give`` (k,) pixels by which a slope of the smoothed light of 1 per pixel moves it.
    ``weights`` (3,): of the channels, BGR, that were added up; negative where what is dark was
    looked for.
    """

    xy: NDArray[np.float64]
    sigma: NDArray[np.float64]
    drift: NDArray[np.float64]
    width: NDArray[np.float64]
    give: NDArray[np.float64]
    weights: NDArray[np.float32]

    def nearest(self, place: NDArray[np.float64]) -> tuple[NDArray[np.float64], float, float]:
        """The one nearest to ``place`` (2,), pixels: its own place, error and drift."""
        k = int(((self.xy - place) ** 2).sum(axis=1).argmin())
        return self.xy[k], float(self.sigma[k]), float(self.drift[k])


def refined(
    frame_bgr: NDArray[np.uint8],
    xy: NDArray[np.float64],
    cell: int,
    response: Response,
    noise: NDArray[np.float64],
) -> list[Tops] | None:
    """Subpixel places of n lamps of one colour.

    The light is smoothed by differences of Gaussians of growing width, the top nearby climbed
    to, and the width kept that locates best.  That is the one that fits the lamp (Lindeberg,
    IJCV 30 (1998) 79: the maximum of the scale-normalised Laplacian), so that a core which the
    sensor clips to a plateau is located by its outline and halo, which clip to no side.

    The channels are added up with weights of what the lamps add to each, over how much the pixels
    about them scatter in it: the filter of least noise, if channels fluctuate independently.  No
    weight is negative.  The filters that find lamps take one channel's light from another's; but
    pixels, unlike cells, have their colour from a mosaic and from JPEG at half the resolution, and
    what is taken away there moves the top.

    Lamps of which all are overexposed, and one over several pixels, are at the centroids of their
    cores instead: see ``_by_core``.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    xy : (n, 2) pixels, about where they are.
    cell : pixels, of the scale they were found at.
    response : what the filters made of the frame.
    noise : (n,) standard deviation of the filtered light of cells about each lamp, for filters
        through which the frame's cells fluctuate by 1.

    Returns
    -------
    n of them; None where one has no top, or none that says more than where it was supposed, or
    where an overexposed one is one with its neighbour.
    """
    step = max(cell // FINE_CELL, 1)
    overexposed = response.sense > 0 and bool(clipped_at(frame_bgr, xy).all())
    # Of what is dark the lamp in its middle is the least so.
    rimmed = overexposed or response.sense < 0
    by_spacing = _by_spacing(xy)
    groups = [
        (lamps, _patches(frame_bgr, xy[lamps], step, spacing / step, rimmed))
        for lamps, spacing in by_spacing
    ]
    added = response.added_near(xy, cell).sum(axis=0)
    weights = _weights(added, [patches for _, patches in groups], response.covariance)
    weights *= response.sense
    found: dict[int, Tops] = {}
    least: dict[int, tuple[NDArray[np.float64], NDArray[np.float32]]] = {}
    for lamps, patches in groups:
        # A cell is so many steps wide, and independent noise averages out by as much.
        slopes = _NOISE_SLOPE * INFLATION * cell * noise[lamps]
        light = patches.through(weights)
        for lamp, middle, smoothed, slope in zip(
            lamps, patches.middles, light, slopes.tolist(), strict=True
        ):
            tops = _tops(middle, smoothed, patches.reach, step, slope, weights)
            if tops is None or tops.sigma[0] > MAX_SHIFT * step:
                return None
            found[lamp] = tops
            least[lamp] = middle, smoothed[0]
    tops_of = [found[lamp] for lamp in range(len(xy))]
    places = np.array([tops.xy[0] for tops in tops_of])
    if not overexposed or not have_cores(frame_bgr, places).any():
        return tops_of
    room = by_spacing[0][1] / 2
    cores = [_by_core(tops, *least[lamp], step, room) for lamp, tops in enumerate(tops_of)]
    return [core for core in cores if core is not None] if all(cores) else None


def leaning(frame_bgr: NDArray[np.uint8], tops: list[Tops]) -> NDArray[np.float64]:
    """(n, 2) pixels: by how much bars may draw the likeliest tops of n lamps aside, as they may
    all lamps of the dock (``bars``)."""
    width, give = np.array([(top.width[0], top.give[0]) for top in tops]).T
    places = np.array([top.xy[0] for top in tops])
    return lean_by_bars(frame_bgr, places, width, give, tops[0].weights)


def _by_spacing(xy: NDArray[np.float64]) -> list[tuple[list[int], float]]:
    """Which of (n, 2) places have about as little room as any, and which more; and the least
    distance of each to another place, pixels."""
    places = xy.tolist()
    room = [min(math.dist(a, b) for b in places if b is not a) for a in places]
    crowded = [k for k, own in enumerate(room) if own < ROOMY * min(room)]
    others = [k for k in range(len(room)) if k not in crowded]
    return [(which, min(room[k] for k in which)) for which in (crowded, others) if which]


@dataclass(frozen=True, eq=False, slots=True)
class _Patches:
    """Light about n lamps; ``middles`` (n, 2): pixels, of their middle steps.

    ``smoothed`` (n, 3, k + 2, s, s) float32: linear BGR, by the first so many of WIDTHS, of which k
    are looked at.  ``reach``: steps from the middle that the lamp may be.
    """

    middles: NDArray[np.float64]
    smoothed: NDArray[np.float32]
    reach: float

    def scatter(self) -> NDArray[np.float64]:
        """(n, 3): variance of each channel about each lamp, as it is smoothed to look at the
        smallest lamps."""
        finest = self.smoothed[:, :, 0] - self.smoothed[:, :, 2]
        return np.asarray(finest[:, :, _about(finest.shape[-1])].var(axis=2), np.float64)

    def through(self, weights: NDArray[np.float32]) -> NDArray[np.float32]:
        """(n, k + 2, s, s): the light through (3,) weights."""
        lamps, channels, *shape = self.smoothed.shape
        light = weights @ self.smoothed.reshape(lamps, channels, -1)
        return np.asarray(light.reshape(lamps, *shape))


def _patches(
    frame_bgr: NDArray[np.uint8],
    xy: NDArray[np.float64],
    step: int,
    spacing: float,
    rimmed: bool,
) -> _Patches:
    """Of lamps near ``xy``, (n, 2) pixels; the closest has ``spacing`` steps to the next marker.
    ``rimmed``: whether they stand out least in their middles."""
    reach = min(max(2.0, SHIFT_PER_SPACING * spacing), MAX_SHIFT)
    large = step > 1 or rimmed
    widest = (LARGE_WIDTH_PER_SPACING if large else WIDTH_PER_SPACING) * spacing
    widths = [w for w in WIDTHS[:-2] if w <= max(WIDTHS[0], widest)]
    middle = int(reach + widths[-1]) + 1
    around = middle + int(CUT_OFF * SURROUND * widths[-1])
    side = 2 * around + 1
    corners = np.rint(xy).astype(np.intp) - side * step // 2
    cuts = [_cut(frame_bgr, left, top, side * step) for left, top in corners.tolist()]
    light = linear(np.concatenate(cuts))
    if step > 1:
        size = (side, side * len(xy))
        light = np.asarray(cv2.resize(light, size, interpolation=cv2.INTER_AREA), np.float32)
    channels = light.reshape(len(xy), side, side, 3).transpose(0, 3, 1, 2)
    smoothers = _smoothers(middle, around, len(widths) + 2)
    # So many small products, and not one large one: OpenBLAS, numpy's as OpenCV's, would start
    # threads for that, which wait for each other where other processes are busy.
    across = np.ascontiguousarray(channels)[:, :, None] @ smoothers.transpose(0, 2, 1)
    middles = np.asarray(corners + (around + 0.5) * step - 0.5, np.float64)
    return _Patches(middles, smoothers @ across, reach)


def _weights(
    added: NDArray[np.float64], groups: list[_Patches], covariance: NDArray[np.float64]
) -> NDArray[np.float32]:
    """(3,): those of ``refined``, such that cells whose light has that covariance fluctuate by 1
    through them.  A channel in which the lamps take light away counts for nothing."""
    scatter = np.concatenate([group.scatter() for group in groups]).mean(axis=0)
    weights = np.maximum(added, 0.0) / (scatter + _ROUNDING)
    fluctuation = math.sqrt(weights @ covariance @ weights)
    return np.asarray(weights / max(fluctuation, 1e-30), np.float32)


@lru_cache
def _about(side: int) -> NDArray[np.bool_]:
    """(side, side): which steps of a patch are no part of the lamp in its middle."""
    off = np.arange(side) - side // 2
    return np.asarray(off**2 + off[:, None] ** 2 > _LAMP**2)


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
    # Sums over numbers that are too small for their type take ten times as long.
    weights[weights < _NO_WEIGHT] = 0.0
    return np.asarray(weights / weights.sum(axis=2, keepdims=True), np.float32)


def _tops(
    middle: NDArray[np.float64],
    smoothed: NDArray[np.float32],
    reach: float,
    step: int,
    slope: float,
    weights: NDArray[np.float32],
) -> Tops | None:
    """Where a lamp may be, of smoothed light (k + 2, s, s) whose noise has so steep a slope,
    smoothed by 1 step; None where there is no top.  The others: see ``_Patches`` and ``Tops``."""
    tops = np.empty((lib.TOPS_MOST, 6))
    layers, side, _ = smoothed.shape
    light = ffi.from_buffer("float[]", smoothed)
    given = (layers - 2, side, light, _WIDTHS, reach, step, slope)
    count = lib.tops_find(ffi.new("tops_patch_t *", given), ffi.from_buffer("tops_top_t[]", tops))
    if not count:
        return None
    sigma, drift, width, give = tops[:count, 2:].T
    return Tops(middle + step * tops[:count, :2], sigma, drift, width, give, weights)


def _by_core(
    tops: Tops, middle: NDArray[np.float64], light: NDArray[np.float32], step: int, room: float
) -> Tops | None:
    """The place of an overexposed lamp, which has ``room`` pixels: its core's centroid.

    Where channels clip from one lamp to the next the light between them is as bright as they are,
    and its tops are drawn apart, by pixels.  ``light`` (s, s): as smoothed the least.  None where
    nothing sets the lamp apart from its neighbour.
    """
    at = (tops.xy[0] - middle) / step
    x, y = ffi.new("double *", at[0]), ffi.new("double *", at[1])
    light = np.ascontiguousarray(light)
    given = ffi.from_buffer("float[]", light)
    if lib.tops_core(given, light.shape[0], room / step, x, y):
        return None
    xy = middle + step * np.array([x[0], y[0]])
    off = float(np.linalg.norm(xy - tops.xy[0]))
    sigma = math.hypot(min(tops.sigma[0], CORE_ERROR_PX), CORE_ERROR_SHARE * off)
    # Its rim is as bright on all sides, whatever leads to it: no slope moves it, and no width.
    none = np.zeros(1)
    return Tops(xy[None], np.array([sigma]), none, tops.width[:1], none, tops.weights)
