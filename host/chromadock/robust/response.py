"""How much a place shines in the markers' colour, in units of the frame's own noise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.colour.hsv import rgb_from_hsv
from chromadock.robust.layout import Layout, Places

GAMMA = 2.2
"""Of cameras whose pictures are meant for screens (sRGB is within 1% of it)."""

COARSEST_CELL_RAD = 1 / 64
"""As wide as a marker's glare looks from where the dock just fits into the picture."""

SURROUND_CELL = 32
"""Pixels: water changes little over it, and no marker fills it."""

MIN_SIDE = 64
"""Pixels: two surrounds."""

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
    """What the matched filter makes of a frame.

    ``weights`` (1, 3) float32, BGR: the filter, such that finest cells fluctuate by about 1;
    ``across`` (2, 3), BGR: filters blind to the markers' colour, that fluctuate as much, each
    for itself; ``covariance`` (3, 3), BGR: of the fluctuation of cells, in linear light;
    ``surround`` (h, w, 3) float32: linear light in cells of SURROUND_CELL.

    In images of all scales, see ``layout``: ``light`` (H, W, 3) float32: linear BGR, 0..1;
    ``snr`` (H, W) float32: the filtered light less that of the surround, in standard deviations
    of its local fluctuation.
    """

    weights: NDArray[np.float32]
    across: NDArray[np.float64]
    covariance: NDArray[np.float64]
    surround: NDArray[np.float32]
    layout: Layout
    light: NDArray[np.float32]
    snr: NDArray[np.float32]

    def added(self, places: Places) -> NDArray[np.float64]:
        """(N, 3) linear BGR: the light of cells beyond that of the surround."""
        larger = np.array(self.surround.shape[1::-1]) / self.layout.shapes[:, ::-1]
        xy = ((places.xy + 0.5) * larger[places.scale] - 0.5).astype(np.float32)
        # Maps of two dimensions: OpenCV 5 makes other images of one than OpenCV 4 does.
        x, y, border = xy[:, :1], xy[:, 1:], cv2.BORDER_REPLICATE
        behind = cv2.remap(self.surround, x, y, cv2.INTER_LINEAR, borderMode=border)
        return np.asarray(self.light.reshape(-1, 3)[places.at] - behind[:, 0], np.float64)

    def excess(self, added: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N,) light (N, 3) through the filter."""
        return np.asarray(added @ self.weights[0])

    def chroma(self, added: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, 2) radians: how far light (N, 3) is from the markers' colour."""
        off = added @ self.across.T
        size = np.hypot(off[:, 0], off[:, 1])
        angle = np.arctan2(size, self.excess(added))
        return np.asarray(off * (angle / np.maximum(size, 1e-9))[:, None])


def linear(image: NDArray[np.uint8]) -> NDArray[np.float32]:
    """8-bit encoded values to linear light, 0..1."""
    return np.asarray(cv2.LUT(image, _LINEAR), np.float32)


def filtered(light: NDArray[np.float32], weights: NDArray[np.float32]) -> NDArray[np.float32]:
    """(h, w, 3) light through (1, 3) weights: (h, w)."""
    return np.asarray(cv2.transform(light, weights), np.float32)


def respond(frame_bgr: NDArray[np.uint8], hue: int, focal_px: float) -> Response:
    """Filter a frame for lamps of ``hue`` 0..1535.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8, at least MIN_SIDE each way.
    focal_px : focal length; sets the coarsest cells.
    """
    height, width = frame_bgr.shape[:2]
    layout = Layout.of(height, width, min(focal_px * COARSEST_CELL_RAD, SURROUND_CELL / 2))
    lights = [linear(_halved(_halved(frame_bgr)))]
    covariance = _fluctuation(lights[0])
    signature = _LINEAR[list(rgb_from_hsv(hue, 255, 255))[::-1]].astype(np.float64)
    weights = _matched_filter(covariance, signature)
    while len(lights) < len(layout.cells):
        lights.append(_halved(lights[-1]))
    surround = lights[-1]
    for _ in range((SURROUND_CELL // layout.cells[-1]).bit_length() - 1):
        surround = _halved(surround)
    behind = filtered(surround, weights)
    snr = [_against(filtered(light, weights), behind) for light in lights]
    return Response(
        weights,
        _across(covariance, signature),
        covariance,
        surround,
        layout,
        layout.together(lights),
        layout.together(snr),
    )


def _halved(image: NDArray[_Number]) -> NDArray[_Number]:
    """Means of 2 x 2 pixels; an odd row or column is spread over the others."""
    size = (image.shape[1] // 2, image.shape[0] // 2)
    return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA), image.dtype)


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


def _matched_filter(
    covariance: NDArray[np.float64], signature: NDArray[np.float64]
) -> NDArray[np.float32]:
    """Weights S^-1 s / sqrt(s' S^-1 s): most signal of colour s in noise of covariance S.

    North, Proc. IEEE 51 (1963) 1016; in colour space it takes the water's own hue out.
    """
    whitened = np.asarray(cv2.solve(covariance, signature[:, None])[1], np.float64)[:, 0]
    return (whitened / np.sqrt(signature @ whitened)).astype(np.float32)[None]


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


def _against(centre: NDArray[np.float32], surround: NDArray[np.float32]) -> NDArray[np.float32]:
    """Centre less surround over its local fluctuation."""
    height, width = centre.shape
    excess = centre - np.asarray(cv2.resize(surround, (width, height)), np.float32)
    blocks = (max(1, width // _BLOCK), max(1, height // _BLOCK))
    noise = cv2.resize(np.abs(excess), blocks, interpolation=cv2.INTER_AREA)
    middle = noise.size // 2
    typical = max(float(np.partition(noise, middle, axis=None)[middle]), 1e-3)
    noise = np.minimum(np.maximum(noise, _LEAST * typical), _MOST * typical)
    noise = cv2.resize(cv2.GaussianBlur(noise, (0, 0), 1.5), (width, height))
    return np.asarray(cv2.divide(excess, noise, scale=1 / _NORMAL), np.float32)
