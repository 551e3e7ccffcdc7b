"""Daylight whose veiling light has been scattered more than once."""

from __future__ import annotations

from functools import cached_property

import jerlov
import numpy as np

from chromadock.sim.ambient import Ambient
from chromadock.sim.spectrum import WAVELENGTHS_NM, FloatArray

SIDEWAYS = 2.4
"""Light from the side over what scattering backwards alone sends there.

Single forward scattering by 30 to 80 degrees feeds a level line of sight too.  By Monte Carlo
1.5 in clear ocean (IB), 2 in III, 2.2 in 3C, 3 in a lake with 2 m of visibility, at all
wavelengths alike; 3.3 by Tyler's (1958) measurement in Lake Pend Oreille."""


class ScatteredDaylight(Ambient):
    """``Ambient`` with the colour and brightness of water that scatters many times.

    Single scattering (``Ambient.veiling_radiance``) counts all light as lost that is scattered
    on its way to the eye, though most of it goes on nearly as before.  Its water is 5 to 25
    times too dark, and too grey: c hardly depends on the wavelength where scattering rules, and
    a green lake comes out brown.  In quasi-single scattering (Gordon, H. R. 1973, "Simple
    calculation of the diffuse reflectance of the ocean", Appl. Opt. 12, 2803-2804) light
    scattered forwards is not scattered at all: c becomes a + bb.
    """

    def veiling_radiance(self, depth_m: float, time_s: float) -> FloatArray:
        """(61,) radiance of endless water seen level."""
        return self._veil * self.downwelling(depth_m, time_s)

    @cached_property
    def _veil(self) -> FloatArray:
        """(61,) 1/sr: radiance by downwelling irradiance."""
        water = self.water
        once = jerlov.veiling_radiance_estimate(
            water.as_jerlov,
            np.ones_like(WAVELENGTHS_NM),
            WAVELENGTHS_NM,
            backscatter_ratio=water.phase.backscatter_ratio,
        )
        return np.asarray(SIDEWAYS * once * water.c / (water.a + water.bb))
