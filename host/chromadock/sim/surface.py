"""The water's surface from below: total reflection, Snell's window, and waves that break both."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.ambient import REFRACTIVE_INDEX

Real = TypeVar("Real", np.float32, np.float64)


class Split(NamedTuple):
    """What lines of sight that meet the surface from below show.

    Attributes
    ----------
    reflectance
        (...) share of the light that comes from the water, 0..1; the rest is the sky's.
    reflected
        (3, ...) unit vectors into the water, world; never upwards.
    refracted
        (3, ...) unit vectors into the air, world; meaningless where reflection is total.
    """

    reflectance: NDArray[np.float32]
    reflected: NDArray[np.float32]
    refracted: NDArray[np.float32]


def reflectance_from_below(cosine: NDArray[Real]) -> NDArray[Real]:
    """Fresnel's reflectance for unpolarised light out of the water, 1 beyond the critical angle.

    Born, M. and Wolf, E. (1999), "Principles of Optics", section 1.5.2.

    Parameters
    ----------
    cosine : (...) of the angle of incidence in the water, 0..1.
    """
    n = REFRACTIVE_INDEX
    cosine_air = np.sqrt(np.maximum(1 - n**2 * (1 - cosine**2), 0))
    # Grazing light has both cosines 0: it is totally reflected all the same.
    cosine = np.maximum(cosine, 1e-6)
    across = (n * cosine - cosine_air) / (n * cosine + cosine_air)
    along = (cosine - n * cosine_air) / (cosine + n * cosine_air)
    return np.asarray((across**2 + along**2) / 2)


@lru_cache(maxsize=1)
def sky_transmittance() -> float:
    """Share of an evenly bright sky's irradiance that enters flat water.

    By the optical path's reversibility, that of the light in Snell's cone that gets out:
    the integral of 2 n^2 (1 - R) cos from the critical angle's cosine to 1.
    """
    n = REFRACTIVE_INDEX
    edges = np.linspace(math.sqrt(1 - 1 / n**2), 1, 4097)
    cosine = (edges[1:] + edges[:-1]) / 2
    leaves = 2 * n**2 * (1 - reflectance_from_below(cosine)) * cosine
    return float(leaves.mean() * (edges[-1] - edges[0]))


def upward_normals(slope: NDArray[Real]) -> NDArray[Real]:
    """(..., 2) slopes, as ``GaussianField.slope`` gives them, to (3, ...) unit vectors, world.

    They point out of the water.
    """
    x, y = -slope[..., 0], -slope[..., 1]
    up = 1 / np.sqrt(1 + x**2 + y**2)
    return np.stack([x * up, y * up, -up])


def split(directions: NDArray[np.float32], normals: NDArray[np.float32]) -> Split:
    """Reflect and refract lines of sight at facets of the surface.

    Parameters
    ----------
    directions : (3, ...) unit vectors from the eye, world, upwards.
    normals : (3, ...) unit vectors out of the water.
    """
    n = REFRACTIVE_INDEX
    # A facet that turns its back on the eye is hidden by another: grazing is its limit.
    cosine = np.maximum(np.einsum("i...,i...", directions, normals), np.float32(0))
    reflected = directions - 2 * cosine * normals
    np.maximum(reflected[2], 0, out=reflected[2])
    cosine_air = np.sqrt(np.maximum(1 - n**2 * (1 - cosine**2), 0))
    refracted = n * directions + (cosine_air - n * cosine) * normals
    return Split(reflectance_from_below(cosine), reflected, refracted)
