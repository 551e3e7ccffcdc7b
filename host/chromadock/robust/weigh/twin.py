"""The dock and its image in the water's surface.

Seen from below, the surface is a mirror.  The image has the dock's colour and blinks with it;
mirrored, a rectangle is a rectangle again, with its top at the bottom.  But each image lies
straight above what it is an image of, and no nearer.
"""

from __future__ import annotations

import numpy as np

from chromadock.camera import CameraModel
from chromadock.robust.weigh.acceptance import Constellation

MAX_LEAN_RAD = np.radians(20.0)
"""Between the dock's own up and the way to the image: twice the dock's usual roll."""

MAX_ENLARGEMENT = 1.15
"""Of the image: it is never larger, but measured with some error, and waves stretch it."""

LEAST_SHARE = 0.5
"""Of the image's evidence that what it is an image of has: it is never fainter, but struts may
stand about it.  Clutter where an original might be is no reason to give a dock up."""


def is_image_of(upper: Constellation, lower: Constellation, camera: CameraModel) -> bool:
    """Whether ``upper`` can be the image of ``lower`` in a level surface above."""
    if lower.evidence < LEAST_SHARE * upper.evidence:
        return False
    pose = lower.poses[0]
    base, tip = camera.project(np.array([pose.t, pose.t - 0.1 * pose.R[:, 1]]))
    up = tip - base
    way = upper.xy.mean(axis=0) - lower.xy.mean(axis=0)
    upright = way @ up > np.cos(MAX_LEAN_RAD) * np.linalg.norm(way) * np.linalg.norm(up)
    sizes = [np.ptp(c.xy, axis=0).max() for c in (upper, lower)]
    return bool(upright and sizes[0] < MAX_ENLARGEMENT * sizes[1])
