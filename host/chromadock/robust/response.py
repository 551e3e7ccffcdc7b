"""How much a place shines like a lamp, in units of the frame's own noise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.colour.hsv import rgb_from_hsv
from chromadock.method import HUE_RANGE
from chromadock.robust.layout import Layout

GAMMA = 2.2
"""Of cameras whose pictures are meant for screens (sRGB is within 1% of it)."""

COARSEST_CELL_RAD = 1 / 24
"""As wide as a marker's glare looks from where the dock just fits into the picture."""

SURROUND_CELL = 32
"""Pixels, at least: water changes little over it, and no far marker fills it."""

SURROUND_CELLS = 4
"""Cells of a scale that its surround is wide, at least: a lamp that fills a cell does not fill
the surround."""

MIN_SIDE = 64
"""Pixels: two surrounds."""

HUES = 6
"""Hues that are looked for at once, evenly about the circle from the expected one: every lamp is
within 30 degrees of one of them, and a matched filter loses little by that."""

UNEXPECTED = 0.4
"""Signal to noise that a hue other than the expected one counts less, since the largest of several
normal variables exceeds one of them by about so much."""

CLIPPED_LIGHT = 0.8
"""Linear light of a cell, of full scale, from which on its channel may have been clipped."""

_Number = TypeVar("_Number", np.uint8, np.float32)

_LINEAR = ((np.arange(256) / 255) ** GAMMA).astype(np.float32)

# Neighbours at this lag, in finest cells, share neither a marker nor JPEG's blocks of 8 pixels.
_LAG = 2
# Rows that the noise is measured on: one in so many; 2,300 cells fix six numbers to 3%.
_ROW_STEP = 8
# Differences beyond so many times the mean are edges and lamps.  What fluctuates a little more than
# noise, foam and caustics, counts: the filter had better be blind to its colour as well.
_EDGE = 2.5
# Variance of linear light that 8 bits leave in dark water: (2.2 * 0.05^1.2 / 255)^2 / 12.
_QUANTUM = 5e-9
# The local noise is the mean of so many cells squared, ...
_BLOCK = 8
# ... at least that of almost all the frame, at most what markers themselves may raise it to.
_LEAST, _MOST = 0.9, 2.5
# Mean absolute value to standard deviation of a normal variable.
_NORMAL = float(np.sqrt(np.pi / 2))


@dataclass(frozen=True, slots=True)
class Response:
    """What the matched filters make of a frame.

    ``weights`` (HUES, 3) float32, BGR: the filters, that of the expected hue first, such that
    finest cells fluctuate by about 1; ``across`` (2, 3), BGR: filters blind to the expected
    colour, that fluctuate as much, each for itself; ``covariance`` (3, 3), BGR: of the
    fluctuation of cells, in linear light.

    In images of all scales, see ``layout``: ``light`` (H, W, 3) float32: linear BGR, 0..1;
    ``added`` (H, W, 3) float32: the same less that of the surround; ``snr`` (H, W) float32: the
    largest of the filters' outputs, in standard deviations of its local fluctuation;
    ``best`` (H, W) uint8: of which filter.
    """

    weights: NDArray[np.float32]
    across: NDArray[np.float64]
    covariance: NDArray[np.float64]
    layout: Layout
    light: NDArray[np.float32]
    added: NDArray[np.float32]
    snr: NDArray[np.float32]
    best: NDArray[np.uint8]

    def added_at(self, at: NDArray[np.intp]) -> NDArray[np.float64]:
        """(N, 3) linear BGR: the light of cells beyond that of the surround, by their index."""
        return self.added.reshape(-1, 3)[at].astype(np.float64)

    def excess(self, at: NDArray[np.intp]) -> NDArray[np.float64]:
        """(N,) light that cells add, through the filter that answers most there."""
        weights = self.weights[self.best.ravel()[at]]
        clipped = self.light.reshape(-1, 3)[at].max(axis=1) >= CLIPPED_LIGHT
        weights = np.where(clipped[:, None], np.maximum(weights, 0), weights)
        return np.asarray((self.added_at(at) * weights).sum(axis=1))

    def chroma(self, added: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, 2) radians: how far light (N, 3) is from the markers' colour."""
        off = added @ self.across.T
        size = np.hypot(off[:, 0], off[:, 1])
        angle = np.arctan2(size, added @ self.weights[0])
        return np.asarray(off * (angle / np.maximum(size, 1e-9))[:, None])


def linear(image: NDArray[np.uint8]) -> NDArray[np.float32]:
    """8-bit encoded values to linear light, 0..1."""
    return np.asarray(cv2.LUT(image, _LINEAR), np.float32)


def filtered(light: NDArray[np.float32], weights: NDArray[np.float32]) -> NDArray[np.float32]:
    """(h, w, 3) light through (1, 3) weights: (h, w)."""
    return np.asarray(cv2.transform(light, weights), np.float32)


