"""What hue markers shine in, as this camera receives it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock import method
from chromadock.colour.hsv import rgb_from_hsv
from chromadock.robust.frame.layout import BORDER
from chromadock.robust.frame.response import Response, linear

_STEP = 16  # of 1536: much finer than attenuation and crosstalk let a hue be known
_HUES = np.arange(0, method.HUE_RANGE, _STEP)
# (3, hues) linear BGR.
_PURE = linear(np.array([[rgb_from_hsv(int(h), 255, 255)[::-1] for h in _HUES]], np.uint8))[0].T

# Cells about a marker whose light is a lamp's: 5 x 5.
_NEAR = np.mgrid[-2:3, -2:3].reshape(2, 1, -1)
# Down and across, cells, to the places that tell what is behind a cell.
_RING = BORDER * np.array([p for p in np.ndindex(3, 3) if p != (1, 1)]) - BORDER
_CLIPPED = 0.7  # of full scale: the mean of a cell with a clipped pixel is below 1
# Mean of unclipped cells beside clipped ones, in standard deviations: what is so near to a lamp
# that it clips is lit by it, so that less is not its light.
_LEAST_SNR = 3.0


def received_hue(response: Response, xy: NDArray[np.float64]) -> int | None:
    """Hue 0..1535 whose matched filter answers most to the light that markers at ``xy`` add.

    Parameters
    ----------
    xy : (n, 2) pixels.

    A clipped core has lost its hue, so the halo beside it is looked at, farther out in coarser
    cells where all that is near clips; None where nothing unclipped is left that adds light.  The
    water between and the camera's crosstalk turn the hue by some tens of degrees; see
    docs/robust.md.
    """
    for scale in range(len(response.layout.cells)):
        hue = _at_scale(response, xy, scale)
        if hue is not None:
            return hue
    return None


def _at_scale(response: Response, xy: NDArray[np.float64], scale: int) -> int | None:
    """The same by the cells of one scale."""
    height, width = response.layout.shapes[scale]
    across, down = np.floor((xy + 0.5) / response.layout.cells[scale]).astype(np.intp).T
    column = np.minimum(np.maximum(across[:, None] + _NEAR[0], 0), width - 1)
    row = np.minimum(np.maximum(down[:, None] + _NEAR[1], 0), height - 1)
    at = response.layout.at(scale, row, column).ravel()
    light = response.light_at(at)
    whole = light.max(axis=1) < _CLIPPED
    if not whole.any():
        return None
    # What is behind a lamp: the second darkest of eight places about it.
    ring = (_RING * (response.layout.shape[1], 1)).sum(axis=1)
    around = response.light_at(at[whole] + ring[:, None])
    added = (light[whole] - np.partition(around, 1, axis=0)[1]).sum(axis=0)
    whitened = np.linalg.solve(response.covariance, _PURE)
    answer = (added @ whitened) / np.sqrt((_PURE * whitened).sum(axis=0))
    best = int(answer.argmax())
    # The noise of cells of the second scale; that of coarser ones is no more.
    sure = whole.all() or answer[best] >= _LEAST_SNR * np.count_nonzero(whole)
    return int(_HUES[best]) if sure else None
