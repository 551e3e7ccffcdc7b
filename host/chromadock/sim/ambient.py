"""Daylight under water: from sun, sky and clouds down to the depth, with the waves' flicker."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import jerlov
import numpy as np
from numpy.typing import ArrayLike

from chromadock.errors import ChromadockError
from chromadock.sim.spectrum import WAVELENGTHS_NM, FloatArray, daylight
from chromadock.sim.water import Water
from chromadock.sim.waves import GaussianField

REFRACTIVE_INDEX = 1.34
"""Of water against air, in the green."""

_CLOUD_ASYMMETRY = 0.85
"""Mean cosine of the scattering by cloud droplets in the visible."""


@dataclass(frozen=True)
class Cloud:
    """A cloud that passes before the sun.

    Parameters
    ----------
    start_s
        When its edge comes, s.
    fade_s
        How long until it stands fully before the sun, and again until it has gone, s.
    transmittance
        Share of the illuminance that is left under it, above 0, at most 1.
    end_s
        When it begins to go; None: it stays.

    Raises
    ------
    ChromadockError
        For a transmittance or a fade outside its range.
    """

    start_s: float
    fade_s: float
    transmittance: float
    end_s: float | None = None

    def __post_init__(self) -> None:
        if not 0 < self.transmittance <= 1:
            raise ChromadockError(
                f"a cloud's transmittance is {self.transmittance:g}: "
                "it must be above 0 and at most 1"
            )
        if not self.fade_s > 0:
            raise ChromadockError(f"a cloud's fade_s is {self.fade_s:g}: it must be above 0 s")

    def illuminance_share(self, time_s: float) -> float:
        """What is left of the clear sky's illuminance at a moment, transmittance to 1."""
        cover = _smooth_step((time_s - self.start_s) / self.fade_s)
        if self.end_s is not None:
            cover -= _smooth_step((time_s - self.end_s) / self.fade_s)
        return 1 - (1 - self.transmittance) * cover


