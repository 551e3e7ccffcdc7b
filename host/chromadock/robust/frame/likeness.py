"""How much more like a lamp than like clutter of the same strength a peak looks.

The log of a ratio of two densities, each over what is seen about a peak: how round its top is, how
the cells about it fall off to all sides, what other scales show there, whether a ridge joins it to
a stronger peak, whether all channels rise together, and how much light it takes away in some
channel.  A network of one hidden layer gives the odds of a lamp with what is seen, a logistic
regression those by strength and scale alone, and the ratio of these is the ratio of densities;
``tools/fit_likeness.py`` fits both to scenes of all kinds.  What is seen, and the network, are in
``host/native/looks.c``.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock.robust.frame.native import ffi, lib, pointer
from chromadock.toml_file import read_toml

FILE = "likeness.toml"

LOOKS: int = lib.FRONT_LOOKS
"""Numbers that are seen about a peak, in the order of ``front.h``."""

Real = NDArray[np.float64]


def inputs(looks: Real, snr: Real, scale: NDArray[np.intp]) -> NDArray[np.float32]:
    """(N, FRONT_INPUTS) what the network is told of N peaks.

    Parameters
    ----------
    looks : (N, LOOKS), as ``Peaks`` has them.
    snr : (N,) signal to noise.
    scale : (N,) of the cells, the finest 0.
    """
    rows = np.empty((len(snr), lib.FRONT_INPUTS), np.float32)
    own = ffi.new("double[]", LOOKS)
    for row, seen, strength, which in zip(rows, looks, snr.tolist(), scale.tolist(), strict=True):
        own[0:LOOKS] = seen.tolist()
        lib.front_inputs(own, strength, which, pointer(row))
    return rows


@cache
def network() -> Any:
    """The fitted network, a ``front_network_t *``."""
    with resources.as_file(resources.files(__package__) / FILE) as path:
        return ffi.new("front_network_t *", read_toml(path))
