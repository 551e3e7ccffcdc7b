"""How much more like a lamp than like clutter of the same strength a peak looks.

The log of a ratio of two densities, each over what is seen about a peak: how round its top is,
whether a ridge goes on to both sides, how much light there is about it, whether a ridge joins it
to a stronger peak, and how much light it takes away in some channel.  Two logistic regressions
give it (the ratio of posterior odds with what is seen to those by strength and scale alone is the
ratio of densities); ``tools/fit_likeness.py`` fits them to scenes of all kinds.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import resources

import numpy as np
from numpy.typing import NDArray

from chromadock.toml_file import read_toml

FILE = "likeness.toml"

MOST_LOG_SNR = float(np.log(60.0))
"""A lamp that outshines the noise by more looks the same."""

Real = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Looks:
    """What is seen about N peaks, all (N,) and about 0..1: 0 is a lamp's.

    ``flatness``: 1 less four times determinant over squared trace of the Hessian: 0 for a round
    top, 1 on a ridge.  ``ridge``: the weaker of two opposite sides over the peak, where that is
    largest.  ``halo``: mean of eight places three cells off, over the peak.  ``neighbour``: the
    second largest of them.  ``saddle``: the least on the way to the stronger peak that is joined
    best, over the peak.  ``missing``: light taken away in some channel, of all that is changed.
    """

    flatness: Real
    ridge: Real
    halo: Real
    neighbour: Real
    saddle: Real
    missing: Real


def log_likeness(looks: Looks, snr: Real, scale: NDArray[np.intp]) -> Real:
    """(N,) natural log of the ratio, for peaks of (N,) signal to noise at (N,) scales."""
    base, features = design(looks, snr, scale)
    with_looks, without = _coefficients()
    return np.asarray(np.concatenate([base, features], axis=1) @ with_looks - base @ without)


def design(looks: Looks, snr: Real, scale: NDArray[np.intp]) -> tuple[Real, Real]:
    """(N, 5) what strength and scale are, and (N, 24) what is seen: of the regressions."""
    strength = np.minimum(np.log(snr), MOST_LOG_SNR)
    one = np.ones_like(strength)
    base = np.stack([one, scale == 1, scale >= 2, strength, strength**2], axis=1)
    seen = np.clip(
        [looks.flatness, looks.ridge, looks.halo, looks.neighbour, looks.saddle, looks.missing],
        0.0,
        1.0,
    ).T
    both = np.concatenate([seen, np.sqrt(seen)], axis=1)
    return base, np.concatenate([both, both * strength[:, None]], axis=1)


@cache
def _coefficients() -> tuple[Real, Real]:
    """Of the regression with looks (29,) and of that without (5,)."""
    with resources.as_file(resources.files(__package__) / FILE) as path:
        table = read_toml(path)
    return np.array(table["with_looks"]), np.array(table["without"])
