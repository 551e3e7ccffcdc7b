"""Aperture photometry of lamps, against lamps of known light."""

from __future__ import annotations

import numpy as np
import pytest

from chromadock.robust.frame.flux import Fluxes, fluxes
from chromadock.robust.frame.response import GAMMA

PLACES = np.array([(60.0, 60.0), (140.2, 60.7), (61.4, 140.0), (140.0, 141.3)])
LIGHT = np.array([1.0, 0.7, 1.4, 0.5])
COLOUR = np.array([0.2, 1.0, 0.4])


def picture(
    light: np.ndarray, width: float = 2.0, peak: float = 0.4, seed: int | None = None
) -> np.ndarray:
    """Lamps as bright as told before water that grows lighter to the right; with noise of one
    hundredth of full scale, if there is a seed."""
    y, x = np.mgrid[:200, :200].astype(np.float64)
    linear = np.zeros((200, 200, 3)) + np.array([0.05, 0.08, 0.03]) * (1 + x[..., None] / 200)
    for (u, v), power in zip(PLACES, light, strict=True):
        bell = np.exp(-0.5 * ((x - u) ** 2 + (y - v) ** 2) / width**2)
        linear += peak * power * bell[..., None] * COLOUR
    if seed is not None:
        linear += np.random.default_rng(seed).normal(0, 0.01, linear.shape)
    return np.rint(255 * np.clip(linear, 0, 1) ** (1 / GAMMA)).astype(np.uint8)


def ratios(found: Fluxes | None) -> np.ndarray:
    """To the first lamp."""
    assert found is not None
    return np.exp(found.log - found.log[0])


@pytest.mark.parametrize("width", [1.0, 2.0, 5.0])
def test_lamps_are_as_bright_as_they_are(width: float) -> None:
    assert ratios(fluxes(picture(LIGHT, width), PLACES)) == pytest.approx(LIGHT, rel=0.05)


def test_where_exactly_a_lamp_is_supposed_does_not_matter() -> None:
    shifted = PLACES + np.array([(0.4, -0.3), (-0.5, 0.1), (0.2, 0.5), (0.0, -0.4)])
    assert ratios(fluxes(picture(LIGHT), shifted)) == pytest.approx(LIGHT, rel=0.05)


def test_a_lamp_that_clips_seems_fainter_but_not_as_faint_as_one_that_is() -> None:
    seen = ratios(fluxes(picture(np.array([1.0, 1.0, 4.0, 1.0]), 3.0, 0.8), PLACES))
    assert 1.5 < seen[2] < 4.0
    assert seen[[1, 3]] == pytest.approx(1, rel=0.02)


def test_where_a_lamp_adds_no_light_nothing_is_told() -> None:
    assert fluxes(picture(np.array([1.0, 1.0, 1.0, 0.0])), PLACES) is None
    assert fluxes(np.zeros((200, 200, 3), np.uint8), PLACES) is None


def test_noise_scatters_as_much_as_is_told() -> None:
    found = [fluxes(picture(LIGHT, peak=0.1, seed=k), PLACES) for k in range(60)]
    logs = np.array([f.log - np.log(LIGHT) for f in found if f is not None])
    told = np.mean([f.sigma for f in found if f is not None], axis=0)
    assert len(logs) == 60
    spread = logs.std(axis=0) / told
    assert (spread > 0.7).all() and (spread < 1.6).all()
    assert told[3] > told[2]


def test_a_lamp_at_the_border_counts_with_what_is_in_view() -> None:
    seen = picture(np.array([1.0, 1.0, 1.0, 1.0]))[:, 55:]
    found = fluxes(seen, PLACES - np.array([55.0, 0.0]))
    assert found is not None and np.isfinite(found.log).all() and np.isfinite(found.sigma).all()
    beyond = fluxes(seen, PLACES - np.array([105.0, 0.0]))
    assert beyond is None


def test_of_large_discs_every_so_many_pixels_are_enough() -> None:
    seen = np.repeat(np.repeat(picture(LIGHT, 4.0), 8, axis=0), 8, axis=1)
    assert ratios(fluxes(seen, 8 * PLACES + 3.5)) == pytest.approx(LIGHT, rel=0.03)
