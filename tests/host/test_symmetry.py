"""Docks that look alike under a turn."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from chromadock import DockGeometry
from chromadock.geometry.symmetry import symmetries

FIVE = Path(__file__).resolve().parents[2] / "docs" / "five_marker_dock.toml"
RECTANGLE = DockGeometry.default().points
SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]]) * 0.3
LINE = np.array([[-0.45, 0, 0], [-0.15, 0, 0], [0.15, 0, 0], [0.45, 0, 0]])


def ring(count: int, radius_m: float = 0.4) -> np.ndarray:
    angles = 2 * np.pi * np.arange(count) / count
    return radius_m * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])


def turns_deg(points: np.ndarray) -> list[float]:
    """About z, in -180 to 180; fails for one about another axis."""
    vectors = [cv2.Rodrigues(R)[0].ravel() for _, R in symmetries(points)]
    assert all(np.abs(v[:2]).max() < 1e-6 for v in vectors)
    return sorted(round(float(np.degrees(v[2])), 3) for v in vectors)


def test_a_rectangle_looks_the_same_after_a_half_turn_about_its_normal() -> None:
    """Not after those about its sides: they show it from behind."""
    ((order, R),) = symmetries(RECTANGLE)
    assert order == (3, 2, 1, 0)
    np.testing.assert_allclose(R, np.diag([-1, -1, 1]), atol=1e-12)


def test_a_square_looks_the_same_after_each_quarter_turn() -> None:
    assert [abs(turn) for turn in turns_deg(SQUARE)] == pytest.approx([90, 90, 180])
    orders = dict(symmetries(SQUARE))
    assert (3, 2, 1, 0) in orders and len(orders) == 3


def test_four_in_a_line_can_be_reversed() -> None:
    ((order, R),) = symmetries(LINE)
    assert order == (3, 2, 1, 0)
    np.testing.assert_allclose(R, np.diag([-1, -1, 1]), atol=1e-12)
    uneven = LINE.copy()
    uneven[1, 0] += 0.04
    assert symmetries(uneven) == ()


def test_a_line_along_the_view_cannot() -> None:
    assert symmetries(LINE[:, ::-1].copy()) == ()


def test_a_ring_looks_the_same_after_each_eighth_of_a_turn() -> None:
    turns = [abs(t) for t in turns_deg(ring(8))]
    assert sorted(turns) == pytest.approx([45, 45, 90, 90, 135, 135, 180])


def test_an_arm_in_the_middle_leaves_the_half_turn() -> None:
    """The fifth marker of the dock in docs is on the axis."""
    ((order, R),) = symmetries(DockGeometry.from_toml(FIVE).points)
    assert order == (3, 2, 1, 0, 4)
    np.testing.assert_allclose(R, np.diag([-1, -1, 1]), atol=1e-12)


def test_a_marker_off_the_axis_leaves_nothing() -> None:
    assert symmetries(np.vstack([RECTANGLE, [0.0, -0.2, -0.3]])) == ()
    assert symmetries(np.vstack([SQUARE, [0.15, 0.0, 0.0]])) == ()


def test_three_markers() -> None:
    assert [abs(t) for t in turns_deg(ring(3))] == pytest.approx([120, 120])
    assert symmetries(RECTANGLE[:3]) == ()
    # Two equal sides: only the turn from behind would do.
    assert symmetries(np.array([[-0.4, 0, 0], [0.4, 0, 0], [0, 0.6, 0]])) == ()


def test_what_is_about_symmetrical_counts() -> None:
    rng = np.random.default_rng(0)
    assert len(symmetries(SQUARE + rng.normal(0, 0.003, (4, 3)))) == 3
    assert symmetries(SQUARE * [1.0, 1.2, 1.0]) != ()  # a rectangle still
    assert len(symmetries(SQUARE * [1.0, 1.2, 1.0])) == 1
    assert symmetries(SQUARE + 0.06 * np.eye(4)[:, :3]) == ()


@given(
    seed=st.integers(0, 10_000),
    count=st.integers(3, 7),
    shift=st.tuples(*[st.floats(-5, 5)] * 3),
)
def test_each_is_a_proper_rotation_onto_itself(
    seed: int, count: int, shift: tuple[float, float, float]
) -> None:
    """Of rings, some with markers off their places, wherever the origin is."""
    rng = np.random.default_rng(seed)
    points = ring(count) + rng.normal(0, rng.choice([0.0, 0.005, 0.05]), (count, 3))
    points = points + np.array(shift)
    centred = points - points.mean(axis=0)
    for order, R in symmetries(points):
        assert sorted(order) == list(range(count)) != list(order)
        assert np.linalg.det(R) == pytest.approx(1.0)
        np.testing.assert_allclose(R.T @ R, np.eye(3), atol=1e-12)
        assert np.linalg.norm(centred @ R.T - centred[list(order)], axis=1).max() < 0.02


def test_a_dock_knows_its_symmetries() -> None:
    dock = DockGeometry.default()
    assert [order for order, _ in dock.symmetries] == [(3, 2, 1, 0)]
    assert dock.symmetries is dock.symmetries
