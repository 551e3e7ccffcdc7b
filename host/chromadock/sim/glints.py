"""A lamp's mirror image in waves: facets of the surface that show it each at another place."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.surface import reflectance_from_below, upward_normals
from chromadock.sim.waves import GaussianField

Floats = NDArray[np.float64]

GLINTS = 9
"""Facets that show one lamp at the same time."""
SPACING_M = 0.1
"""Between those facets, along the line of sight: the shortest waves."""

_TINY = 1e-300


def glints(
    lamps: Floats, flat: Floats, depth_m: float, waves: GaussianField, time_s: float
) -> tuple[Floats, Floats]:
    """Where facets of the surface show lamps, (N, K, 3), and how much they reflect, (N, K).

    A facet is part of a tilted mirror through the place where a flat surface would show the
    lamp; its slope is that of the waves a little nearer or farther along the line of sight.

    Parameters
    ----------
    lamps : (N, 3) their places, metres from the camera, world.
    flat : (N, 3) their mirror images in a flat surface, as above, higher than the camera.
    depth_m : of the camera.
    waves, time_s : of the surface.
    """
    middle = flat * (depth_m / -flat[:, 2])[:, None]
    ahead = flat[:, :2] / np.maximum(np.linalg.norm(flat[:, :2], axis=1, keepdims=True), _TINY)
    offset = SPACING_M * (np.arange(GLINTS) - (GLINTS - 1) / 2)
    places = middle[:, None, :2] + offset[:, None] * ahead[:, None]
    normals = np.moveaxis(upward_normals(waves.slope(time_s, *np.moveaxis(places, -1, 0))), 0, -1)
    behind = np.einsum("ij,ikj->ik", lamps - middle, normals)
    shown = lamps[:, None] - 2 * behind[..., None] * normals
    cosine = np.einsum("ikj,ikj->ik", shown, normals) / np.linalg.norm(shown, axis=-1)
    # A facet that turns its back on the camera shows nothing.
    return shown, np.where(cosine > 0, reflectance_from_below(np.maximum(cosine, 0)), 0)
