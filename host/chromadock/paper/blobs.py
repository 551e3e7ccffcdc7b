"""Round spots in the mask by the Laplacian of Gaussian over several scales."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.paper.peaks import SIGMAS, Spot, find_peaks

# A lit core clips to near white and fails the mask, which leaves a ring.  The authors' code
# widens the mask by a 5 x 5 blur first; without it few markers nearer than two metres are
# found (docs/method.md has the figures).
_WIDEN = np.ones((5, 5), np.uint8)

# Fewer pixels than these are noise or a JPEG block's corner.
MIN_AREA = 4

# More spots than these are no view of four markers; the strongest are kept, so that a
# frame full of noise costs a bounded time.
MAX_BLOBS = 64


def find_spots(mask: NDArray[np.uint8]) -> list[Spot]:
    """Spots of a (H, W) uint8 mask (0 or 255), strongest first, at most MAX_BLOBS.

    A spot is a maximum of the negative Laplacian of Gaussian of the widened mask over
    place and scale, with at least MIN_AREA mask pixels in it; its centre is their centroid.
    """
    left, top, width, height = cv2.boundingRect(mask)
    if width == 0:
        return []
    # Beyond this margin about the set pixels even the widest filter gives nothing.
    margin = int(4 * SIGMAS[-1])
    x0, y0 = max(0, left - margin), max(0, top - margin)
    window = mask[y0 : top + height + margin, x0 : left + width + margin]

    spots: list[Spot] = []
    widened = np.asarray(cv2.dilate(window, _WIDEN), np.uint8)
    for peak in sorted(find_peaks(widened), key=lambda p: -p.response):
        spot = _centred(window, peak)
        if spot is not None and not any(_same_place(spot, s) for s in spots):
            spots.append(spot)
            if len(spots) == MAX_BLOBS:
                break
    return [replace(s, x=s.x + x0, y=s.y + y0) for s in spots]


def _centred(mask: NDArray[np.uint8], spot: Spot) -> Spot | None:
    """The spot moved to the centroid of the mask inside it; None if that is too small."""
    x0, y0 = max(0, int(spot.x - spot.radius)), max(0, int(spot.y - spot.radius))
    x1, y1 = int(spot.x + spot.radius) + 2, int(spot.y + spot.radius) + 2
    ys, xs = np.nonzero(mask[y0:y1, x0:x1])
    xs, ys = xs + x0, ys + y0
    inside = (xs - spot.x) ** 2 + (ys - spot.y) ** 2 <= spot.radius**2
    area = np.count_nonzero(inside)
    if area < MIN_AREA:
        return None
    x, y = (int(place[inside].sum()) / area for place in (xs, ys))  # much faster than mean()
    return Spot(x, y, spot.radius, spot.response)


def _same_place(a: Spot, b: Spot) -> bool:
    return (a.x - b.x) ** 2 + (a.y - b.y) ** 2 < max(a.radius, b.radius) ** 2
