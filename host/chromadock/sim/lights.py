"""The dock's lamps as a camera sees them through the water, directly and in the surface."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from chromadock.camera import CameraModel
from chromadock.sim.glints import GLINTS, glints
from chromadock.sim.halo import HaloTable
from chromadock.sim.lamp_core import add_cores, place_points
from chromadock.sim.lamp_image import Halo, HaloImage
from chromadock.sim.response import Response
from chromadock.sim.spectrum import led_intensity
from chromadock.sim.water import Water
from chromadock.sim.waves import GaussianField

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

_TINY = 1e-300


@dataclass(frozen=True)
class Emitter:
    """One of a lamp's three LEDs: the peak and width of its band, and candela on its axis."""

    peak_nm: float
    fwhm_nm: float
    intensity_cd: float


@dataclass(frozen=True)
class LampSpec:
    """A lamp with three LEDs in one dome.

    Parameters
    ----------
    red, green, blue
        The LEDs at full power; their peaks within ``WAVELENGTHS_NM``.
    diameter_m
        Of the dome, which shines evenly.
    half_angle_deg
        From the axis to where half the intensity is left, above 0, below 90; 60 is Lambert's.
    """

    red: Emitter
    green: Emitter
    blue: Emitter
    diameter_m: float
    half_angle_deg: float

    @property
    def cosine_power(self) -> float:
        """The m of an intensity that falls off as cos^m of the angle from the axis."""
        return math.log(0.5) / math.log(math.cos(math.radians(self.half_angle_deg)))


