"""The compiled front end, ``host/native``, and its view of numpy's arrays."""

from __future__ import annotations

from typing import Any

import numpy as np

from chromadock._native import ffi, lib

__all__ = ["ffi", "lib", "pointer"]

_POINTERS = {np.dtype(np.float32): "float[]", np.dtype(np.float64): "double[]"}
_BYTES = "uint8_t[]"


def pointer(array: Any) -> Any:
    """Where the numbers of a contiguous array are: valid for as long as the array itself is."""
    return ffi.from_buffer(_POINTERS.get(array.dtype, _BYTES), array)
