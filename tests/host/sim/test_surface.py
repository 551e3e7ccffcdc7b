"""The surface from below: Fresnel, Snell, waves, and the light that comes through."""

import math

import numpy as np
import pytest

from chromadock.sim.ambient import REFRACTIVE_INDEX, Ambient
from chromadock.sim.basin import Basin, Floor
from chromadock.sim.camera_spec import load_camera
from chromadock.sim.surface import (
    reflectance_from_below,
    sky_transmittance,
    split,
    upward_normals,
)
from chromadock.sim.surface_view import SurfaceView
from chromadock.sim.veil import Veil
from chromadock.sim.water import Water
from chromadock.sim.waves import GaussianField

CRITICAL_DEG = math.degrees(math.asin(1 / REFRACTIVE_INDEX))
RESPONSE = load_camera("vehicle").sensor.response


class Calm:
    """A surface without a wave."""

    def slope(self, time_s, x_m, y_m):
        return np.zeros((*np.broadcast(x_m, y_m).shape, 2))


def fresnel(degrees):
    """By the sines and tangents of the angles (Fresnel's own form), not by cosines."""
    i = np.radians(degrees)
    t = np.arcsin(np.minimum(REFRACTIVE_INDEX * np.sin(i), 1))
    s = np.sin(i - t) ** 2 / np.sin(i + t) ** 2
    p = np.tan(i - t) ** 2 / np.tan(i + t) ** 2
    return (s + p) / 2


def test_reflectance_is_fresnels_and_total_beyond_the_critical_angle(record_property):
    record_property("figure", f"critical angle {CRITICAL_DEG:.2f} deg")
    assert pytest.approx(48.3, abs=0.1) == CRITICAL_DEG
    below = np.linspace(0.5, CRITICAL_DEG - 0.05, 60)
    assert reflectance_from_below(np.cos(np.radians(below))) == pytest.approx(
        fresnel(below), rel=1e-6
    )
    beyond = np.linspace(CRITICAL_DEG + 0.01, 90, 30)
    assert reflectance_from_below(np.cos(np.radians(beyond))) == pytest.approx(1, abs=1e-9)
    n = REFRACTIVE_INDEX
    assert reflectance_from_below(np.array([1.0])) == pytest.approx(((n - 1) / (n + 1)) ** 2)


def test_an_even_sky_loses_what_the_textbooks_say_on_its_way_in(record_property):
    # From the air's side: Lambert's cosine over the hemisphere times what is not reflected.
    zenith = (np.arange(20000) + 0.5) / 20000 * 90
    below = np.degrees(np.arcsin(np.sin(np.radians(zenith)) / REFRACTIVE_INDEX))
    weight = np.sin(2 * np.radians(zenith))
    wanted = np.average(1 - fresnel(below), weights=weight)
    record_property("figure", f"diffuse transmittance {sky_transmittance():.4f}")
    assert sky_transmittance() == pytest.approx(wanted, abs=1e-4)
    # 6.6 % of an overcast sky is reflected (Kirk, "Light and Photosynthesis").
    assert 1 - sky_transmittance() == pytest.approx(0.066, abs=0.003)


def random_rays(count, seed=1):
    rng = np.random.default_rng(seed)
    up = rng.uniform(0.05, 1, count)
    azimuth = rng.uniform(0, 2 * np.pi, count)
    across = np.sqrt(1 - up**2)
    rays = np.stack([across * np.cos(azimuth), across * np.sin(azimuth), -up])
    return rays.astype(np.float32)


def test_rays_are_split_by_the_laws_of_reflection_and_refraction():
    rays = random_rays(500)
    slope = np.random.default_rng(2).normal(0, 0.1, (500, 2)).astype(np.float32)
    normals = upward_normals(slope)
    assert np.linalg.norm(normals, axis=0) == pytest.approx(1, abs=1e-5)
    parts = split(rays, normals)
    cosine = (rays * normals).sum(axis=0)
    front = cosine > 0.01
    into = (parts.reflected * normals).sum(axis=0)
    down = parts.reflected[2] > 1e-6  # rays that meet the surface again are bent level
    assert into[front & down] == pytest.approx(-cosine[front & down], abs=1e-5)
    sine = np.linalg.norm(np.cross(rays.T, normals.T), axis=1)
    refracts = front & (REFRACTIVE_INDEX * sine < 0.999)
    assert 50 < refracts.sum() < 450
    sine_air = np.linalg.norm(np.cross(parts.refracted.T, normals.T), axis=1)
    assert sine_air[refracts] == pytest.approx(REFRACTIVE_INDEX * sine[refracts], abs=1e-4)
    assert np.linalg.norm(parts.refracted, axis=0)[refracts] == pytest.approx(1, abs=1e-4)
    plane = np.einsum("ij,ij->j", np.cross(rays.T, normals.T).T, parts.refracted)
    assert plane[refracts] == pytest.approx(0, abs=1e-5)


def test_normals_stand_on_the_waves():
    # Where the surface rises to the north, what stands on it leans to the south; z is down.
    x, y, z = upward_normals(np.array([[0.1, 0.0]]))[:, 0]
    assert x < 0
    assert y == 0
    assert z < 0
    assert x / z == pytest.approx(0.1)


