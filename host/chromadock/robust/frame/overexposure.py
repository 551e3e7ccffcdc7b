"""Lamps that are brighter than the camera can tell, and by how much."""

from __future__ import annotations

import math
import statistics

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.response import GAMMA

CLIPPED = 250
"""Pixels of such a value, of 255, may have been brighter: JPEG takes some off."""

MOST_STOPS = 8.0
"""More is not told: the edge of a plateau is then sharper than pixels show."""

LARGEST_ROOM_PX = 80
"""Half the side of the square about a lamp that is looked at, where no other lamp is nearer."""


def clipped_at(frame_bgr: NDArray[np.uint8], xy: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether lamps at (n, 2) pixels are overexposed there, in some channel."""
    height, width = frame_bgr.shape[:2]
    last = np.array([width - 1, height - 1])
    column, row = np.minimum(np.maximum(np.rint(xy).astype(np.intp), 0), last).T
    return np.asarray(frame_bgr[row, column].max(axis=1) >= CLIPPED)


def have_cores(frame_bgr: NDArray[np.uint8], xy: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether lamps at (n, 2) pixels are overexposed over 3 x 3 pixels there, or more."""
    around = np.stack(np.meshgrid((-1, 0, 1), (-1, 0, 1)), axis=-1).reshape(9, 1, 2)
    clipped = clipped_at(frame_bgr, (xy + around).reshape(-1, 2)).reshape(9, -1)
    return np.asarray(clipped.all(axis=0))


def stops_over(frame_bgr: NDArray[np.uint8], xy: NDArray[np.float64]) -> float:
    """By how many stops the exposure should be shorter for lamps at ``xy`` not to clip.

    The light about a lamp is taken to fall exponentially with the distance from its centre, as
    scattered light does (Voss, Applied Optics 30 (1991) 2647).  It halves between the edge of
    the plateau, at radius r, and that of all that is half as bright, at radius r'; so it doubles
    r / (r' - r) times from the edge to the centre.  Both radii come from the areas.  A lamp with
    a sharp edge looks brighter than it is by that, one that is much too bright less so.

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    xy : (n, 2) pixels.

    Returns
    -------
    The median of the lamps that clip, 0..MOST_STOPS; 0 where none does.
    """
    clipped = clipped_at(frame_bgr, xy)
    if not clipped.any():
        return 0.0
    apart = np.linalg.norm(xy[:, None] - xy, axis=2)
    np.fill_diagonal(apart, 2 * LARGEST_ROOM_PX)
    room = np.minimum(apart.min(axis=1) / 2, LARGEST_ROOM_PX)
    lamps = zip(*xy[clipped].T.tolist(), room[clipped].tolist(), strict=True)
    return statistics.median(_stops_of(frame_bgr, x, y, half) for x, y, half in lamps)


def _stops_of(frame_bgr: NDArray[np.uint8], x: float, y: float, half: float) -> float:
    """The same of one lamp, in the square of ``half`` the side about it."""
    height, width = frame_bgr.shape[:2]
    left = min(max(math.floor(x - half), 0), width - 1)
    top = min(max(math.floor(y - half), 0), height - 1)
    about = cv2.split(frame_bgr[top : math.ceil(y + half) + 1, left : math.ceil(x + half) + 1])
    plateaus = [np.count_nonzero(channel >= CLIPPED) for channel in about]
    plateau = max(plateaus)
    if plateau == 0:
        return 0.0
    light = about[plateaus.index(plateau)]
    darkest = int(light.min())
    if darkest >= CLIPPED:
        return MOST_STOPS  # nothing about it tells more
    behind, full = ((v / 255) ** GAMMA for v in (darkest, CLIPPED))
    halved = 255 * (behind + (full - behind) / 2) ** (1 / GAMMA)
    inner, outer = math.sqrt(plateau), math.sqrt(np.count_nonzero(light >= math.ceil(halved)))
    doublings = min(inner / max(outer - inner, inner / MOST_STOPS), MOST_STOPS)
    return math.log2((behind + (full - behind) * 2**doublings) / full)
