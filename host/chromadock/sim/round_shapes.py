"""Round shapes: balls and bars."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.shapes import NEAR_M, Hits
from chromadock.sim.transform import Transform

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

_SPACING_M = 0.1
_EDGE_ON = 1e-3


@dataclass(frozen=True, eq=False)
class Sphere:
    """A ball: ``centre`` (3,) and ``radius_m``."""

    centre: Floats
    radius_m: float

    @property
    def spots(self) -> Floats:
        """See ``Shape``."""
        return self.centre[None]

    @property
    def bound(self) -> tuple[Floats, float]:
        """See ``Shape``."""
        return self.centre, self.radius_m

    def moved(self, T_a_b: Transform) -> Sphere:
        """See ``Shape``."""
        return Sphere(T_a_b.points(self.centre), self.radius_m)

    def coverage(self, rays: Singles, soft_rad: float) -> Singles:
        """See ``Shape``."""
        _, range_m, distance = self._nearest(rays)
        return _covered(distance, self.radius_m, soft_rad, range_m)

    def hits(self, rays: Singles, soft_rad: float) -> Hits:
        """See ``Shape``."""
        offset, range_m, distance = self._nearest(rays)
        covered = _covered(distance, self.radius_m, soft_rad, range_m)
        met = np.flatnonzero(covered)
        depth = _half_chord(self.radius_m, distance[met])
        normal = _unit(offset[:, met] - depth * rays[:, met])
        return Hits(met, covered[met], range_m[met] - depth, normal)

    def _nearest(self, rays: Singles) -> tuple[Singles, Singles, Singles]:
        """(3, N) from the centre to each ray, (N,) distance along the ray, (N,) from it."""
        centre = self.centre.astype(np.float32)
        range_m = centre @ rays
        offset = range_m * rays - centre[:, None]
        return offset, range_m, _length(offset)


@dataclass(frozen=True, eq=False)
class Tube:
    """A round bar with round ends: its axis from ``start`` to ``end`` (3,), ``radius_m``."""

    start: Floats
    end: Floats
    radius_m: float

    @property
    def spots(self) -> Floats:
        """See ``Shape``."""
        count = 1 + math.ceil(math.dist(self.start, self.end) / _SPACING_M)
        return np.linspace(self.start, self.end, count)

    @property
    def bound(self) -> tuple[Floats, float]:
        """See ``Shape``."""
        half = (self.end - self.start) / 2
        return self.start + half, math.sqrt(half @ half) + self.radius_m

    def moved(self, T_a_b: Transform) -> Tube:
        """See ``Shape``."""
        return Tube(T_a_b.points(self.start), T_a_b.points(self.end), self.radius_m)

    def coverage(self, rays: Singles, soft_rad: float) -> Singles:
        """See ``Shape``."""
        _, range_m, distance, _ = self._nearest(rays)
        return _covered(distance, self.radius_m, soft_rad, range_m)

    def hits(self, rays: Singles, soft_rad: float) -> Hits:
        """See ``Shape``."""
        offset, range_m, distance, along = self._nearest(rays)
        covered = _covered(distance, self.radius_m, soft_rad, range_m)
        met = np.flatnonzero(covered)
        axis, rays = self._axis, rays[:, met]
        inwards = rays - (axis @ rays) * axis[:, None]
        slant = np.maximum(_length(inwards), np.float32(_EDGE_ON))
        depth = np.asarray(_half_chord(self.radius_m, distance[met]) / slant, np.float32)
        normal = _unit(offset[:, met] - depth * inwards)
        # Along the axis a ray would meet the round end long before.
        nearer = np.minimum(depth, np.float32(10 * self.radius_m))
        return Hits(met, covered[met], range_m[met] - nearer, normal, along[met])

    @property
    def _axis(self) -> Singles:
        axis = self.end - self.start
        return np.asarray(axis / math.sqrt(axis @ axis), np.float32)

    def _nearest(self, rays: Singles) -> tuple[Singles, Singles, Singles, Singles]:
        """(3, N) from the axis to each ray, (N,) distance along the ray, (N,) from it, place.

        The two lines' nearest points, that on the axis kept between its ends.
        """
        start, axis = self.start.astype(np.float32), self._axis
        length = np.float32(math.dist(self.start, self.end))
        cosine, to_start, before = axis @ rays, start @ rays, start @ axis
        range_m = (to_start - before * cosine) / np.maximum(1 - cosine**2, np.float32(1e-6))
        along = np.clip(range_m * cosine - before, 0, length)
        range_m = to_start + along * cosine
        offset = range_m * rays - start[:, None] - along * axis[:, None]
        return offset, range_m, _length(offset), along / length


def _covered(distance: Singles, radius_m: float, soft_rad: float, range_m: Singles) -> Singles:
    """(N,) share of a pixel whose middle passes an axis at ``distance``.

    Both edges count, so that what is thinner than a pixel fills its share and no more.
    """
    soft = np.float32(soft_rad) * np.maximum(range_m, np.float32(NEAR_M))
    near = np.clip((np.float32(radius_m) - distance) / soft + np.float32(0.5), 0, 1)
    far = np.clip((np.float32(radius_m) + distance) / soft + np.float32(0.5), 0, 1)
    covered = near + far - 1
    covered[range_m < NEAR_M] = 0
    return np.asarray(covered)


def _half_chord(radius_m: float, distance: Singles) -> Singles:
    return np.asarray(np.sqrt(np.maximum(np.float32(radius_m**2) - distance**2, 0)))


def _length(vectors: Singles) -> Singles:
    x, y, z = vectors
    return np.asarray(np.sqrt(x * x + y * y + z * z))


def _unit(vectors: Singles) -> Singles:
    return np.asarray(vectors / np.maximum(_length(vectors), np.float32(1e-9)))