def respond(
    frame_bgr: NDArray[np.uint8], hue: int, focal_px: float, preferred: bool = True
) -> Response:
    """Filter a frame for lamps, of ``hue`` 0..1535 before all others.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8, at least MIN_SIDE each way.
    focal_px : focal length; sets the coarsest cells.
    preferred : whether the lamps are expected to have that hue; if not, all hues count alike.
    """
    height, width = frame_bgr.shape[:2]
    coarsest = min(focal_px * COARSEST_CELL_RAD, min(height, width) / 16)
    layout = Layout.of(height, width, coarsest)
    finest = _halved(frame_bgr)
    if layout.cells[0] > 2:
        finest = _halved(finest)
    lights = [linear(finest)]
    covariance = _fluctuation(lights[0])
    hues = [(hue + HUE_RANGE * k // HUES) % HUE_RANGE for k in range(HUES)]
    signatures = np.array([_LINEAR[list(rgb_from_hsv(h, 255, 255))[::-1]] for h in hues])
    weights = _matched_filters(covariance, signatures.astype(np.float64))
    while len(lights) < len(layout.cells):
        lights.append(_halved(lights[-1]))
    added = [
        light - _surround(light, cell) for light, cell in zip(lights, layout.cells, strict=True)
    ]
    less = UNEXPECTED if preferred else 0.0
    answers = [
        _answers(light, more, weights, less) for light, more in zip(lights, added, strict=True)
    ]
    best = [np.asarray(a.argmax(axis=0), np.uint8) for a in answers]
    return Response(
        weights,
        _across(covariance, signatures[0].astype(np.float64)),
        covariance,
        layout,
        layout.together(lights),
        layout.together(added),
        layout.together([np.asarray(a.max(axis=0)) for a in answers]),
        layout.together(best),
    )


def _halved(image: NDArray[_Number]) -> NDArray[_Number]:
    """Means of 2 x 2 pixels; an odd row or column is spread over the others."""
    size = (image.shape[1] // 2, image.shape[0] // 2)
    return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA), image.dtype)


def _surround(light: NDArray[np.float32], cell: int) -> NDArray[np.float32]:
    """Light (h, w, 3) of the water about each cell."""
    wide = max(SURROUND_CELL // cell, SURROUND_CELLS)
    height, width = light.shape[:2]
    size = (max(1, width // wide), max(1, height // wide))
    coarse = cv2.resize(light, size, interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.resize(coarse, (width, height)), np.float32)


def _fluctuation(light: NDArray[np.float32]) -> NDArray[np.float64]:
    """Covariance (3, 3) of the channels of single cells about the light nearby.

    Second differences along rows (slopes cancel), without the large ones: those are edges.
    """
    rows = np.ascontiguousarray(light[_ROW_STEP // 2 :: _ROW_STEP].transpose(2, 0, 1))
    bent = rows[..., 2 * _LAG :] + rows[..., : -2 * _LAG] - 2 * rows[..., _LAG:-_LAG]
    bent = bent.reshape(3, -1)
    size = np.abs(bent).sum(axis=0)
    kept = size <= _EDGE / size.size * size.sum()
    product = (bent * kept) @ bent.T
    # A second difference of independent values has 1 + 1 + 4 times their variance.
    variances = product.astype(np.float64) / (6 * np.count_nonzero(kept))
    return np.asarray(variances + _QUANTUM * np.eye(3))


def _matched_filters(
    covariance: NDArray[np.float64], signatures: NDArray[np.float64]
) -> NDArray[np.float32]:
    """Weights S^-1 s / sqrt(s' S^-1 s): most signal of each colour s in noise of covariance S.

    North, Proc. IEEE 51 (1963) 1016; in colour space it takes the water's own hue out.
    """
    whitened = np.linalg.solve(covariance, signatures.T).T
    scale = np.sqrt((signatures * whitened).sum(axis=1, keepdims=True))
    return np.asarray(whitened / scale, np.float32)


def _across(covariance: NDArray[np.float64], signature: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2, 3) filters blind to colour s, whose noise is 1 and independent of each other's.

    Two vector products with s; the noise of both, and of the matched filter, is independent
    since f S f' = 0 for any two of them.
    """
    b, g, r = signature
    product = np.array([[0, -r, g], [r, 0, -b], [-g, b, 0]])
    first = product[signature.argmin()]
    both = np.stack([first, product @ covariance @ first])
    variances = (both @ covariance * both).sum(axis=1)
    return np.asarray(both / np.sqrt(variances)[:, None])


def _answers(
    light: NDArray[np.float32],
    added: NDArray[np.float32],
    weights: NDArray[np.float32],
    less: float,
) -> NDArray[np.float32]:
    """(HUES, h, w): what cells add, filtered, over its local fluctuation.

    A clipped channel says only that there is as much or more.  Where one is, the others take
    nothing away: or a lamp's core, which clips in more of them than its halo, would be a hole
    in it.
    """
    height, width = light.shape[:2]
    planes = np.ascontiguousarray(added.reshape(-1, 3).T)
    answers = weights @ planes
    clipped = np.flatnonzero(light.reshape(-1, 3).max(axis=1) >= CLIPPED_LIGHT)
    if len(clipped):
        answers[:, clipped] = np.maximum(weights, 0) @ planes[:, clipped]
    answers = answers.reshape(-1, height, width)
    for k, answer in enumerate(answers):
        answers[k] = _against_noise(answer) - (less if k else 0)
    return np.asarray(answers, np.float32)


def _against_noise(excess: NDArray[np.float32]) -> NDArray[np.float32]:
    """Filtered light (h, w) over its local fluctuation."""
    height, width = excess.shape
    blocks = (max(1, width // _BLOCK), max(1, height // _BLOCK))
    noise = cv2.resize(np.abs(excess), blocks, interpolation=cv2.INTER_AREA)
    middle = noise.size // 2
    typical = max(float(np.partition(noise, middle, axis=None)[middle]), 1e-3)
    noise = np.minimum(np.maximum(noise, _LEAST * typical), _MOST * typical)
    noise = cv2.resize(cv2.GaussianBlur(noise, (0, 0), 1.5), (width, height))
    return np.asarray(cv2.divide(excess, noise, scale=1 / _NORMAL), np.float32)