class Lamps:
    """Draws equal lamps into one camera's images.

    Light that is not scattered follows Beer-Lambert's law and the inverse square; what is
    scattered and still arrives adds ``HaloTable.share`` of it, wavelength by wavelength.

    Parameters
    ----------
    spec
        The lamps.
    camera
        Whose images.
    response
        What its channels see.
    water, halo_table
        What lies between; the table is that of ``water.phase``.
    """

    def __init__(
        self,
        spec: LampSpec,
        camera: CameraModel,
        response: Response,
        water: Water,
        halo_table: HaloTable,
    ) -> None:
        self._spec = spec
        self._response = response
        self._water = water
        self._camera = camera
        self._table = halo_table
        self._halos = HaloImage(camera, halo_table)
        leds = (spec.red, spec.green, spec.blue)
        self._intensity = np.stack(
            [led_intensity(led.peak_nm, led.fwhm_nm, led.intensity_cd) for led in leds]
        )

    def signal(self, range_m: ArrayLike, led_share: ArrayLike) -> Floats:
        """Unscattered irradiance at a camera on the lamp's axis.

        Parameters
        ----------
        range_m : (...) metres, above 0.
        led_share : (3,) share of full power of the red, green and blue LED, 0..1.

        Returns
        -------
        (..., 3) signal sr.
        """
        return self._response.signal(self._arriving(np.asarray(range_m, np.float64), led_share))

    def draw(
        self,
        light: Image,
        points_camera: ArrayLike,
        axes_camera: ArrayLike,
        led_share: ArrayLike,
        visible: ArrayLike,
    ) -> None:
        """Add the lamps to an image, in place.

        Parameters
        ----------
        light : (H, W, 3) float32 signal.
        points_camera : (N, 3) the lamps' places, metres, camera frame.
        axes_camera : (N, 3) unit vectors along which they shine, camera frame.
        led_share : (3,) share of full power of the red, green and blue LED, 0..1.
        visible : (N,) share of each lamp that nothing hides, 0..1.
        """
        points = np.asarray(points_camera, np.float64).reshape(-1, 3)
        share = np.asarray(visible, np.float64) * self._emitted(points, axes_camera)
        self._draw(light, points, points[:, None], share[:, None], led_share)

    def draw_mirrored(
        self,
        light: Image,
        points_camera: ArrayLike,
        axes_camera: ArrayLike,
        led_share: ArrayLike,
        visible: ArrayLike,
        *,
        waves: GaussianField,
        time_s: float,
        R_world_camera: Floats,
        depth_m: float,
    ) -> None:
        """Add the lamps' images in the water's surface, in place.

        In a flat surface a lamp at depth h is seen as if it stood at height h, by the share
        that the surface reflects.  Facets of waves about that place of the surface show it
        each at another place: the image breaks into glints.

        Parameters
        ----------
        light, points_camera, axes_camera, led_share : as ``draw`` takes them.
        visible : (N,) share of each reflected lamp that nothing hides, 0..1.
        waves : of the surface; world metres, with the camera at x = y = 0.
        time_s : seconds.
        R_world_camera : (3, 3) rotation from the camera's to the world frame.
        depth_m : of the camera below the mean surface, above 0.
        """
        to_world = np.asarray(R_world_camera, np.float64).T
        lamps = np.asarray(points_camera, np.float64).reshape(-1, 3) @ to_world
        axes = np.asarray(axes_camera, np.float64).reshape(-1, 3) @ to_world
        submerged = lamps[:, 2] > -depth_m
        lamps, axes = lamps[submerged], axes[submerged]
        flip = np.array([1.0, 1.0, -1.0])
        flat = (lamps + np.array([0, 0, 2 * depth_m])) * flip
        share = np.asarray(visible, np.float64)[submerged] * self._emitted(flat, axes * flip)
        shown, reflectance = glints(lamps, flat, depth_m, waves, time_s)
        weights = share[:, None] * reflectance / GLINTS
        self._draw(light, flat @ to_world.T, shown @ to_world.T, weights, led_share)

    def _draw(
        self, light: Image, points: Floats, shown: Floats, weights: Floats, led_share: ArrayLike
    ) -> None:
        """Add lamps at ``points`` (N, 3) whose cores are shown at (N, K, 3) by shares (N, K)."""
        lit = weights.sum(axis=1) > 0
        if not lit.any() or not np.any(led_share):
            return
        points, shown, weights = points[lit], shown[lit], weights[lit]
        total = weights.sum(axis=1)
        ranges = np.linalg.norm(points, axis=1)
        spectra = total[:, None] * self._arriving(ranges, led_share)
        tau = self._water.b * ranges[:, None]
        scattered = spectra * self._table.share(tau)
        halo = self._response.signal(scattered)
        # One shape for all wavelengths: that of the mean scattering of what arrives.
        mean_tau = (tau * scattered).sum(axis=1) / np.maximum(scattered.sum(axis=1), _TINY)
        radius_rad = self._spec.diameter_m / 2 / ranges
        halos = [
            Halo(point / distance, radius, float(one_tau), energy)
            for point, distance, radius, one_tau, energy in zip(
                points, ranges, radius_rad, mean_tau, halo, strict=True
            )
        ]
        left = self._halos.add(light, halos)
        cores = self._response.signal(spectra) + left[:, None] * halo
        pixels, solid_angles = place_points(self._camera, shown.reshape(-1, 3))
        pixels, solid_angles = (
            pixels.reshape(*weights.shape, 2),
            solid_angles.reshape(weights.shape),
        )
        values = (weights / total[:, None] / solid_angles)[..., None] * cores[:, None]
        for index, ahead in enumerate(np.isfinite(solid_angles)):
            if ahead.any():
                radius_px = radius_rad[index] / math.sqrt(solid_angles[index, ahead][0])
                add_cores(light, pixels[index, ahead], values[index, ahead], radius_px)

    def _arriving(self, range_m: Floats, led_share: ArrayLike) -> Floats:
        """(...) metres to (..., 61) unscattered irradiance, W m^-2 nm^-1, on the axis."""
        distance = range_m[..., None]
        emitted = np.asarray(led_share, np.float64) @ self._intensity
        return np.asarray(emitted * np.exp(-self._water.c * distance) / distance**2)

    def _emitted(self, points: Floats, axes: ArrayLike) -> Floats:
        """(N,) share of the axis' intensity that lamps at (N, 3) send to the origin."""
        towards = -points / np.linalg.norm(points, axis=1, keepdims=True)
        cosine = np.einsum("ij,ij->i", towards, np.asarray(axes, np.float64).reshape(-1, 3))
        return np.asarray(np.maximum(cosine, 0) ** self._spec.cosine_power)
