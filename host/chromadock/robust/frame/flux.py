"""How much light of each lamp arrives at the camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.native import lib, pointer
from chromadock.robust.frame.response import LINEAR

Real = NDArray[np.float64]

APERTURE_PER_SPACING = 0.35
"""Radius of the disc whose light is added up, of the distance between the closest markers: the ring
around it ends before the next lamp's disc."""
APERTURE_PER_WIDTH = 0.05
"""The same at most, of the frame's width: a lamp's core and halo from where a dock just fits in."""
LEAST_APERTURE_PX = 2.5
"""The same at least: the lens's blur."""


@dataclass(frozen=True, eq=False, slots=True)
class Fluxes:
    """Of n lamps: ``log`` (n,), natural logarithms up to a constant that all have in common, and
    ``sigma`` (n,), their standard deviations by the noise of the pixels alone."""

    log: Real
    sigma: Real


def fluxes(frame_bgr: NDArray[np.uint8], xy: Real) -> Fluxes | None:
    """Aperture photometry (Howell, PASP 101 (1989) 616) of lamps of one colour.

    The linear light of a disc about each lamp is added up, less the median of the ring around it.
    The channels are added with weights of what the lamps add to each, over how much the rings
    scatter in it.  ``host/native/flux.h`` says what is computed of each channel.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    xy : (n, 2) pixels, two or more.

    Returns
    -------
    None where some lamp adds no light.
    """
    frame, places = np.ascontiguousarray(frame_bgr), np.ascontiguousarray(xy, np.float64)
    apart = np.linalg.norm(places[:, None] - places, axis=2)
    np.fill_diagonal(apart, np.inf)
    widest = APERTURE_PER_WIDTH * frame.shape[1]
    radius = max(min(APERTURE_PER_SPACING * float(apart.min()), widest), LEAST_APERTURE_PX)
    added, variance = np.empty((2, len(places), 3))
    given = pointer(frame), *frame.shape[:2], pointer(LINEAR), len(places), pointer(places)
    lib.flux_measure(*given, radius, pointer(added), pointer(variance))
    weights = np.maximum(added.sum(axis=0), 0.0) / variance.sum(axis=0)
    flux = added @ weights
    if not flux.min() > 0:
        return None
    return Fluxes(np.log(flux), np.sqrt(variance @ weights**2) / flux)