@dataclass(frozen=True, eq=False)
class Ambient:
    """Daylight in a water.

    Parameters
    ----------
    water
        What the light goes through.
    surface_illuminance_lux
        Downwelling, just beneath the surface under a clear sky, lux; 0 is a moonless night.
    sun_elevation_deg
        Above the horizon, degrees, -90 to 90.
    sun_azimuth_deg
        Where the sun stands, degrees from north by east.
    diffuse_share
        Share of the illuminance that comes from the sky rather than the sun, 0 to 1.
    clouds
        Clouds that pass.
    flicker
        Whether waves focus the sun's light.
    seed
        Of the flicker.
    """

    water: Water
    surface_illuminance_lux: float
    sun_elevation_deg: float
    sun_azimuth_deg: float
    diffuse_share: float
    clouds: tuple[Cloud, ...] = ()
    flicker: bool = True
    seed: int = 0

    @cached_property
    def sun_direction(self) -> FloatArray:
        """(3,) world unit vector along which refracted sunlight travels.

        Snell's law on the flat surface; a sun below the horizon counts as on it.
        """
        elevation, azimuth = np.radians([max(self.sun_elevation_deg, 0.0), self.sun_azimuth_deg])
        sine = np.cos(elevation) / REFRACTIVE_INDEX
        return np.array([-sine * np.cos(azimuth), -sine * np.sin(azimuth), math.sqrt(1 - sine**2)])

    @cached_property
    def mu0(self) -> float:
        """Mean cosine of the zenith angle of the light just beneath the surface, clear sky.

        The sun's share goes along `sun_direction`. An evenly bright sky's share, refracted,
        has the mean 2/3 n^2 (1 - (1 - 1/n^2)^(3/2)) = 0.844 (Kirk 1984 takes 0.86 for an
        overcast sky).
        """
        n2 = REFRACTIVE_INDEX**2
        sky = 2 / 3 * n2 * (1 - (1 - 1 / n2) ** 1.5)
        diffuse = self._clear_diffuse_share
        return float(diffuse * sky + (1 - diffuse) * self.sun_direction[2])

    @cached_property
    def kd(self) -> FloatArray:
        """(61,) diffuse attenuation of the downwelling light, 1/m: `Water.kd` at `mu0`."""
        return self.water.kd(self.mu0)

    def diffuse_share_at(self, time_s: float) -> float:
        """Share of the illuminance that comes from no single direction, with the clouds, 0 to 1.

        A cloud whose illuminance share is T has the optical depth 2 (1/T - 1) / (1 - g)
        (Bohren, C. F. 1987, "Multiple scattering of light and some of its observable
        consequences", Am. J. Phys. 55, 524-533), which leaves exp(-depth) of the sun's beam.
        """
        left = self._illuminance_share(time_s)
        depth = 2 * (1 / left - 1) / (1 - _CLOUD_ASYMMETRY)
        direct = (1 - self._clear_diffuse_share) * math.exp(-depth)
        return 1 - direct / left if direct < left else 0.0

    def downwelling(self, depth_m: float, time_s: float) -> FloatArray:
        """(61,) downwelling irradiance, W m^-2 nm^-1, with clouds, averaged over flicker."""
        surface = daylight(self.surface_illuminance_lux * self._illuminance_share(time_s))
        return np.asarray(surface * np.exp(-self.kd * depth_m))

    def flicker_sigma(self, depth_m: float, time_s: float) -> FloatArray:
        """(61,) sigma of the log-normal irradiance factor exp(sigma g - sigma^2/2).

        Its coefficient of variation, sqrt(exp(sigma^2) - 1), is that which Darecki et al.
        (2011) measured, interpolated in depth and wavelength and kept beyond the ends. Only
        the sun's beam flickers: it grows and falls with the beam's share, which under their
        clear sky was `clear_beam_share`.
        """
        if not self.flicker:
            return np.zeros_like(WAVELENGTHS_NM)
        beam = (1 - self.diffuse_share_at(time_s)) / clear_beam_share()
        variation = beam * _measured_variation(depth_m)
        return np.asarray(np.sqrt(np.log1p(variation**2)))

    def fluctuation(self, time_s: ArrayLike, x_m: ArrayLike, y_m: ArrayLike) -> FloatArray:
        """The unit-variance Gaussian g of the flicker; world metres, broadcasting."""
        return self._waves.value(time_s, x_m, y_m)

    def veiling_radiance(self, depth_m: float, time_s: float) -> FloatArray:
        """(61,) radiance of endless water seen level: bb Ed / (2 pi c), by `jerlov`."""
        return np.asarray(
            jerlov.veiling_radiance_estimate(
                self.water.as_jerlov,
                self.downwelling(depth_m, time_s),
                WAVELENGTHS_NM,
                backscatter_ratio=self.water.phase.backscatter_ratio,
            )
        )

    @property
    def _clear_diffuse_share(self) -> float:
        return self.diffuse_share if self.sun_elevation_deg > 0 else 1.0

    @cached_property
    def _waves(self) -> GaussianField:
        return GaussianField(self.seed)

    def _illuminance_share(self, time_s: float) -> float:
        return math.prod(cloud.illuminance_share(time_s) for cloud in self.clouds)


@lru_cache(maxsize=1)
def clear_beam_share() -> float:
    """The sun's share of the illuminance in Darecki et al.'s (2011) measurements of flicker.

    Of a clear sky with their sun, after Gernez & Antoine (2009).
    """
    sky = jerlov.gernez2009_diffuse_share()
    zenith = np.mean(jerlov.darecki2011_irradiance_cv().sun_zenith_deg)
    return 1 - float(np.interp(zenith, sky.sun_zenith_deg, sky.diffuse_fraction))


def _measured_variation(depth_m: float) -> FloatArray:
    """(61,) coefficient of variation of irradiance: linear in wavelength and log depth."""
    measured = jerlov.darecki2011_irradiance_cv()
    log_depth = np.log(measured.depth_m)
    place = np.log(max(depth_m, measured.depth_m[0]))
    at_depth = [np.interp(place, log_depth, column) for column in measured.cv.T]
    return np.asarray(np.interp(WAVELENGTHS_NM, measured.wavelengths_nm, at_depth))


def _smooth_step(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3 - 2 * x)
