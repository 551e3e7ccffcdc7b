"""From a scene's file to solid bodies: its ``[[body]]`` tables and the dock's own frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.dock import DockGeometry
from chromadock.sim.body import Body
from chromadock.sim.flat_shapes import Box, Panel
from chromadock.sim.round_shapes import Sphere, Tube
from chromadock.sim.scene_models import BodySection, DockSection
from chromadock.sim.shapes import Shape
from chromadock.sim.spectrum import reflectance

Floats = NDArray[np.float64]

FRAME_MARGIN_M = 0.06
"""From the markers to the frame around them."""
FRAME_RADIUS_M = 0.0125
"""One-inch tube."""
FRAME_BEHIND_M = 0.03
"""The lamps stand out before the frame."""


def frame_of(dock: DockGeometry, section: DockSection) -> list[Body]:
    """Four dark tubes around the markers; none where the scene has none."""
    if not section.frame:
        return []
    left, top, _ = dock.points.min(axis=0) - FRAME_MARGIN_M
    right, bottom, _ = dock.points.max(axis=0) + FRAME_MARGIN_M
    behind = float(dock.points[:, 2].max()) + FRAME_BEHIND_M
    corners = np.array(
        [(left, top, behind), (right, top, behind), (right, bottom, behind), (left, bottom, behind)]
    )
    paint = reflectance(section.frame_rgb)
    return [
        Body(Tube(start, end, FRAME_RADIUS_M), paint, "dock")
        for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]


def body_of(section: BodySection) -> Body:
    """The body of a ``[[body]]``.

    Raises
    ------
    ValueError
        For a shape without length or area, or a time without end, in words to follow its name.
    """
    present_s = None
    if section.present_s is not None:
        start, end = section.present_s
        if start >= end:
            raise ValueError(f"present_s is [{start:g}, {end:g}]: the first must be the smaller")
        present_s = (start, end)
    return Body(_shape(section), reflectance(section.rgb), section.fixed_to, present_s)


def _shape(section: BodySection) -> Shape:
    centre = np.array(section.centre_m, np.float64)
    if section.shape == "sphere":
        return Sphere(centre, section.radius_m)
    if section.shape == "box":
        return Box(centre, np.eye(3), np.array(section.size_m, np.float64) / 2)
    if section.shape == "tube":
        start, end = np.array(section.from_m, np.float64), np.array(section.to_m, np.float64)
        if np.linalg.norm(end - start) < section.radius_m / 100:
            raise ValueError("from_m and to_m are the same place: give the axis of a tube a length")
        return Tube(start, end, section.radius_m)
    across = np.array(section.half_across_m, np.float64)
    down = np.array(section.half_down_m, np.float64)
    if np.linalg.norm(np.cross(across, down)) < 1e-8:
        raise ValueError("half_across_m and half_down_m span no area: they must not be parallel")
    return Panel(centre, across, down)
