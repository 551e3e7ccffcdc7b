"""What makes markers impossible, or implausible, as a dock: each in words for one line."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

MIN_MARKERS = 3

MIN_SPACING_M = 0.001
"""Markers closer than their LEDs are wide are a slip of the pen."""

MAX_EXTENT_M = 10.0
"""Between two markers: more is a dock in centimetres or millimetres, unless its user says not."""

MAX_REACH_M = 1000.0
"""From the origin to a marker: more is no dock's own frame, and costs digits."""

_ONE_LINE = 1e-3  # width over length of markers that all lie on one
_FLAT = 0.1  # thickness over width of markers that are about in a plane
_EDGE_ON = float(np.sin(np.radians(10.0)))  # slope of that plane against the line of sight
_NEAR = 3.0  # extents from the dock to a vehicle that looks at it
_MERGED = 0.05  # of the dock's extent as that vehicle sees it: closer markers are one ...
_FORESHORTENED = 0.35  # ... if they are closer than they are by so much
_DEEP = 0.3  # over width

_CONFIRM = "confirm with --yes, or confirmed = true in its file"

_AXES = (
    (
        "ROS's (x forward, y left, z up) write [-y, -z, x]",
        np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]),
    ),
    (
        "x right, y forward, z up write [x, -z, y]",
        np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    ),
)
"""Other frames that users measure in, and the turn (3, 3) from each to the dock's."""


def fault_of(names: tuple[str, ...], points: Real, confirmed: bool) -> str | None:
    """What makes these (n, 3) markers no dock, or None; ``confirmed``: implausible is
    good enough."""
    if points.shape != (len(names), 3):
        return f"{len(names)} names but points of shape {points.shape}: give one x, y, z a name"
    if len(names) < MIN_MARKERS:
        return f"{len(names)} markers: a pose needs at least {MIN_MARKERS}, so add [[marker]]s"
    for name in names:
        if names.count(name) > 1:
            return f"the name {name} is used {names.count(name)} times: give each marker its own"
    for name, point in zip(names, points, strict=True):
        if not np.isfinite(point).all():
            return f"marker {name} has a position that is not finite: give metres"
        if np.abs(point).max() > MAX_REACH_M:
            return (
                f"marker {name} is {np.abs(point).max():g} m from the origin: give metres, "
                "from an origin on the dock or near it"
            )
    for (name_a, a), (name_b, b) in combinations(zip(names, points, strict=True), 2):
        if np.linalg.norm(a - b) < MIN_SPACING_M:
            return f"markers {name_a} and {name_b} are at the same place: correct one of them"
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if spread[1] < _ONE_LINE * spread[0]:
        return "all markers lie on one line, which gives no pose: move one of them off it"
    if confirmed:
        return None
    extent = _extent(points)
    if extent > MAX_EXTENT_M:
        return _too_large(extent)
    return _not_seen(points) if _edge_on(points) else None


def _extent(points: Real) -> float:
    """Metres between the two markers that are farthest apart."""
    return float(np.linalg.norm(points[:, None] - points[None], axis=2).max())


def _too_large(extent: float) -> str:
    """A dock is about a metre wide: of the units that make it so the nearer is proposed."""
    unit, over = min(
        (("centimetres", 100.0), ("millimetres", 1000.0)),
        key=lambda pair: abs(np.log(extent / pair[1])),
    )
    return (
        f"its markers are up to {extent:.4g} m apart: if these are {unit}, divide all by {over:g} "
        f"({extent / over:.3g} m); if not, {_CONFIRM}"
    )


def _edge_on(points: Real) -> bool:
    """Whether a vehicle that comes along z, as docks are approached, sees hardly more than a line.

    So it sees a plane that it looks along, unless that is far wider than deep, as a row of lamps
    that is bent back at its ends; and any dock of which markers hide each other.
    """
    centred = points - points.mean(axis=0)
    _, spread, axes = np.linalg.svd(centred)
    along = spread[2] < _FLAT * spread[1] and abs(axes[2, 2]) < _EDGE_ON
    if along and np.ptp(centred[:, 2]) > _DEEP * np.ptp(centred[:, :2], axis=0).max():
        return True
    extent = _extent(points)
    seen = _NEAR * extent * centred[:, :2] / (centred[:, 2:] + _NEAR * extent)
    apart = np.linalg.norm(centred[:, None] - centred[None], axis=2)
    as_seen = np.linalg.norm(seen[:, None] - seen[None], axis=2)
    merged = (as_seen < _MERGED * extent) & (as_seen < _FORESHORTENED * apart)
    # One marker may hide another, for a dock is found with a marker out too.
    hidden = np.count_nonzero(np.tril(merged, -1).any(axis=1))
    return bool(len(points) - hidden < max(MIN_MARKERS, len(points) - 1))


def _not_seen(points: Real) -> str:
    """With the frame that the user probably measured in."""
    wrong = "seen along z, as vehicles come, it is edge-on (x is right, y down, z away from them)"
    for words, turn in _AXES:
        if not _edge_on(points @ turn.T):
            return f"{wrong}: if your axes are {words}; if not, {_CONFIRM}"
    return f"{wrong}: correct the positions, or {_CONFIRM}"
