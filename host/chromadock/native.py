"""Arrays of numbers as the host's C takes them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from chromadock._native import ffi


def doubles(values: NDArray[np.complex128] | NDArray[np.float64]) -> Any:
    """The numbers of an array as a C array, which keeps their memory alive: the array's own, if it
    is contiguous."""
    return ffi.from_buffer("double[]", np.ascontiguousarray(values))
