"""A lamp's halo in an image: light that the water scattered by small angles.

Energy is kept: the sum over the pixels of (what is added) x (the pixel's solid angle), and
what is left for the core, is the halo's irradiance, however finely a part of it is drawn.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from chromadock.camera import CameraModel
from chromadock.sim.halo import HaloTable
from chromadock.sim.lamp_core import place_points
from chromadock.sim.rays import RayGrid

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

CORE_PX = 1.5
"""Halo within about this radius cannot be told from the lamp, and is drawn with it."""
NEAR_PX = 12.0
"""Within about this radius the halo is drawn pixel by pixel, beyond it on a coarse grid."""
COARSE_STEP_PX = (4, 4)

_REACH = 3.5
"""Standard deviations after which a Gaussian weight is left out."""
_NODES = 2048


@dataclass(frozen=True, eq=False)
class Halo:
    """One lamp's halo as it reaches the camera.

    Parameters
    ----------
    direction
        (3,) unit vector to the lamp, camera frame.
    radius_rad
        Angular radius of the lamp itself.
    tau
        b times range, which picks the halo's shape.
    energy
        (3,) irradiance, signal sr.
    """

    direction: Floats
    radius_rad: float
    tau: float
    energy: Floats


class HaloImage:
    """Draws halos into images of one camera.

    Parameters
    ----------
    camera
        Whose images.
    table
        Radial density of halos.
    """

    def __init__(self, camera: CameraModel, table: HaloTable) -> None:
        self._camera = camera
        self._table = table
        self._fine = RayGrid(camera, (1, 1))
        self._coarse = RayGrid(camera, COARSE_STEP_PX)
        self._pixel_rad = 1 / math.sqrt(camera.matrix[0, 0] * camera.matrix[1, 1])
        first, last = 2 * np.sin(table.angles_rad[[0, -1]] / 2)
        chords = np.geomspace(first, last, _NODES)
        self._angles = 2 * np.arcsin(chords / 2)
        self._log_first = 2 * math.log(chords[0])
        self._per_log = 0.5 / math.log(chords[1] / chords[0])

    def add(self, light: Image, halos: Sequence[Halo]) -> Floats:
        """Add what of halos can be told from the lamps themselves, in place.

        Parameters
        ----------
        light : (H, W, 3) float32 signal.
        halos : N of them, at least 1.

        Returns
        -------
        (N,) share of each halo's energy that is left, to be drawn with the lamp.
        """
        directions = np.stack([halo.direction for halo in halos])
        pixels, solid_angles = place_points(self._camera, directions)
        rays = self._coarse.rays.reshape(3, -1)
        chord2 = 2 - 2 * (directions.astype(np.float32) @ rays)
        far = np.empty_like(chord2)
        left = np.empty(len(halos))
        for index, halo in enumerate(halos):
            core = max(CORE_PX * self._pixel_rad, halo.radius_rad)
            near = max(NEAR_PX * self._pixel_rad, 2 * core)
            density = self._density(halo.tau)
            outside_core, outside_near = (
                -np.expm1(-0.5 * (self._angles / radius) ** 2) for radius in (core, near)
            )
            left[index] = 1 - self._energy(density * outside_core)
            far[index] = self._looked_up(density * outside_near, chord2[index])
            if np.isfinite(solid_angles[index]):
                reach = _REACH * near / math.sqrt(solid_angles[index])
                inner = density * (outside_core - outside_near)
                self._add_near(light, halo, inner, pixels[index], reach)
        energies = np.stack([halo.energy for halo in halos]).astype(np.float32)
        image = (far.T @ energies).reshape(*self._coarse.shape, 3)
        np.add(light, self._coarse.enlarge(image), out=light)
        return left

    def _add_near(
        self, light: Image, halo: Halo, density: Floats, pixel: Floats, reach: float
    ) -> None:
        """Add the narrow part pixel by pixel, within ``reach`` pixels of ``pixel``."""
        left, top = (max(0, math.floor(v - reach)) for v in pixel)
        right, bottom = (max(0, math.ceil(v + reach) + 1) for v in pixel)
        rays = self._fine.rays[:, top:bottom, left:right]
        # Not 2 - 2 cos, which single precision cannot resolve over a pixel.
        offset = rays - halo.direction.astype(np.float32)[:, None, None]
        value = self._looked_up(density, np.einsum("i...,i...", offset, offset))
        light[top:bottom, left:right] += value[..., None] * halo.energy.astype(np.float32)

    def _density(self, tau: float) -> Floats:
        """(nodes,) sr^-1, 1 when integrated over the sphere, at angles even in log chord."""
        known = np.log(self._table.angles_rad)
        density = np.exp(np.interp(np.log(self._angles), known, np.log(self._table.density(tau))))
        # The plane's rings 2 pi t dt become the sphere's 2 pi sin(t) dt.
        density *= self._angles / np.sin(self._angles)
        within_first = math.pi * self._angles[0] ** 2 * density[0]
        return np.asarray(density / (self._energy(density) + within_first))

    def _energy(self, density: Floats) -> float:
        """Integral over the sphere, but for the first node's inside, of a radial density."""
        return float(np.trapezoid(density * 2 * np.pi * np.sin(self._angles), self._angles))

    def _looked_up(self, density: Floats, chord2: Image) -> Image:
        """The density where (2 sin(angle / 2))^2 is ``chord2``; 0 beyond the last angle."""
        table = np.append(density, 0.0).astype(np.float32)
        index = np.log(np.maximum(chord2, np.float32(1e-12)))
        index -= np.float32(self._log_first)
        index *= np.float32(self._per_log)
        np.clip(np.rint(index, out=index), 0, _NODES, out=index)
        return np.asarray(table[index.astype(np.intp)])
