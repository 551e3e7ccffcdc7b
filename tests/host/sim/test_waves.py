"""Waves and bobbing: statistics, dispersion and random access."""

import math

import numpy as np
import pytest

from chromadock.sim.waves import GaussianField, Sway


def test_the_field_has_unit_variance_and_a_gaussians_kurtosis(record_property):
    rng = np.random.default_rng(1)
    values = np.concatenate(
        [
            GaussianField(seed).value(1e4 * rng.random(4000), *(500 * rng.random((2, 4000))))
            for seed in range(20)
        ]
    )
    kurtosis = (values**4).mean() / (values**2).mean() ** 2
    record_property("figure", f"variance {values.var():.4f}, kurtosis {kurtosis:.3f} (Gauss: 3)")
    assert values.mean() == pytest.approx(0, abs=0.02)
    assert values.var() == pytest.approx(1, abs=0.02)
    assert kurtosis == pytest.approx(3, abs=0.12)
    # A Gaussian is below -1 for 15.87 % and below -2 for 2.28 % of the time.
    assert (values < -1).mean() == pytest.approx(0.1587, abs=0.005)
    assert (values < -2).mean() == pytest.approx(0.0228, abs=0.003)


@pytest.mark.parametrize("place", [(0.0, 0.0), (3.0, -7.0)])
def test_a_long_time_at_one_place_has_unit_variance_too(place):
    values = GaussianField(3).value(np.arange(0, 4000, 0.05), *place)
    assert values.var() == pytest.approx(1, abs=0.03)


def test_any_moment_can_be_asked_alone_and_in_any_order():
    field = GaussianField(7)
    times = np.array([3.0, 1e5 + 0.25, 12.5])
    together = field.value(times, 0.3, -0.2)
    alone = [float(GaussianField(7).value(time, 0.3, -0.2)) for time in times[::-1]]
    assert together == pytest.approx(alone[::-1], abs=1e-5)


def test_places_and_times_broadcast():
    field = GaussianField(7)
    x, y = np.linspace(0, 1, 5), np.linspace(0, 2, 3)[:, None]
    assert field.value(1.0, x, y).shape == (3, 5)
    assert field.value(np.zeros((2, 1, 1)), x, y).shape == (2, 3, 5)
    assert field.slope(1.0, x, y).shape == (3, 5, 2)
    assert field.value(1.0, 0.0, 0.0).shape == ()
    assert field.value(1.0, x, y)[2, 4] == pytest.approx(field.value(1.0, 1.0, 2.0), abs=1e-5)


def test_another_seed_is_another_sea():
    times = np.arange(0, 2000, 0.1)
    one, other = (GaussianField(seed).value(times, 0, 0) for seed in (1, 2))
    assert abs(np.corrcoef(one, other)[0, 1]) < 0.05


@pytest.mark.parametrize(("length", "period"), [(1.0, 0.8004), (6.0, 1.9605)])
def test_waves_run_as_on_deep_water(length, period):
    # T = sqrt(2 pi length / g), computed by hand for g = 9.81.
    field = GaussianField(5, shortest_m=length, longest_m=length)
    times = np.linspace(0, 3, 50)
    later = field.value(times + period, 0.4, 0.1)
    assert later == pytest.approx(field.value(times, 0.4, 0.1), abs=2e-3)
    half = field.value(times + period / 2, 0.4, 0.1)
    assert half == pytest.approx(-field.value(times, 0.4, 0.1), abs=2e-3)


# Mean square slope of a clean surface: Cox & Munk (1954), both axes together.
@pytest.mark.parametrize(("wind", "variance"), [(0.0, 0.003), (5.0, 0.0286), (10.0, 0.0542)])
def test_the_surface_is_as_steep_as_cox_and_munk_measured(wind, variance, record_property):
    rng = np.random.default_rng(2)
    slopes = np.concatenate(
        [
            GaussianField(seed, wind_m_s=wind).slope(
                1e4 * rng.random(2000), *(500 * rng.random((2, 2000)))
            )
            for seed in range(10)
        ]
    )
    total = (slopes**2).sum(axis=1).mean()
    record_property("figure", f"wind {wind:g} m/s: mean square slope {total:.4f}")
    assert total == pytest.approx(variance, rel=0.03)
    assert slopes[:, 0].var() == pytest.approx(slopes[:, 1].var(), rel=0.15)


def test_the_slope_is_that_of_a_surface():
    # A gradient has no curl.
    field, step = GaussianField(4, shortest_m=0.5), 1e-2
    x, y = np.random.default_rng(0).random((2, 200)) * 10
    along_y = (field.slope(1.0, x, y + step) - field.slope(1.0, x, y - step))[:, 0]
    along_x = (field.slope(1.0, x + step, y) - field.slope(1.0, x - step, y))[:, 1]
    assert np.abs(along_y).max() > 0.01
    assert along_y == pytest.approx(along_x, abs=2e-4)


def test_the_surface_is_level_on_crests_and_in_troughs():
    # The slope is the derivative of a height of the same waves: value and slope are in
    # quadrature at every place, so their product averages to 0.
    field = GaussianField(4)
    x, y = np.random.default_rng(0).random((2, 20_000)) * 300
    product = field.value(0.0, x, y)[:, None] * field.slope(0.0, x, y)
    assert product.mean(axis=0) == pytest.approx([0, 0], abs=0.005)


def test_bobbing_has_its_root_mean_square_and_its_period(record_property):
    times = np.arange(0, 3000, 0.1)
    motion = Sway(3, 0.05, 4.0).value(times)
    assert motion.std() == pytest.approx(0.05 / math.sqrt(2), rel=0.05)
    power = np.abs(np.fft.rfft(motion)) ** 2
    frequency = np.fft.rfftfreq(len(times), 0.1)
    mean = (power * frequency).sum() / power.sum()
    record_property("figure", f"mean period {1 / mean:.2f} s of 4 s")
    assert 1 / mean == pytest.approx(4.0, rel=0.1)
    assert power[(frequency < 0.6 / 4) | (frequency > 1.4 / 4)].sum() < 0.01 * power.sum()


def test_bobbing_is_the_seeds():
    assert Sway(3, 1, 4).value(1234.5) == Sway(3, 1, 4).value(np.array([0, 1234.5]))[1]
    assert Sway(3, 1, 4).value(1234.5) != Sway(4, 1, 4).value(1234.5)
    assert not Sway(3, 0, 4).value(np.arange(10.0)).any()
