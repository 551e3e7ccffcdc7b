"""How much a place shines like a lamp, in units of the frame's own noise."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.colour.hsv import rgb_from_hsv
from chromadock.method import HUE_RANGE
from chromadock.robust.frame.layout import Layout
from chromadock.robust.frame.native import ffi, lib, pointer

GAMMA = 2.2
"""Of cameras whose pictures are meant for screens (sRGB is within 1% of it)."""

COARSEST_CELL_RAD = 1 / 24
"""As wide as a marker's glare looks from where the dock just fits into the picture."""

MIN_SIDE: int = lib.FRONT_MIN_SIDE
"""Pixels: two surrounds."""

HUES: int = lib.FRONT_HUES
"""Hues that are looked for at once, evenly about the circle from the expected one."""

LINEAR = ((np.arange(256) / 255) ** GAMMA).astype(np.float32)


@dataclass(frozen=True, eq=False, slots=True)
class Response:
    """What the matched filters make of a frame.

    ``weights`` (HUES, 3) float32, BGR: the filters, that of the expected hue first, such that
    cells of the second scale fluctuate by about 1; ``axes`` (3, 3), BGR: the matched filter of
    white, and two filters blind to white, all of which fluctuate as much, each for itself;
    ``covariance`` (3, 3), BGR: of the fluctuation of those cells, in linear light.  The finest
    scale is seen through the first filter alone.

    In images of all scales, see ``layout``: ``light`` (3, H, W) float32: linear BGR, 0..1;
    ``added`` (3, H, W) float32: the same less that of the surround; ``snr`` (H, W) float32: the
    largest of the filters' outputs, in standard deviations of its local fluctuation;
    ``best`` (H, W) uint8: of which filter.  The borders of ``added`` and ``best`` are not set.

    ``sense``: 1 where what shines is looked for.  It is -1 in ``dark``, the same frame for what
    takes light away, as a lamp's black holder does before bright water: its ``snr`` is the largest
    of what the filters' outputs are less than nothing, with no hue expected, and told of all scales
    but the finest; ``best`` is not its own.  ``dark`` has no ``dark``.

    ``native``: all of that as a ``front_frame_t``.
    """

    weights: NDArray[np.float32]
    axes: NDArray[np.float64]
    covariance: NDArray[np.float64]
    layout: Layout
    light: NDArray[np.float32]
    added: NDArray[np.float32]
    snr: NDArray[np.float32]
    best: NDArray[np.uint8]
    sense: int
    dark: Response | None
    native: Any

    def light_at(self, at: NDArray[np.intp]) -> NDArray[np.float32]:
        """(..., 3) linear BGR: the light of cells, by their index."""
        return np.moveaxis(self.light.reshape(3, -1).take(at, axis=1), 0, -1)

    def added_at(self, at: NDArray[np.intp]) -> NDArray[np.float64]:
        """(N, 3) linear BGR: the light of cells beyond that of the surround, by their index; in
        ``dark`` what is missing of that."""
        return self.sense * self.added.reshape(3, -1)[:, at].T.astype(np.float64)

    def added_near(self, xy: NDArray[np.float64], cell: int) -> NDArray[np.float64]:
        """(n, 3) linear BGR: the light beyond that of the surround of the cells, ``cell`` pixels
        wide, in which places (n, 2) of the frame are, pixels."""
        scale = self.layout.cells.index(cell)
        last = self.layout.shapes[scale] - 1
        row, column = np.clip(np.floor((xy[:, ::-1] + 0.5) / cell).astype(np.intp), 0, last).T
        return self.added_at(self.layout.at(scale, row, column))

    def chroma(self, added: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, 2) radians: how far light (N, 3) is from white."""
        added = np.ascontiguousarray(added, np.float64)
        chroma = np.empty((len(added), 2))
        lib.front_chroma(self.native, pointer(added), len(added), pointer(chroma))
        return chroma


def linear(image: NDArray[np.uint8]) -> NDArray[np.float32]:
    """8-bit encoded values to linear light, 0..1."""
    return np.asarray(cv2.LUT(image, LINEAR), np.float32)


def respond(
    frame_bgr: NDArray[np.uint8], hue: int, focal_px: float, preferred: bool = True
) -> Response:
    """Filter a frame for lamps, of ``hue`` 0..1535 before all others.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8, at least MIN_SIDE each way.
    focal_px : focal length; sets the coarsest cells.
    preferred : whether lamps are expected to have that hue; if not, all hues count alike.

    Raises
    ------
    ValueError : if the frame is none.
    """
    if frame_bgr.dtype != np.uint8 or frame_bgr.ndim != 3 or frame_bgr.shape[2] != 3:
        raise ValueError("a frame is (H, W, 3) uint8")
    height, width = frame_bgr.shape[:2]
    if min(height, width) < MIN_SIDE:
        raise ValueError(f"a frame has {MIN_SIDE} pixels or more each way")
    coarsest = min(focal_px * COARSEST_CELL_RAD, min(height, width) / 16)
    layout = Layout.of(height, width, coarsest)
    pixels = layout.cells[0]
    if pixels > 1 and (height % 2 or width % 2):
        frame_bgr, pixels = _halved(frame_bgr), 1
    picture = np.ascontiguousarray(frame_bgr)
    light = np.empty((3, *layout.shape), np.float32)
    added = np.empty_like(light)
    snr, dark_snr = np.empty_like(added[0]), np.empty_like(added[0])
    best = np.empty(layout.shape, np.uint8)
    weights, axes = np.empty((HUES, 3), np.float32), np.empty((3, 3))
    covariance = np.empty((3, 3))

    def native_of(seen: NDArray[np.float32], opposite: NDArray[np.float32], sense: int) -> Any:
        arrays = light, added, seen, best, opposite, covariance, weights, axes
        return ffi.new("front_frame_t *", (layout.native[0], *map(pointer, arrays), sense))

    native = native_of(snr, dark_snr, 1)
    less = lib.FRONT_UNEXPECTED if preferred else 0.0
    signatures = _signatures(hue)
    tables = pointer(LINEAR), pointer(signatures)
    if lib.front_respond(native, pointer(picture), pixels, *tables, less):
        raise MemoryError("no memory for a frame's response")
    alike = weights, axes, covariance, layout, light, added
    dark = Response(*alike, dark_snr, best, -1, None, native_of(dark_snr, snr, -1))
    return Response(*alike, snr, best, 1, dark, native)


def _halved(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Means of 2 x 2 pixels, where an odd row or column is spread over the others."""
    size = (image.shape[1] // 2, image.shape[0] // 2)
    return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA), np.uint8)


@lru_cache(maxsize=16)
def _signatures(hue: int) -> NDArray[np.float64]:
    """(HUES, 3) linear BGR: the purest colours of the hues that are looked for, ``hue`` first."""
    hues = [(hue + HUE_RANGE * k // HUES) % HUE_RANGE for k in range(HUES)]
    return np.array([LINEAR[list(rgb_from_hsv(h, 255, 255))[::-1]] for h in hues], np.float64)
