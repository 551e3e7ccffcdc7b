"""Daylight on a painted surface, and what a camera sees of it through the water."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.sim.ambient import Ambient
from chromadock.sim.response import Response
from chromadock.sim.spectrum import daylight

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Seen:
    """A matt surface at a place, as one camera's channels see it from a distance.

    Parameters
    ----------
    range_m
        The distance at which everything else here holds.
    beam, sky, below
        (3,) signal by the sun on a face that looks into it, by the sky on one that looks
        straight up, by the light from below on one that looks straight down.
    fade
        (3,) 1/m at which these fall with the distance.
    through, thinning
        (3,) share of an endless water's light that comes from behind the surface, and 1/m at
        which it falls with the distance.
    flicker_sigma
        (3,) of the log-normal factor by waves.
    sun_direction
        (3,) along which the sunlight travels, camera frame.
    down
        (3,) downwards, camera frame.
    """

    range_m: float
    beam: Floats
    sky: Floats
    below: Floats
    fade: Floats
    through: Floats
    thinning: Floats
    flicker_sigma: Floats
    sun_direction: Floats
    down: Floats

    def faces(self, normal: Singles, range_m: Singles) -> Singles:
        """(3, N) signal of faces, without the water's own light in front of them.

        Parameters
        ----------
        normal : (3, N) outward unit normals, camera frame.
        range_m : (N,) metres.
        """
        # Up times the sky and down times what comes from below, in one product.
        diffuse = np.outer(self.below - self.sky, self.down) / 2
        signal = diffuse.astype(np.float32) @ normal
        signal += _column((self.sky + self.below) / 2)
        to_sun = np.maximum(-(self.sun_direction.astype(np.float32) @ normal), 0)
        signal += to_sun * _column(self.beam)
        signal *= self._nearer(range_m, self.fade)
        return np.asarray(signal)

    def flicker(self, fluctuation: Floats) -> Floats:
        """(3, K) factors by which waves change the light on faces, of (K,) the Gaussian g."""
        sigma = self.flicker_sigma[:, None]
        return np.asarray(np.exp(fluctuation * sigma - sigma**2 / 2))

    def share_before(self, range_m: Singles) -> Singles:
        """(3, N) share of an endless water's light that comes from within (N,) distances."""
        behind = _column(self.through) * self._nearer(range_m, self.thinning)
        return np.asarray(np.maximum(1 - behind, 0))

    def _nearer(self, range_m: Singles, rate: Floats) -> Singles:
        """(3, N) how much more there is at other ranges than at the one all is stated for."""
        exponent = (np.float32(self.range_m) - range_m) * _column(rate)
        return np.asarray(np.exp(exponent, out=exponent))


def _column(values: Floats) -> Singles:
    """(3,) to (3, 1)."""
    return np.asarray(values[:, None], np.float32)


class Daylit:
    """How surfaces look to one camera.

    Diffuse light comes half from each side of a vertical face; that from below is what the
    water sends up again, R = 0.33 bb / a of what comes down (Morel, A. and Prieur, L. 1977,
    "Analysis of variations in ocean color", Limnol. Oceanogr. 22, 709-722, equation 2).
    """

    def __init__(self, ambient: Ambient, response: Response) -> None:
        water = ambient.water
        self._ambient = ambient
        self._response = response
        self._upwards = 0.33 * water.bb / water.a
        # Of whatever light there is by day or night, only these shapes matter.
        self._white = daylight(1.0)
        self._veil = self._white * water.bb / (water.a + water.bb)

    def seen(
        self,
        reflectance: Floats,
        depth_m: Floats,
        range_m: Floats,
        time_s: float,
        R_camera_world: Floats,
    ) -> list[Seen]:
        """Surfaces of ``reflectance`` (N, 61) at depths (N,), seen level from ``range_m`` (N,)."""
        ambient, signal = self._ambient, self._response.signal
        c = ambient.water.c
        lost = np.exp(-c * range_m[:, None])
        dimmed = np.exp(-ambient.kd * depth_m[:, None])
        scattered = ambient.diffuse_share_at(time_s)
        sun = ambient.sun_direction
        arriving = reflectance / np.pi * ambient.downwelling(0.0, time_s) * dimmed * lost
        diffuse = signal(arriving)
        below = signal(self._upwards * arriving)
        shape = reflectance * self._white * dimmed * lost
        total = np.maximum(signal(shape), 1e-30)
        veil = self._veil * dimmed
        behind = signal(veil * lost)
        fade, thinning = signal(shape * c) / total, signal(veil * lost * c) / behind
        through = behind / signal(veil)
        # Waves focus the light nearly alike at all depths of a thing's parts.
        sigma = ambient.flicker_sigma(float(depth_m.mean()), time_s)
        flicker_sigma = signal(shape * sigma) / total
        return [
            Seen(
                range_m=float(range_m[i]),
                beam=(1 - scattered) / sun[2] * diffuse[i],
                sky=scattered * diffuse[i],
                below=below[i],
                fade=fade[i],
                through=through[i],
                thinning=thinning[i],
                flicker_sigma=flicker_sigma[i],
                sun_direction=R_camera_world @ sun,
                down=R_camera_world[:, 2],
            )
            for i in range(len(range_m))
        ]
