"""How much more like a lamp than like clutter of the same strength a peak looks.

The log of a ratio of two densities, each over what is seen about a peak: how round its top is,
whether a ridge goes on to both sides, how much light there is about it, whether a ridge joins it
to a stronger peak, and how much light it takes away in some channel.  Two logistic regressions
give it (the ratio of posterior odds with what is seen to those by strength and scale alone is the
ratio of densities); ``tools/fit_likeness.py`` fits them to scenes of all kinds.  What is seen and
what the regressions are told of it is computed in ``host/native/peaks.c``.
"""

from __future__ import annotations

from functools import cache
from importlib import resources

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.native import ffi, lib, pointer
from chromadock.toml_file import read_toml

FILE = "likeness.toml"

LOOKS: int = lib.FRONT_LOOKS
"""Numbers that are seen about a peak, in the order of ``front.h``."""

Real = NDArray[np.float64]


def design(looks: Real, snr: Real, scale: NDArray[np.intp]) -> tuple[Real, Real]:
    """Of N peaks (N, 6) what strength and scale are, and (N, 36) what is seen.

    Parameters
    ----------
    looks : (N, LOOKS), as ``Peaks`` has them.
    snr : (N,) signal to noise.
    scale : (N,) of the cells, the finest 0.
    """
    rows = np.empty((len(snr), lib.FRONT_DESIGN))
    own = ffi.new("double[]", LOOKS)
    for row, seen, strength, which in zip(rows, looks, snr.tolist(), scale.tolist(), strict=True):
        own[0:LOOKS] = seen.tolist()
        lib.front_design(own, strength, which, pointer(row))
    return rows[:, : lib.FRONT_BASE], rows[:, lib.FRONT_BASE :]


@cache
def coefficients() -> tuple[Real, Real]:
    """Of the regression with looks (42,) and of that without (6,)."""
    with resources.as_file(resources.files(__package__) / FILE) as path:
        table = read_toml(path)
    with_looks = np.array(table["with_looks"], np.float64)
    without = np.array(table["without"], np.float64)
    if (len(with_looks), len(without)) != (lib.FRONT_DESIGN, lib.FRONT_BASE):
        raise ValueError(f"{FILE}: not {lib.FRONT_DESIGN} and {lib.FRONT_BASE} coefficients")
    return with_looks, without
