"""How far bright bars that lead from lamp to lamp may draw the tops of their light aside.

A bar ends at its lamp, so that smoothed light slopes there, towards the bar; the top of lamp and
bar together is where the slope of the one is that of the other.  All lamps of a dock are drawn so
at once, and in each frame alike: towards each other, by pixels where bars are as bright as the
lamps, and the dock seems smaller and farther.  A black holder ends a bar before its lamp, and then
nothing is drawn.  Which of both it is the light does not tell, so that this is an error that all
markers of a frame share, and no correction.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.native import lib, pointer
from chromadock.robust.frame.response import LINEAR

Real = NDArray[np.float64]

FOLLOWED = 0.8
"""Of that way lamps go, one standard error: most not at all, for they have dark holders, and some
all the way.  Of 40 drawn approaches to all docks of the half that was developed on 1 pose of 7,709
that the track tells is wrong, with 0.6 of the way 26 of 7,794."""

# From ln(1 + x), above Lambert's W and near it: so many make it right to a thousandth.
_ROUNDS = 5


def smaller(xy: Real, lean: Real) -> float:
    """By which share of its size a dock with lamps at (n, 2) pixels may look smaller, one standard
    error, if each may lean by (n, 2) pixels.

    Of the shape nothing is told: that a dock which is drawn together along one bar alone seems
    turned is of second order, and linear errors make much too much of it.
    """
    arms = xy - xy.mean(axis=0)
    return FOLLOWED * max(-float((lean * arms).sum() / (arms**2).sum()), 0.0)


def lean_by_bars(
    frame_bgr: NDArray[np.uint8], xy: Real, width_px: Real, give: Real, weights: NDArray[np.float32]
) -> Real:
    """(n, 2) pixels: by how much bars as bright as the middle of the way from each lamp to each
    other would draw its top aside.

    At x from a bar's end its light slopes less, by exp(-x^2 / 2 w^2), smoothed by w; so the way of
    a top whose light would go by r w for the slope at the end is x = w sqrt(W(r^2)), with Lambert's
    W (Corless et al., Advances in Computational Mathematics 5 (1996) 329).

    Parameters
    ----------
    frame_bgr : (H, W, 3) uint8.
    xy : (n, 2) pixels.
    width_px : (n,) standard deviations of the smoothing that the tops are of, pixels.
    give : (n,) pixels by which a slope of the smoothed light of 1 per pixel moves a top.
    weights : (3,) of the channels, BGR.
    """
    frame, places = np.ascontiguousarray(frame_bgr), np.ascontiguousarray(xy, np.float64)
    widths, slopes = np.ascontiguousarray(width_px, np.float64), np.empty_like(places)
    given = pointer(frame), *frame.shape[:2], pointer(LINEAR), pointer(weights), len(places)
    lib.bars_slopes(*given, pointer(places), pointer(widths), pointer(slopes))
    linear = give[:, None] * slopes
    far = np.linalg.norm(linear, axis=1)
    way = width_px * np.sqrt(_lambert((far / width_px) ** 2))
    return np.asarray(linear * (way / np.maximum(far, 1e-12))[:, None])


def _lambert(values: Real) -> Real:
    """(n,) of which each times its own exponential is one of ``values``, 0 or more: Newton's
    rounds from above."""
    found = np.log1p(values)
    for _ in range(_ROUNDS):
        grown = np.exp(found)
        found = found - (found * grown - values) / (grown * (1 + found))
    return np.asarray(found)
