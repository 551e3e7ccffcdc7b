"""Flat shapes: panels, and boxes of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.shapes import NEAR_M, Hits
from chromadock.sim.transform import Transform

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

_EDGE_ON = 1e-3
_TOWARDS = np.array([0.0, 0.0, -1.0])


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
        if self._facing is None:
            return np.zeros(rays.shape[1], np.float32)
        beyond = _beyond(self._planes, rays, soft_rad)
        # Opposite edges both count, so that what is thinner than a pixel fills its share.
        across, down = beyond[0] + beyond[1] - 1, beyond[2] + beyond[3] - 1
        return np.asarray(np.maximum(across, 0) * np.maximum(down, 0))

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

    @cached_property
    def _planes(self) -> Singles:
        """(4, 3) of the edges, opposite ones beside each other."""
        across, down = self.half_across, self.half_down
        edges = ((across, down), (-across, down), (down, across), (-down, across))
        planes = [_edge_plane(self.centre + out, edge, self.centre) for out, edge in edges]
        return np.array(planes, np.float32)

    @cached_property
    def _facing(self) -> Floats | None:
        """(3,) the unit normal that faces the origin; None for a panel seen edge on."""
        normal = _cross(self.half_across, self.half_down)
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
        if not len(self._planes):
            return np.zeros(rays.shape[1], np.float32)
        return np.asarray(_beyond(self._planes, rays, soft_rad).min(axis=0))

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

    @cached_property
    def _planes(self) -> Singles:
        """(P, 3) of the edges of the outline; none from inside."""
        camera = -self.centre @ self.axes
        faces = [(i, side) for i in range(3) for side in (-1, 1)]
        seen = {face: face[1] * camera[face[0]] > self.half[face[0]] for face in faces}
        planes = []
        for one, other in combinations(faces, 2):
            if one[0] != other[0] and seen[one] != seen[other]:
                corner = self.centre.copy()
                for i, side in (one, other):
                    corner += side * self.half[i] * self.axes[:, i]
                along = self.axes[:, 3 - one[0] - other[0]]
                planes.append(_edge_plane(corner, along, self.centre))
        return np.array(planes, np.float32).reshape(-1, 3)


def _cross(a: Floats, b: Floats) -> Floats:
    """(3,) cross product; numpy's own is made for many, and slow for two."""
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def _edge_plane(corner: Floats, edge: Floats, inside: Floats) -> Floats:
    """(3,) unit normal, towards ``inside``, of the plane of the origin and an edge."""
    plane = _cross(corner, edge)
    return np.asarray(plane * (np.sign(plane @ inside) / math.sqrt(plane @ plane)))


def _beyond(planes: Singles, rays: Singles, soft_rad: float) -> Singles:
    """(P, N) share of each pixel on the inner side of each plane, 0..1."""
    beyond = (planes / np.float32(soft_rad)) @ rays
    beyond += np.float32(0.5)
    return np.asarray(np.clip(beyond, 0, 1, out=beyond))
