"""A solid thing in the water."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.shapes import Shape

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Body:
    """A shape of one colour, in the frame that it is fixed to.

    Parameters
    ----------
    shape
        Metres, dock or world frame.
    reflectance
        (61,) 0..1, matt.
    fixed_to
        ``"dock"``: bobs with it; ``"world"``.
    """

    shape: Shape
    reflectance: Floats
    fixed_to: Literal["dock", "world"]
