"""What colours say of sets of peaks: the evidence less what strengths and rarity say, by
``search_reference``."""

from __future__ import annotations

import numpy as np
from search_reference import log_alike, rarity

from chromadock.robust.frame.peaks import Peaks
from chromadock.robust.weigh.evidence import PlacedPeaks, evidence_of_sets

FOUR = np.array([[0, 1, 2, 3]])
AREA = 1e4
APART = 1e3 * np.arange(200) * (1 + 0j)
"""Places of which none is in another's neighbourhood."""


def log_common(chroma: np.ndarray, sets: np.ndarray, z: np.ndarray, snr: np.ndarray) -> np.ndarray:
    """(M,) of sets (M, n) of peaks at ``z`` (N,), in order of their ``snr`` (N,)."""
    count, along = len(chroma), np.zeros(sets.shape[1])
    nothing, order = np.zeros(count), np.arange(count)
    xy = np.column_stack([z.real, z.imag])
    peaks = Peaks(xy, snr, nothing, chroma, nothing, order, np.ones(len(snr)))
    rest = []
    for members in sets.tolist():
        others = [i for i in range(count) if i not in members]
        rare = sum(rarity(z, peaks, AREA, m, others) for m in members)
        rest.append(log_alike(snr[members], along) + rare)
    return evidence_of_sets(PlacedPeaks(z, peaks, AREA), sets, along) - rest


def evidence(chroma: np.ndarray, z: np.ndarray = APART, snr: float = 60.0) -> float:
    """That the first four of N peaks have one colour."""
    count = len(chroma)
    return float(log_common(chroma, FOUR, z[:count], np.full(count, snr))[0])


def test_one_colour_among_many_speaks_for_a_dock_and_many_colours_against() -> None:
    rng = np.random.default_rng(0)
    chroma = rng.uniform(-1, 1, (40, 2))
    assert evidence(chroma) < 0
    chroma[:4] = rng.normal((0.3, -0.4), 0.03, (4, 2))
    assert evidence(chroma) > np.log(100)


def test_one_colour_where_all_have_it_says_nothing() -> None:
    chroma = np.random.default_rng(1).normal(0.5, 0.05, (60, 2))
    assert abs(evidence(chroma, z=0 * APART)) < np.log(3)


def test_a_wall_of_one_colour_is_no_dock() -> None:
    """It is alone of its colour in the frame, but all about has it."""
    rng = np.random.default_rng(2)
    chroma = rng.uniform(-1, 1, (60, 2))
    chroma[:20] = rng.normal((0.4, 0.2), 0.05, (20, 2))
    wall = np.where(np.arange(60) < 20, 0, APART[:60])
    alone, among = evidence(chroma), evidence(chroma, z=wall)
    assert among < alone - np.log(10)


def test_one_marker_of_another_colour_is_borne_with() -> None:
    """A glint before it: what it says is lost, and a little more."""
    rng = np.random.default_rng(3)
    chroma = rng.uniform(-1, 1, (40, 2))
    chroma[:3] = rng.normal((0.3, -0.4), 0.03, (3, 2))
    chroma[3] = (-0.9, 0.9)
    assert evidence(chroma) > 0


def test_a_faint_peaks_colour_says_little() -> None:
    rng = np.random.default_rng(4)
    chroma = rng.uniform(-1, 1, (40, 2))
    chroma[:4] = rng.normal((0.3, -0.4), 0.03, (4, 2))
    assert evidence(chroma, snr=3.0) < evidence(chroma, snr=60.0) / 3


def test_clutter_gains_much_as_seldom_as_a_likelihood_ratio_does() -> None:
    """Markov's inequality, of all sets of all frames."""
    rng = np.random.default_rng(5)
    ratios = []
    for _ in range(300):
        count = int(rng.integers(8, 56))
        chroma = rng.normal(rng.normal(0, 0.3, 2), rng.uniform(0.2, 0.8), (count, 2))
        z = rng.uniform(0, 100, (count, 2)) @ np.array([1, 1j])
        snr = np.sort(rng.uniform(3, 40, count))[::-1]
        sets = np.array([rng.permutation(count)[:4] for _ in range(10)])
        ratios.append(log_common(chroma, sets, z, snr))
    for ratio in (3, 10, 30):
        assert np.mean(np.concatenate(ratios) >= np.log(ratio)) < 1 / ratio
