"""Lamps in water: discs of their true size, which may clip, and halos of scattered light."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from chromadock.variety.scene import Floats, Image

EDGE_PX = 0.45
"""Softness of a disc's edge before the lens's blur."""
HALO_REACH = 9.0
"""Scales of the halo at which it ends: by then it is a ten-thousandth."""
GLOW_RAD = 0.22
"""Scale of the light that many scatterings spread, which shows at night alone."""
GLOW_SHARE = 0.12
"""Part of what the water takes from a lamp's beam that ends there."""
GLOW_CELL = 16
"""Pixels of the coarse grid on which that is drawn, at 640 across."""

_RING = np.sqrt((np.arange(48) + 0.5) / 48)
_ANGLE = np.arange(48) * np.pi * (3 - np.sqrt(5))
_SUNFLOWER = np.column_stack([_RING * np.cos(_ANGLE), _RING * np.sin(_ANGLE)])
"""(48, 2) evenly spread over the unit disc."""


@dataclass(frozen=True, eq=False, slots=True)
class Lamp:
    """A lamp as a camera sees it through no water yet.

    Parameters
    ----------
    pixel
        (2,) centre.
    radius_px
        Of its face, in pixels along x.
    range_m
        From the camera.
    light
        (3,) radiance of its face, linear RGB, full scales.
    profile
        ``disc``: even, with an edge; ``dome``: with an edge, darker towards it; ``bulb``: a bell
        whose standard deviation is half the radius.
    """

    pixel: Floats
    radius_px: float
    range_m: float
    light: Floats
    profile: str = "disc"


def add_lamp(
    light: Image,
    lamp: Lamp,
    attenuation: Floats,
    scattered_share: float,
    halo_px: float,
    aspect: float,
) -> None:
    """Add what comes straight from a lamp and its halo to linear RGB (H, W, 3), in place.

    Parameters
    ----------
    attenuation : (3,) beam attenuation, 1/m.
    scattered_share : of it that is scattered forwards and ends in the halo.
    halo_px : scale of the halo, along x.
    aspect : pixels along y over those along x of a circle.
    """
    straight, scattered = _reaching(lamp, attenuation, scattered_share)
    energy = np.pi * lamp.radius_px**2 * lamp.light
    _add(light, lamp, aspect, _reach(lamp), energy * straight, _face(lamp))
    reach = lamp.radius_px + HALO_REACH * halo_px
    radii = np.linspace(0, reach * 1.01, 96)
    spots = lamp.radius_px * _SUNFLOWER
    apart = np.hypot(radii[:, None] - spots[:, 0], spots[:, 1])
    halo = np.exp(-apart / halo_px).mean(axis=1) / (2 * np.pi * halo_px**2)
    _add(light, lamp, aspect, reach, energy * scattered, (radii, halo))


def add_glow(light: Image, lamps: list[Lamp], attenuation: Floats, focal_px: float) -> None:
    """Add the wide and faint light about lamps in turbid water to (H, W, 3), in place."""
    height, width = light.shape[:2]
    cell = max(GLOW_CELL * width / 640, 1)
    columns, rows = int(np.ceil(width / cell)), int(np.ceil(height / cell))
    x = (np.arange(columns, dtype=np.float32) + 0.5) * width / columns
    y = (np.arange(rows, dtype=np.float32)[:, None] + 0.5) * height / rows
    coarse = np.zeros((rows, columns, 3), np.float32)
    scale = GLOW_RAD * focal_px
    for lamp in lamps:
        lost = GLOW_SHARE * (1 - np.exp(-attenuation * lamp.range_m))
        lost *= np.exp(-0.5 * attenuation * lamp.range_m)
        energy = np.pi * lamp.radius_px**2 * lamp.light * lost / (2 * np.pi * scale**2)
        spread = np.exp(-np.hypot(x - lamp.pixel[0], y - lamp.pixel[1]) / scale)
        coarse += spread[..., None].astype(np.float32) * energy.astype(np.float32)
    light += cv2.resize(coarse, (width, height), interpolation=cv2.INTER_LINEAR)


def _reaching(lamp: Lamp, attenuation: Floats, scattered_share: float) -> tuple[Floats, Floats]:
    """(3,) shares of a lamp's light that come straight and that come scattered forwards."""
    straight = np.exp(-attenuation * lamp.range_m)
    either = np.exp(-(1 - scattered_share) * attenuation * lamp.range_m)
    return straight, either - straight


def _reach(lamp: Lamp) -> float:
    return (2.2 if lamp.profile == "bulb" else 1.0) * lamp.radius_px + 6 * EDGE_PX + 2


def _face(lamp: Lamp) -> tuple[Floats, Floats]:
    """Radii and what of the lamp's light is in a pixel there; its sum over pixels is one."""
    size = max(lamp.radius_px, 0.0)
    radii = np.linspace(0, _reach(lamp), 160)
    if size < 3 * EDGE_PX or lamp.profile == "bulb":
        sigma = np.hypot(EDGE_PX, size / 2)
        return radii, np.exp(-0.5 * (radii / sigma) ** 2) / (2 * np.pi * sigma**2)
    edge = 1 / (1 + np.exp(np.clip((radii - size) / (0.55 * EDGE_PX), -50, 50)))
    profile = edge * (1.15 - np.minimum(radii / size, 1) ** 2) if lamp.profile == "dome" else edge
    whole = 2 * np.pi * float((profile * radii).sum() * radii[1])
    return radii, profile / whole


def _add(
    light: Image,
    lamp: Lamp,
    aspect: float,
    reach: float,
    energy: Floats,
    profile: tuple[Floats, Floats],
) -> None:
    """Add ``energy`` spread by a radial profile, in a window of ``reach`` about the lamp."""
    height, width = light.shape[:2]
    (x, y), tall = lamp.pixel, reach * aspect
    x0, x1 = (int(np.clip(v, 0, width)) for v in (x - reach, x + reach + 1))
    y0, y1 = (int(np.clip(v, 0, height)) for v in (y - tall, y + tall + 1))
    if x0 >= x1 or y0 >= y1:
        return
    right = np.arange(x0, x1, dtype=np.float32) - np.float32(x)
    down = (np.arange(y0, y1, dtype=np.float32)[:, None] - np.float32(y)) / np.float32(aspect)
    spread = _interpolated(np.sqrt(right**2 + down**2), *profile)
    window = light[y0:y1, x0:x1]
    window += spread[..., None] * (energy / aspect).astype(np.float32)


def _interpolated(radii: Image, at: Floats, values: Floats) -> Image:
    """A radial profile at radii of any shape; zero beyond its end."""
    found: NDArray[np.float64] = np.interp(radii.ravel(), at, values, right=0.0)
    return found.astype(np.float32).reshape(radii.shape)