def view(ambient, waves, basin=None):
    return SurfaceView(RESPONSE, ambient, Veil(RESPONSE, ambient), waves, basin or Basin())


def daylight(diffuse_share, sun_elevation=50.0, water=None):
    return Ambient(
        water=water or CLEAR,
        surface_illuminance_lux=50000.0,
        sun_elevation_deg=sun_elevation,
        sun_azimuth_deg=120.0,
        diffuse_share=diffuse_share,
        flicker=False,
    )


POOL = Water.pool()
CLEAR = Water("nearly nothing", np.full(61, 1e-4), np.full(61, 1e-9), POOL.phase)
"""Does not scatter, so that all that is seen is what the surface lets in."""


@pytest.mark.parametrize("sun_elevation", [80.0, 50.0, 25.0])
@pytest.mark.parametrize("diffuse_share", [1.0, 0.3, 0.0])
def test_all_that_comes_through_the_window_is_the_irradiance_beneath(
    diffuse_share, sun_elevation, record_property
):
    ambient = daylight(diffuse_share, sun_elevation)
    veil = Veil(RESPONSE, ambient)
    cosine, azimuth = np.meshgrid(
        (np.arange(500) + 0.5) / 500, (np.arange(500) + 0.5) / 500 * 2 * np.pi
    )
    across = np.sqrt(1 - cosine**2)
    rays = np.stack([across * np.cos(azimuth), across * np.sin(azimuth), -cosine])
    light = view(ambient, Calm()).light(veil.moment(0.0), 0.01, rays.astype(np.float32), 1e-6)
    irradiance = (light * cosine[..., None]).mean(axis=(0, 1)) * 2 * np.pi
    wanted = RESPONSE.signal(ambient.downwelling(0.0, 0.0))
    off = np.abs(irradiance / wanted - 1).max()
    record_property("figure", f"sky {diffuse_share:g}, sun {sun_elevation:g} deg: off {off:.2%}")
    assert irradiance == pytest.approx(wanted, rel=0.03)


def test_a_flat_surface_is_a_mirror_beyond_the_critical_angle_and_a_window_within():
    ambient = daylight(1.0, water=POOL)
    veil = Veil(RESPONSE, ambient)
    zenith = np.radians(np.linspace(20, 80, 601))
    rays = np.stack([np.sin(zenith), 0 * zenith, -np.cos(zenith)])[:, None]
    light = view(ambient, Calm()).light(veil.moment(0.0), 1.0, rays.astype(np.float32), 1e-6)
    step = np.diff(np.log(light[0, :, 1])).argmin()
    assert math.degrees(zenith[step]) == pytest.approx(CRITICAL_DEG, abs=0.5)


def test_the_mirror_shows_the_floor_that_lies_below():
    ambient = daylight(1.0, water=POOL)
    moment = Veil(RESPONSE, ambient).moment(0.0)
    angle = np.radians(60)
    ray = np.array([math.sin(angle), 0, -math.cos(angle)], np.float32)[:, None, None]
    dark, bright = (
        view(ambient, Calm(), Basin(Floor(2.0, colour))).light(moment, 1.0, ray, 1e-6)[0, 0]
        for colour in ((0.0, 0.0, 0.0), (0.5, 0.5, 0.5))
    )
    # 2 m down to the floor, 1 m up to the eye, both at 60 degrees.
    left = np.exp(-POOL.c * 3.0 / math.cos(angle) - ambient.kd * 2.0)
    wanted = RESPONSE.signal(0.5 / math.pi * ambient.downwelling(0.0, 0.0) * left)
    assert (bright - dark)[1:] == pytest.approx(wanted[1:], rel=0.03)
    # Over 6 m the red band narrows, and the two legs are integrated one by one.
    assert (bright - dark)[0] == pytest.approx(wanted[0], rel=0.15)


def test_waves_of_the_wind_blur_the_windows_edge(record_property):
    ambient = daylight(1.0, water=POOL)
    moment = Veil(RESPONSE, ambient).moment(0.0)
    zenith, azimuth = np.radians(np.meshgrid(np.linspace(20, 75, 111), np.linspace(0, 350, 72)))
    rays = np.stack(
        [np.sin(zenith) * np.cos(azimuth), np.sin(zenith) * np.sin(azimuth), -np.cos(zenith)]
    ).astype(np.float32)
    widths = []
    for wind in (0.5, 5.0, 10.0):
        light = view(ambient, GaussianField(3, wind)).light(moment, 2.0, rays, 1e-3)[..., 1]
        # What a column of the window's edge lets in, from all of the sky to none of it.
        bright = light > 0.5 * np.median(light[:, :10])
        share = bright.mean(axis=0)
        widths.append(((share > 0.05) & (share < 0.95)).sum() * 0.5)
    record_property("figure", f"window's edge, degrees at 0.5, 5, 10 m/s: {[*map(float, widths)]}")
    assert widths[0] < widths[1] < widths[2]
