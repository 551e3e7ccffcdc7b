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
    present_s
        From when until when it is there; None: always.
    """

    shape: Shape
    reflectance: Floats
    fixed_to: Literal["dock", "world"]
    present_s: tuple[float, float] | None = None

    def there(self, time_s: float) -> bool:
        """Whether it is there at a moment."""
        return self.present_s is None or self.present_s[0] <= time_s < self.present_s[1]
