"""Light from LEDs through water onto a photograph: a few lines that owe the simulator nothing.

Direct light falls with ``exp(-c r)``; what is scattered forwards lands in a halo.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

GAMMA = 2.2
LED_RADIUS_M = 0.012
"""An LED under a diffusing dome."""
LENS_SIGMA_PX = 0.7
HALO_ANGLE_RAD = 0.012
"""Scale of the halo: forward scatter falls exponentially with the angle (Voss 1991)."""
SCATTERED_SHARE = 0.5
"""Part of the attenuation that is scatter, and so ends in the halo."""


def to_linear(rgb: ArrayLike) -> NDArray[np.float32]:
    """8-bit gamma-encoded colour to linear light 0..1."""
    rgb = np.asarray(rgb)
    return _LINEAR[rgb] if rgb.dtype == np.uint8 else _to_linear(rgb)


def _to_linear(rgb: ArrayLike) -> NDArray[np.float32]:
    return np.asarray((np.asarray(rgb, np.float32) / 255) ** GAMMA, np.float32)


_LINEAR = _to_linear(np.arange(256))
"""Of each value of 8 bits: a picture has a million, and their power takes its time."""


def to_encoded(light: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Linear light to 8 bits, clipped at full scale."""
    encoded = np.clip(light, 0, 1)
    encoded **= 1 / GAMMA
    encoded *= 255
    return np.rint(encoded, out=encoded).astype(np.uint8)


def add_led(
    light: NDArray[np.float32],
    centre: tuple[float, float],
    colour: NDArray[np.float32],
    range_m: float,
    focal_px: float,
    attenuation: float,
) -> None:
    """Add one LED's direct light and halo to an image, in place.

    Parameters
    ----------
    light : (H, W, 3) float32 linear image.
    centre : x, y in pixels.
    colour : (3,) linear radiance of the LED's face, same channel order; 1 is full scale.
    range_m : distance, metres.
    focal_px : focal length, pixels.
    attenuation : beam attenuation c, 1/m.
    """
    face_px = focal_px * LED_RADIUS_M / range_m
    energy = np.pi * face_px**2
    sigma = np.hypot(LENS_SIGMA_PX, face_px / 2)
    halo = focal_px * HALO_ANGLE_RAD
    direct = np.exp(-attenuation * range_m)
    scattered = np.exp(-(1 - SCATTERED_SHARE) * attenuation * range_m) - direct

    height, width = light.shape[:2]
    reach = int(6 * halo) + 1
    x0, x1 = np.clip((int(centre[0]) - reach, int(centre[0]) + reach + 1), 0, width)
    y0, y1 = np.clip((int(centre[1]) - reach, int(centre[1]) + reach + 1), 0, height)
    y, x = np.mgrid[y0:y1, x0:x1].astype(np.float32)
    distance = np.hypot(x - centre[0], y - centre[1])
    core = np.exp(-0.5 * (distance / sigma) ** 2) / (2 * np.pi * sigma**2)
    glow = np.exp(-distance / halo) / (2 * np.pi * halo**2)
    spread = energy * (direct * core + scattered * glow)
    light[y0:y1, x0:x1] += spread[..., None].astype(np.float32) * colour
