"""The phase functions: against the columns that Petzold's report prints."""

import csv
import math
from importlib import resources

import jerlov
import numpy as np
import pytest

from chromadock.sim.phase import PhaseFunction


@pytest.fixture(params=jerlov.PETZOLD_STATIONS)
def station(request):
    return request.param


def printed(station):
    """Angles in degrees and the share of b within each, as the report integrated it."""
    text = resources.files("jerlov.data").joinpath("petzold1972_vsf.csv").read_text("utf-8")
    rows = [row for row in csv.DictReader(text.splitlines()) if row["station"] == station]
    return np.array([(float(r["angle_deg"]), float(r["normalized_integral"])) for r in rows]).T


def test_printed_angles_have_printed_values(station):
    measured = jerlov.petzold_scattering(station)
    value = PhaseFunction.of(station).value(np.radians(measured.angles_deg))
    assert value == pytest.approx(measured.phase_function(), rel=3e-3)


def test_it_integrates_to_one_over_the_sphere(station):
    edges = np.geomspace(1e-12, math.pi, 200_001)
    middle = np.sqrt(edges[1:] * edges[:-1])
    phase = PhaseFunction.of(station)
    inside = 2 * math.pi * phase.value(middle) * np.sin(middle) * np.diff(edges)
    assert inside.sum() == pytest.approx(1, abs=2e-3)


@pytest.mark.parametrize("degrees", [0.01, 0.05, 0.1, 2.0])
def test_a_share_is_the_integral_of_the_value(station, degrees):
    edges = np.geomspace(1e-14, math.radians(degrees), 200_001)
    middle = np.sqrt(edges[1:] * edges[:-1])
    phase = PhaseFunction.of(station)
    inside = 2 * math.pi * phase.value(middle) * np.sin(middle) * np.diff(edges)
    assert phase.share_within(math.radians(degrees)) == pytest.approx(inside.sum(), abs=2e-3)


def test_shares_are_those_that_the_report_integrated(station, record_property):
    angles, shares = printed(station)
    share = PhaseFunction.of(station).share_within(np.radians(angles))
    record_property("figure", f"{station}: largest difference {np.abs(share - shares).max():.4f}")
    assert share == pytest.approx(shares, abs=4e-3)


def test_shares_rise_from_nothing_to_all(station):
    angles = np.concatenate([[0.0], np.geomspace(1e-6, math.pi, 1000)])
    share = PhaseFunction.of(station).share_within(angles)
    assert share[0] == 0
    assert (np.diff(share) > 0).all()
    assert share[-1] == pytest.approx(1)


# Share of b within 1 and 10 degrees as ../shared/docs/underwater-light.md has it for the
# measured angles, from 0.1 degree on.
@pytest.mark.parametrize(
    ("station", "within_1", "within_10"),
    [("AUTEC 8", 0.17, 0.56), ("HAOCE 11", 0.23, 0.62), ("NUC 2040", 0.18, 0.61)],
)
def test_small_angles_have_the_documented_share(station, within_1, within_10):
    share = PhaseFunction.of(station).share_within(np.radians([0.1, 1, 10]))
    assert share[1:] - share[0] == pytest.approx([within_1, within_10], abs=0.006)


def test_the_backscatter_ratio_is_the_printed_one(station):
    ratio = jerlov.petzold_scattering(station).backscatter_ratio
    assert PhaseFunction.of(station).backscatter_ratio == pytest.approx(ratio, abs=5.1e-4)


@pytest.mark.parametrize(
    ("scattering", "station"),
    [(0.003, "AUTEC 8"), (0.2, "HAOCE 11"), (1.2, "NUC 2240"), (3.0, "NUC 2040")],
)
def test_a_water_is_likened_to_the_station_that_scatters_as_much(scattering, station):
    assert PhaseFunction.nearest(scattering).station == station


def test_straight_ahead_is_finite():
    assert np.isfinite(PhaseFunction.of("NUC 2040").value(0.0))
