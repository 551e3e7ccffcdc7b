"""Solid shapes as the rays of a camera meet them: exact outlines, whatever the lens does.

Nothing is projected: each pixel's ray is tested against the shape, so distortion, shapes
behind the camera and shapes that fill the image need no cases of their own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.transform import Transform

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

NEAR_M = 0.05
"""What comes nearer to the lens than this is not drawn."""


@dataclass(frozen=True, eq=False)
class Hits:
    """Where rays meet a shape.

    Parameters
    ----------
    index
        (M,) which of the rays do.
    coverage
        (M,) share of the ray's pixel that the shape fills, above 0, at most 1.
    range_m
        (M,) distance along the ray.
    normal
        (3, M) outward unit normals.
    along
        (M,) place from the first of the shape's ``spots`` to the last, 0..1; None: all at one.
    """

    index: NDArray[np.intp]
    coverage: Singles
    range_m: Singles
    normal: Singles
    along: Singles | None = None


class Shape(Protocol):
    """A solid in some frame, metres."""

    @property
    def spots(self) -> Floats:
        """(K, 3) points along the shape, close enough to interpolate the light between."""

    @property
    def bound(self) -> tuple[Floats, float]:
        """(3,) centre and radius of a sphere around it, metres."""

    def moved(self, T_a_b: Transform) -> Shape:
        """The shape, given in frame b, in frame a."""

    def coverage(self, rays: Singles, soft_rad: float) -> Singles:
        """(N,) share of each pixel that is filled, 0..1, its edge ``soft_rad`` wide.

        ``rays`` is (3, N), unit vectors from the origin.
        """

    def hits(self, rays: Singles, soft_rad: float) -> Hits:
        """The places that are met, where the coverage is above 0."""
