"""The water's own light against photons traced one by one, and against a measurement."""

from __future__ import annotations

import warnings

import jerlov
import numpy as np
import pytest

from chromadock.sim.ambient import Ambient
from chromadock.sim.phase import PhaseFunction
from chromadock.sim.scattered_daylight import ScatteredDaylight
from chromadock.sim.spectrum import WAVELENGTHS_NM
from chromadock.sim.water import Water

INDEX = 1.34
SKY = 0.3
"""Share of the illuminance; the sun stands at 40 degrees in all traces."""


def daylight(water: Water) -> ScatteredDaylight:
    return ScatteredDaylight(water, 50000.0, 40.0, 0.0, SKY, flicker=False)


def traced(a: float, b: float, phase: PhaseFunction, depth_m: float, paths: int) -> float:
    """Level radiance by irradiance just beneath the surface, 1/sr, averaged over azimuth.

    Paths go backwards from the eye; at each scattering the sun is asked directly, the sky where a
    path leaves through the surface, by Fresnel's law.  Written without the simulator's formulas.
    """
    rng = np.random.default_rng(1)
    angles = np.concatenate([[0.0], np.geomspace(1e-4, np.pi, 3000)])
    shares = np.asarray(phase.share_within(angles))
    c, sine = a + b, np.cos(np.radians(40)) / INDEX
    sun = np.array([sine, 0, np.sqrt(1 - sine**2)])
    cosines = np.linspace(np.sqrt(1 - 1 / INDEX**2), 1, 2000)
    sky = SKY / (2 * np.pi * np.trapezoid((1 - reflected(cosines)) * cosines, cosines))
    azimuth = rng.uniform(0, 2 * np.pi, paths)
    way = np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros(paths)])
    depth, weight, total = np.full(paths, depth_m), np.ones(paths), 0.0
    while len(weight):
        depth = depth + way[:, 2] * rng.exponential(1 / c, len(weight))
        out = depth < 0
        share = reflected(-way[out, 2])
        total += (weight[out] * (1 - share) * sky).sum()
        weight[out] *= share
        depth[out] *= -1
        way[out, 2] *= -1
        weight *= b / c
        direct = (1 - SKY) / sun[2] * np.exp(-c * depth / sun[2])
        towards = np.arccos(np.clip(-(way @ sun), -1, 1))
        # Nearer to the sun than this the peak is all noise and hardly any light.
        total += (weight * phase.value(np.maximum(towards, 0.03)) * direct).sum()
        angle = np.interp(rng.random(len(weight)), shares / shares[-1], angles)
        way = turned(way, angle, rng.uniform(0, 2 * np.pi, len(weight)))
        faint = weight < 1e-2
        kept = (~faint | (rng.random(len(weight)) < 0.1)) & (depth < 30 / c)
        weight = np.where(faint, 10 * weight, weight)[kept]
        way, depth = way[kept], depth[kept]
    return total / paths


def reflected(cosine: np.ndarray) -> np.ndarray:
    air = np.sqrt(np.maximum(1 - INDEX**2 * (1 - cosine**2), 0))
    s = (INDEX * cosine - air) / (INDEX * cosine + air)
    p = (cosine - INDEX * air) / (cosine + INDEX * air)
    return (s**2 + p**2) / 2


def turned(way: np.ndarray, angle: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
    aside = np.where(np.abs(way[:, 2:]) < 0.9, [[0.0, 0, 1]], [[1.0, 0, 0]])
    u = np.cross(aside, way)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(way, u)
    ring = np.cos(azimuth)[:, None] * u + np.sin(azimuth)[:, None] * v
    return np.cos(angle)[:, None] * way + np.sin(angle)[:, None] * ring


@pytest.mark.parametrize(
    ("name", "water", "depth_m"),
    [
        ("lake", Water.lake(2.0), 1.0),
        ("3C", Water.jerlov_type("3C"), 2.0),
        ("IB", Water.jerlov_type("IB"), 4.0),
    ],
)
def test_level_water_has_the_light_and_colour_of_traced_photons(
    name: str, water: Water, depth_m: float, record_property
) -> None:
    places = [int(np.argmin(np.abs(WAVELENGTHS_NM - nm))) for nm in (470, 525, 620)]
    photons = np.array([traced(water.a[i], water.b[i], water.phase, depth_m, 6000) for i in places])
    beneath = daylight(water).downwelling(0.0, 0.0)[places]
    found, once = (
        of.veiling_radiance(depth_m, 0.0)[places] / beneath
        for of in (daylight(water), Ambient(water, 50000.0, 40.0, 0.0, SKY, flicker=False))
    )
    record_property(
        "figure",
        f"{name}: light over traced photons {np.round(found / photons, 2)}, "
        f"scattered once {np.round(once / photons, 2)} (470, 525, 620 nm)",
    )
    assert (np.abs(np.log2(found / photons)) < 1).all()
    # Colour: better than half the error of single scattering, and good to a quarter.
    colour, of_once = (np.log(v / v.mean() / (photons / photons.mean())) for v in (found, once))
    assert np.abs(colour).max() < 0.3
    assert np.abs(colour).max() < np.abs(of_once).max()


def test_lake_pend_oreille_is_as_bright_as_tyler_measured(record_property) -> None:
    """Tyler (1958) at 4.24 m; a = 0.117, b = 0.279 1/m (c = 0.396) and a coastal phase function."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", jerlov.ProvenanceWarning)
        tyler = jerlov.tyler1958_radiance(4.24)
    tilt, level = np.radians(tyler.tilt_deg), np.mean(tyler.radiance, axis=1)
    down = tilt <= np.pi / 2
    falls = 2 * np.pi * np.trapezoid(
        (level * np.cos(tilt) * np.sin(tilt))[down], tilt[down]
    )  # fmt: skip
    measured = level[list(tyler.tilt_deg).index(90)] / falls
    like = Water("it", np.full(61, 0.117), np.full(61, 0.279), PhaseFunction.of("HAOCE 11"))
    light = ScatteredDaylight(like, 50000.0, tyler.sun_altitude_deg, 0.0, SKY, flicker=False)
    found = (light.veiling_radiance(4.24, 0.0) / light.downwelling(4.24, 0.0))[30]
    record_property("figure", f"level over downwelling: {found:.4f}, Tyler {measured:.4f}")
    assert measured / 2 < found < 2 * measured


def test_a_moonless_night_is_black_and_the_next_day_is_not() -> None:
    night = ScatteredDaylight(Water.pool(), 0.0, -30.0, 0.0, 1.0)
    assert not night.veiling_radiance(1.0, 0.0).any()
    assert daylight(Water.pool()).veiling_radiance(1.0, 0.0).all()
