"""What a camera's three colour channels make of a spectrum."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.sim.spectrum import STEP_NM, WAVELENGTHS_NM, daylight, gaussian

PRIMARIES_NM = (611.4, 549.1, 464.2)
"""Dominant wavelengths of the primaries of sRGB (IEC 61966-2-1) against D65: red, green, blue."""
PRIMARY_FWHM_NM = 30.0

Band = tuple[float, float, float]
"""Peak (nm), full width at half maximum (nm), height of a bell of sensitivity."""


@dataclass(frozen=True, eq=False)
class Response:
    """Spectral response of a camera's channels.

    Parameters
    ----------
    curves
        (3, 61) float64: R, G, B, relative response to radiant power at ``WAVELENGTHS_NM``,
        all three on the same scale, each positive somewhere.
    """

    curves: NDArray[np.float64]

    def __post_init__(self) -> None:
        curves = np.array(self.curves, dtype=np.float64)
        if curves.shape != (3, len(WAVELENGTHS_NM)):
            raise ValueError(f"curves of shape {curves.shape}, not (3, {len(WAVELENGTHS_NM)})")
        curves.setflags(write=False)
        object.__setattr__(self, "curves", curves)

    @classmethod
    def of_bands(cls, red: Sequence[Band], green: Sequence[Band], blue: Sequence[Band]) -> Response:
        """Each channel as a sum of bells; wavelengths within those of ``WAVELENGTHS_NM``."""
        curves = [
            np.sum([height * gaussian(peak, fwhm) for peak, fwhm, height in bands], axis=0)
            for bands in (red, green, blue)
        ]
        return cls(np.stack(curves))

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """(61, 3) float64: ``signal = spectrum @ weights``; what ``signal`` multiplies by.

        White balanced: a radiance of D65's shape and luminance Y cd/m^2 gives (Y, Y, Y).
        """
        weights = self.curves.T * STEP_NM
        balanced: NDArray[np.float64] = weights / (daylight(1.0) @ weights)
        balanced.setflags(write=False)
        return balanced

    @cached_property
    def daylight_raw(self) -> NDArray[np.float64]:
        """(3,) float64: raw response to D65 relative to the strongest channel's, which is 1.

        This is what a white balance has to undo: raw = signal * daylight_raw.
        """
        raw = self.curves @ daylight(1.0)
        relative: NDArray[np.float64] = raw / raw.max()
        relative.setflags(write=False)
        return relative

    def signal(self, spectrum: ArrayLike) -> NDArray[np.float64]:
        """(..., 61) spectral radiance, W m^-2 sr^-1 nm^-1, to (..., 3) signal R, G, B.

        The signal is in cd/m^2 of daylight.  Of an irradiance or an intensity it is the
        same per steradian or times a square metre: the function is linear.
        """
        signal: NDArray[np.float64] = np.asarray(spectrum, dtype=np.float64) @ self.weights
        return signal

    def colour_correction(self, share: float) -> NDArray[np.float64]:
        """(3, 3) float64: matrix on R, G, B signals that undoes ``share`` (0..1) of crosstalk.

        Crosstalk is what a narrow band at one of ``PRIMARIES_NM`` gives in the two other
        channels, the three bands being scaled so that together they are white.  White stays
        white: rows sum to 1.
        """
        bands = np.stack([gaussian(peak, PRIMARY_FWHM_NM) for peak in PRIMARIES_NM])
        inverse = np.linalg.inv(self.signal(bands).T)
        undone = inverse / inverse.sum(axis=1, keepdims=True)
        matrix: NDArray[np.float64] = (1 - share) * np.eye(3) + share * undone
        return matrix
