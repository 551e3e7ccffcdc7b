"""The docks of the scenes: where their markers are and what turns leave them as they are."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.dock import DockGeometry
from chromadock.variety.factors import variety

ORIGINAL_WIDTH_M = 0.89
"""Of the paper's rectangle, to which lengths and distances are in proportion."""

Floats = NDArray[np.float64]


def dock_geometry(name: str, width_m: float) -> DockGeometry:
    """A dock of ``variety.toml``, ``width_m`` across; the rectangle is the packaged default's."""
    points = width_m * np.array(variety().docks[name].points)
    if name == "rectangle":
        names = DockGeometry.default().names
    else:
        names = tuple(f"marker_{i}" for i in range(len(points)))
    return DockGeometry(names, points, name)


def matched(true_px: Floats, found_px: Floats) -> Floats:
    """Each true place's own found one, (N, 2): names do not count, as of a dock that is alike
    after a turn.

    Greedy by distance, which is the best assignment wherever the distances are small against
    those between the markers.
    """
    apart = np.linalg.norm(true_px[:, None] - found_px[None], axis=2)
    own = np.full(true_px.shape, np.nan)
    for _ in range(min(apart.shape)):
        i, j = np.unravel_index(int(np.argmin(apart)), apart.shape)
        own[i] = found_px[j]
        apart[i], apart[:, j] = np.inf, np.inf
    return own
