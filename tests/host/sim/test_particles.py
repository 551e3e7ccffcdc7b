"""Suspended specks: how many, where, how bright, how sharp."""

from __future__ import annotations

import numpy as np
import pytest

from chromadock.camera import CameraModel
from chromadock.sim import particles
from chromadock.sim.ambient import Ambient
from chromadock.sim.particles import FOCUS_M, REACH_M, Particles, Suspension
from chromadock.sim.response import Response
from chromadock.sim.transform import Transform
from chromadock.sim.water import Water

CAMERA = CameraModel(160, 120, np.array([[128.0, 0, 79.5], [0, 128.0, 59.5], [0, 0, 1]]))
LINE_NM = 530.0
NARROW = Response.of_bands(*([(LINE_NM, 5.0, 1.0)] for _ in range(3)))
NORTH = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
HERE = Transform(NORTH, np.array([0.0, 0.0, 2.0]))


def ambient() -> Ambient:
    return Ambient(Water.jerlov_type("III"), 50000.0, 90.0, 0.0, diffuse_share=1.0, flicker=False)


def drawn(suspension: Suspension, pose: Transform = HERE, time_s: float = 0.0) -> np.ndarray:
    light = np.zeros((120, 160, 3), np.float32)
    Particles(suspension, CAMERA, NARROW, ambient()).draw(light, pose, time_s)
    return light


def test_as_many_specks_are_seen_as_are_in_the_water_before_the_camera(record_property) -> None:
    """Against the volume of the pyramid in the ball of what is drawn, by Monte Carlo."""
    rng = np.random.default_rng(0)
    points = rng.uniform(-REACH_M, REACH_M, (400_000, 3))
    ahead = points[points[:, 2] > particles.NEAREST_M]
    pixels = ahead[:, :2] / ahead[:, 2:] * 128 + (79.5, 59.5)
    in_image = ((pixels > -0.5) & (pixels < (159.5, 119.5))).all(axis=1)
    in_reach = (ahead**2).sum(axis=1) < REACH_M**2
    volume = (in_image & in_reach).sum() / len(points) * (2 * REACH_M) ** 3
    specks = Particles(Suspension(1, 20_000.0, 1e-3, (0, 0, 0)), CAMERA, NARROW, ambient())
    found, radius = specks._in_view(HERE, 0.0)
    seen = found[:, :2] / found[:, 2:] * 128 + (79.5, 59.5)
    count = ((seen > -0.5) & (seen < (159.5, 119.5))).all(axis=1).sum()
    wanted = 20_000 * volume
    record_property("figure", f"specks in view {count}, wanted {wanted:.0f}")
    assert count == pytest.approx(wanted, abs=4 * np.sqrt(wanted))
    assert np.median(2 * radius) == pytest.approx(1e-3, rel=0.05)


def test_a_camera_that_drifts_along_sees_the_same_specks() -> None:
    suspension = Suspension(2, 500.0, 1e-3, (0.1, -0.2, 0.0))
    later = Transform(NORTH, HERE.t + 7.0 * np.array(suspension.drift_m_s))
    image = drawn(suspension)
    assert (image > 0).any()
    np.testing.assert_allclose(drawn(suspension, later, 7.0), image, rtol=1e-3, atol=1e-3)
    assert not np.allclose(drawn(suspension, HERE, 7.0), image, rtol=0.1)


def test_no_speck_pops_up_within_reach() -> None:
    """Space is filled periodically, but each speck's second self is out of sight."""
    specks = Particles(Suspension(3, 200.0, 1e-3, (0.3, 0.2, 0.1)), CAMERA, NARROW, ambient())
    before, _ = specks._in_view(HERE, 0.0)
    after, _ = specks._in_view(HERE, 0.01)
    moved = 0.01 * np.linalg.norm((0.3, 0.2, 0.1))
    inner = before[(np.linalg.norm(before, axis=1) < 0.9 * REACH_M) & (before[:, 2] > 0.3)]
    slack = specks._widest * inner[:, 2] - np.abs(inner[:, :2]).max(axis=1)
    inner = inner[slack > 0.05]
    apart = np.linalg.norm(inner[:, None] - after, axis=-1).min(axis=1)
    assert len(inner) > 5
    np.testing.assert_allclose(apart, moved, rtol=1e-6)


def test_a_speck_sends_as_much_light_as_a_matt_ball_of_its_size(monkeypatch) -> None:
    """Half of what falls from all around, over pi, on the ball's disc, dimmed on the way."""
    monkeypatch.setattr(particles, "SPREAD", 0.0)
    water = ambient().water
    suspension = Suspension(4, 300.0, 2e-3, (0, 0, 0))
    places, _ = Particles(suspension, CAMERA, NARROW, ambient())._in_view(HERE, 0.0)
    pixels = CAMERA.project(places)
    whole = ((pixels > 20) & (pixels < (140, 100))).all(axis=1)
    alone = np.linalg.norm(pixels[:, None] - pixels, axis=-1) + 1e9 * np.eye(len(pixels))
    far = np.linalg.norm(places, axis=1) > 0.5
    chosen = np.flatnonzero(whole & far & (alone.min(axis=1) > 12))
    image = drawn(suspension)[..., 1]
    up = 0.33 * water.bb / water.a
    for x, y, place in zip(*pixels[chosen].T, places[chosen], strict=True):
        r = np.linalg.norm(place)
        falls = ambient().downwelling(2.0, 0.0) * (1 + up) / 2
        seen = NARROW.signal(particles.REFLECTANCE / np.pi * falls * np.exp(-water.c * r))[1]
        fills = np.pi * (1e-3 / r * 128) ** 2
        patch = image[round(y) - 5 : round(y) + 6, round(x) - 5 : round(x) + 6]
        assert patch.sum() == pytest.approx(seen * fills, rel=0.05)
    assert len(chosen) >= 2


def test_specks_are_sharp_at_the_focus_and_discs_before_it() -> None:
    def widest(range_m: float) -> float:
        light = np.zeros((120, 160, 3), np.float32)
        specks = Particles(Suspension(0, 0.0, 1e-4, (0, 0, 0)), CAMERA, NARROW, ambient())
        specks._starts = (HERE.t + NORTH @ [0, 0, range_m])[None]
        specks._radius = np.array([1e-4])
        specks.draw(light, HERE, 0.0)
        row = light[59, :, 1] + light[60, :, 1]
        x = np.arange(160) - 79.5
        return float(np.sqrt((row * x**2).sum() / row.sum()))

    near = particles.APERTURE_M * 128 * (1 / 0.1 - 1 / FOCUS_M) / 2 / 2
    assert widest(0.1) == pytest.approx(np.hypot(0.7, near), rel=0.1)
    assert widest(0.95) == pytest.approx(0.7, rel=0.1)


def test_clear_water_has_no_specks() -> None:
    assert not drawn(Suspension(5, 0.0, 1e-3, (0, 0, 0))).any()


def test_specks_before_bright_water_never_take_more_light_than_there_is() -> None:
    light = np.full((120, 160, 3), 1e5, np.float32)
    crowd = Suspension(6, 3000.0, 8e-3, (0, 0, 0))
    Particles(crowd, CAMERA, NARROW, ambient()).draw(light, HERE, 0.0)
    assert light.min() >= 0
    assert light.mean() < 0.9e5
