"""Turns after which a dock looks the same: what markers that all shine alike cannot tell apart.

A square does so after each quarter turn about its normal, a rectangle after a half turn; the pose
is then known up to such a turn, and only what else is known of the attitude decides.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Symmetry = tuple[tuple[int, ...], Floats]

TOLERANCE = 0.02
"""Of the dock's extent, by which markers may be off their symmetrical places: two pixels of a dock
100 pixels wide, which noise hides in part of the frames."""

TOLERANCE_M = 0.01
"""The same for a small dock: as exactly as an LED's place is measured with a rule."""

_OF_SPACING = 0.25  # of the least distance of two markers: which is which stays clear
_FACING = 1e-6  # cosine of the least turn away from the vehicle: a right angle


def symmetries(points: Floats) -> tuple[Symmetry, ...]:
    """Proper rotations about the centroid that map a set of markers onto itself.

    Only those after which the dock's front is still in front (its z axis, away from the vehicle,
    turned by less than a right angle) are of interest: a dock from behind shows no markers.

    Parameters
    ----------
    points : (N, 3) float64, metres, dock frame, N >= 2.

    Returns
    -------
    Pairs of a permutation and ``R_dock_dock`` (3, 3), those of the least turn first, the identity
    left out: marker ``i`` turned by R lies where marker ``permutation[i]`` was,
    ``R @ (points[i] - centroid) = points[permutation[i]] - centroid`` up to TOLERANCE.  Empty for
    a dock without symmetry.  For markers on one line, which look alike after any turn about it,
    only the half turn that reverses them.  Each permutation once; R is Kabsch's (Acta
    Crystallographica A32 (1976) 922), the best for it.
    """
    centred = points - points.mean(axis=0)
    allowed = _allowed(points)
    found: dict[tuple[int, ...], Floats] = {}
    for R in _turns(centred, allowed):
        order = _order(centred, R, allowed)
        if order is None or order in found or order == tuple(range(len(points))):
            continue
        best = R if _on_a_line(centred, allowed) else _kabsch(centred, centred[list(order)])
        if best[2, 2] > _FACING and _order(centred, best, allowed) == order:
            found[order] = best
    return tuple(sorted(found.items(), key=lambda pair: -float(np.trace(pair[1]))))


def _allowed(points: Floats) -> float:
    """How far a marker may be off, metres."""
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    least = apart[~np.eye(len(points), dtype=bool)].min()
    return float(min(max(TOLERANCE * apart.max(), TOLERANCE_M), _OF_SPACING * least))


def _on_a_line(centred: Floats, allowed: float) -> bool:
    """Whether all markers are on one line, as exactly as they are known."""
    along = np.linalg.svd(centred)[2][0]
    aside = centred - np.outer(centred @ along, along)
    return bool(np.linalg.norm(aside, axis=1).max() < allowed)


def _turns(centred: Floats, allowed: float) -> list[Floats]:
    """Rotations (3, 3) that may be symmetries: each takes two markers, the base, to two others.

    A base that the centroid is not in line with fixes the rotation.
    """
    if _on_a_line(centred, allowed):
        return [_half_turn(np.linalg.svd(centred)[2][0])]
    count = len(centred)
    area = np.linalg.norm(np.cross(centred[:, None], centred[None]), axis=2)
    a, b = np.unravel_index(area.argmax(), area.shape)
    base = centred[[a, b]]
    turns = []
    for i, j in permutations(range(count), 2):
        other = centred[[i, j]]
        lengths = np.linalg.norm(other, axis=1) - np.linalg.norm(base, axis=1)
        between = np.linalg.norm(other[0] - other[1]) - np.linalg.norm(base[0] - base[1])
        if np.abs(lengths).max() < allowed and abs(between) < 2 * allowed:
            turns.append(_kabsch(base, other))
    return turns


def _half_turn(along: Floats) -> Floats:
    """Reverses a direction (3,), about the axis across it that is nearest to z."""
    axis = np.array([0.0, 0.0, 1.0]) - along[2] * along
    length = float(np.linalg.norm(axis))
    axis = np.array([1.0, 0.0, 0.0]) if length < _FACING else axis / length
    return np.asarray(2 * np.outer(axis, axis) - np.eye(3))


def _order(centred: Floats, R: Floats, allowed: float) -> tuple[int, ...] | None:
    """Which marker each comes to lie on; None where one lies on none, or two on one."""
    apart = np.linalg.norm((centred @ R.T)[:, None] - centred[None], axis=2)
    nearest = apart.argmin(axis=1)
    if apart.min(axis=1).max() > allowed or len(set(nearest.tolist())) < len(centred):
        return None
    return tuple(nearest.tolist())


def _kabsch(these: Floats, onto: Floats) -> Floats:
    """(3, 3) the proper rotation that takes points (N, 3) nearest to others, least squares."""
    left, _, right = np.linalg.svd(onto.T @ these)
    proper = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    return np.asarray(left @ proper @ right)
