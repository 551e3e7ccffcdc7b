from __future__ import annotations

import numpy as np

from chromadock.robust.chroma import Colours

FOUR = np.array([[0, 1, 2, 3]])


def evidence(chroma: np.ndarray, near: np.ndarray | None = None, snr: float = 60.0) -> float:
    """That the first four of N peaks have one colour; ``near``: no two but themselves."""
    count = len(chroma)
    near = np.eye(count, dtype=bool) if near is None else near
    return float(Colours.of(chroma, np.full(count, snr), near).log_common(FOUR)[0])


def test_one_colour_among_many_speaks_for_a_dock_and_many_colours_against() -> None:
    rng = np.random.default_rng(0)
    chroma = rng.uniform(-1, 1, (40, 2))
    assert evidence(chroma) < 0
    chroma[:4] = rng.normal((0.3, -0.4), 0.03, (4, 2))
    assert evidence(chroma) > np.log(100)


def test_one_colour_where_all_have_it_says_nothing() -> None:
    chroma = np.random.default_rng(1).normal(0.5, 0.05, (60, 2))
    assert abs(evidence(chroma, near=np.ones((60, 60), bool))) < np.log(3)


def test_a_wall_of_one_colour_is_no_dock() -> None:
    """It is alone of its colour in the frame, but all about has it."""
    rng = np.random.default_rng(2)
    chroma = rng.uniform(-1, 1, (60, 2))
    chroma[:20] = rng.normal((0.4, 0.2), 0.05, (20, 2))
    wall = np.arange(60) < 20
    alone, among = evidence(chroma), evidence(chroma, near=wall[:, None] & wall)
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
        places = rng.uniform(0, 1, (count, 2))
        near = np.linalg.norm(places[:, None] - places, axis=2) < 0.2
        seen = Colours.of(chroma, rng.uniform(3, 40, count), near)
        sets = np.array([rng.permutation(count)[:4] for _ in range(50)])
        ratios.append(seen.log_common(sets))
    for ratio in (3, 10, 30):
        assert np.mean(np.concatenate(ratios) >= np.log(ratio)) < 1 / ratio


def test_no_set_says_more_than_was_hoped_of_it() -> None:
    rng = np.random.default_rng(6)
    for _ in range(50):
        count = int(rng.integers(4, 40))
        chroma = rng.normal(0, 0.5, (count, 2))
        chroma[:4] *= 0.1
        near = rng.random((count, count)) < 0.3
        near |= near.T | np.eye(count, dtype=bool)
        seen = Colours.of(chroma, rng.uniform(3, 40, count), near)
        hoped = seen.most(aside=3)[np.ix_(FOUR[0], FOUR[0])].sum(axis=1).max()
        assert seen.log_common(FOUR)[0] <= hoped + 1e-9
