"""Solid shapes as the rays of a camera meet them: exact outlines, whatever the lens does.

Nothing is projected: each pixel's ray is tested against the shape, so distortion, shapes
behind the camera and shapes that fill the image need no cases of their own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.transform import Transform

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

NEAR_M = 0.05
"""What comes nearer to the lens than this is not drawn."""
_SPACING_M = 0.1
_EDGE_ON = 1e-3
_TOWARDS = np.array([0.0, 0.0, -1.0])


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


@dataclass(frozen=True, eq=False)
class Panel:
    """A flat parallelogram, seen from both sides: ``centre`` and half its edges, (3,) each."""

    centre: Floats
    half_across: Floats
    half_down: Floats

    @property
    def spots(self) -> Floats:
        """See ``Shape``."""
        return self.centre[None]

    @property
    def bound(self) -> tuple[Floats, float]:
        """See ``Shape``."""
        corners = (self.half_across + self.half_down, self.half_across - self.half_down)
        return self.centre, max(math.sqrt(corner @ corner) for corner in corners)

    def moved(self, T_a_b: Transform) -> Panel:
        """See ``Shape``."""
        across, down = (T_a_b.directions(v) for v in (self.half_across, self.half_down))
        return Panel(T_a_b.points(self.centre), across, down)

    def coverage(self, rays: Singles, soft_rad: float) -> Singles:
        """See ``Shape``.

        Each edge and the camera span a plane; the panel is seen between all four.
        """
        covered = np.ones(rays.shape[1], np.float32)
        if self._facing is None:
            return np.zeros_like(covered)
        for out, edge in (
            (self.half_across, self.half_down),
            (self.half_down, self.half_across),
        ):
            # Both edges count, as in ``_covered``.
            between = np.full_like(covered, -1)
            for side in (out, -out):
                plane = _edge_plane(self.centre + side, edge, self.centre)
                between += _beyond(plane, rays, soft_rad)
            covered *= np.maximum(between, 0)
        return covered

    def hits(self, rays: Singles, soft_rad: float) -> Hits:
        """See ``Shape``."""
        covered = self.coverage(rays, soft_rad)
        met = np.flatnonzero(covered)
        normal = _TOWARDS if self._facing is None else self._facing
        towards = np.minimum(normal.astype(np.float32) @ rays[:, met], np.float32(-_EDGE_ON))
        centre, radius = self.bound
        # Soft edges reach a little beyond the panel, where a slanting plane runs off.
        farthest = math.sqrt(centre @ centre) + radius
        range_m: Singles = np.clip(np.float32(self.centre @ normal) / towards, NEAR_M, farthest)
        normals = np.broadcast_to(normal.astype(np.float32)[:, None], (3, len(met)))
        return Hits(met, covered[met], range_m, normals)

    @property
    def _facing(self) -> Floats | None:
        """(3,) the unit normal that faces the origin; None for a panel seen edge on."""
        normal = cross(self.half_across, self.half_down)
        normal /= math.sqrt(normal @ normal)
        cosine = normal @ self.centre / math.sqrt(self.centre @ self.centre)
        return None if abs(cosine) < _EDGE_ON else np.asarray(-np.sign(cosine) * normal)


@dataclass(frozen=True, eq=False)
class Box:
    """A box: ``centre`` (3,), its unit axes as columns (3, 3), half its edges (3,)."""

    centre: Floats
    axes: Floats
    half: Floats

    @property
    def spots(self) -> Floats:
        """See ``Shape``."""
        return self.centre[None]

    @property
    def bound(self) -> tuple[Floats, float]:
        """See ``Shape``."""
        return self.centre, math.sqrt(self.half @ self.half)

    def moved(self, T_a_b: Transform) -> Box:
        """See ``Shape``."""
        return Box(T_a_b.points(self.centre), T_a_b.R @ self.axes, self.half)

    def coverage(self, rays: Singles, soft_rad: float) -> Singles:
        """See ``Shape``.

        The outline are the edges between faces that the camera sees and faces that it does
        not; nothing is seen from inside.
        """
        camera = -self.centre @ self.axes
        faces = [(i, side) for i in range(3) for side in (-1, 1)]
        seen = {face: face[1] * camera[face[0]] > self.half[face[0]] for face in faces}
        if not any(seen.values()):
            return np.zeros(rays.shape[1], np.float32)
        covered = np.ones(rays.shape[1], np.float32)
        for one, other in combinations(faces, 2):
            if one[0] != other[0] and seen[one] != seen[other]:
                corner = self.centre.copy()
                for i, side in (one, other):
                    corner += side * self.half[i] * self.axes[:, i]
                along = self.axes[:, 3 - one[0] - other[0]]
                plane = _edge_plane(corner, along, self.centre)
                np.minimum(covered, _beyond(plane, rays, soft_rad), out=covered)
        return covered

    def hits(self, rays: Singles, soft_rad: float) -> Hits:
        """See ``Shape``.  A ray enters where it has crossed the last of three slabs."""
        covered = self.coverage(rays, soft_rad)
        met = np.flatnonzero(covered)
        axes = self.axes.astype(np.float32)
        camera = (-self.centre @ self.axes).astype(np.float32)[:, None]
        speed = axes.T @ rays[:, met]
        speed = np.where(np.abs(speed) < 1e-6, np.float32(1e-6), speed)
        enters = (-np.sign(speed) * self.half.astype(np.float32)[:, None] - camera) / speed
        face = enters.argmax(axis=0)
        normal = -np.sign(np.take_along_axis(speed, face[None], axis=0)) * axes[:, face]
        centre, radius = self.bound
        range_m = np.clip(enters.max(axis=0), NEAR_M, math.sqrt(centre @ centre) + radius)
        return Hits(met, covered[met], range_m, normal)


def cross(a: Floats, b: Floats) -> Floats:
    """(3,) cross product; numpy's own is made for many, and slow for two."""
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def _edge_plane(corner: Floats, edge: Floats, inside: Floats) -> Floats:
    """(3,) unit normal, towards ``inside``, of the plane of the origin and an edge."""
    plane = cross(corner, edge)
    return np.asarray(plane * (np.sign(plane @ inside) / math.sqrt(plane @ plane)))


def _beyond(plane: Floats, rays: Singles, soft_rad: float) -> Singles:
    """(N,) share of each pixel on the plane's inner side, 0..1."""
    beyond = (plane / soft_rad).astype(np.float32) @ rays
    beyond += np.float32(0.5)
    return np.asarray(np.clip(beyond, 0, 1, out=beyond))


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
