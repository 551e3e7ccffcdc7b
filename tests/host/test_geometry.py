"""The five-marker dock, and the command that measures it beside the rectangle."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import cv2
import geometry
import numpy as np
import pytest

from chromadock import DockGeometry
from chromadock.geometry.pose import Estimate

DOCS = Path(__file__).resolve().parents[2] / "docs"
NEEDS_PHOTOGRAPHS = pytest.mark.skipif(
    not geometry.PHOTOGRAPHS.is_dir(), reason="no photographs: ../shared/data is missing"
)


def estimate(yaw_deg: float, z: float) -> Estimate:
    R = cv2.Rodrigues(np.radians([0.0, yaw_deg, 0.0]))[0]
    return Estimate(R, np.array([0.0, 0.0, z]), 1.0, 0.2, np.eye(6) * 100.0**2)


def test_the_shipped_dock_is_the_default_with_a_marker_in_front() -> None:
    five, four = DockGeometry.from_toml(geometry.FIVE), DockGeometry.default()
    assert five.names == (*four.names, "front")
    assert np.array_equal(five.points[:4], four.points)
    assert five.points[4].tolist() == [0.0, 0.0, -0.3]


def test_errors_are_those_of_the_first_pose_and_the_region_that_of_either() -> None:
    R, t = estimate(10, 5.0).R, np.array([0.0, 0.0, 5.0])
    right, wrong, far = estimate(10, 5.0), estimate(-10, 5.02), estimate(10, 5.2)
    good = geometry.errors((right, wrong), R, t)
    assert (good.position_m, good.attitude_deg) == (0.0, pytest.approx(0, abs=1e-6))
    assert (good.wrong_branch, good.covered) == (False, True)
    bad = geometry.errors((wrong, right), R, t)
    assert bad.position_m == pytest.approx(0.02) and bad.attitude_deg == pytest.approx(20)
    assert (bad.wrong_branch, bad.covered) == (True, True)
    assert not geometry.errors((far,), R, t).covered


@pytest.mark.parametrize("view", [geometry.pose_in_view, geometry.ahead])
def test_a_fifth_marker_makes_the_attitude_far_more_exact(view: Any, record_property: Any) -> None:
    seen = {
        name: [geometry.by_geometry(name, 5.0, 0.2, i, 1, view) for i in range(120)]
        for name in geometry.DOCKS
    }
    four, five = (
        np.percentile([e.attitude_deg for e in seen[name]], (50, 95)) for name in geometry.DOCKS
    )
    record_property(
        "figure",
        f"attitude at 5 m, 0.2 px, {view.__name__}: {four[0]:.1f} deg with four markers, "
        f"{five[0]:.1f} with five (120 views)",
    )
    assert (four > 4 * five).all()
    assert not any(e.wrong_branch for e in seen["five markers"])
    assert 0.9 <= np.mean([e.covered for e in seen["five markers"]]) <= 0.995


@NEEDS_PHOTOGRAPHS
def test_the_five_marker_dock_is_found_on_photographs() -> None:
    seen = [geometry.on_photograph("five markers", 2.0, i, 5) for i in range(17)]
    good = [e for e in seen if e is not None]
    assert len(good) >= 16
    assert np.median([e.attitude_deg for e in good]) < 0.3


def test_tables_are_put_in_their_places_and_nowhere_else() -> None:
    page = "a\n<!-- printed by tools/geometry.py: x -->\nold\n<!-- end -->\nb\n"
    after = geometry.written(page, {"x": "new"})
    assert after == page.replace("old", "new")
    assert geometry.written(after, {"x": "new"}) == after
    with pytest.raises(ValueError, match="no place for y"):
        geometry.written(page, {"y": "new"})


def test_the_page_has_every_table_whole() -> None:
    page = geometry.PAGE.read_text(encoding="utf-8")
    noises, ranges = len(geometry.NOISE_PX), len(geometry.RANGES_M)
    rows = {"geometry": noises * ranges, "ahead": noises, "photographs": ranges}
    assert set(rows) == set(geometry.TABLES)
    for key, number in rows.items():
        table = page.partition(geometry.BEGIN.format(key))[2].partition(geometry.END)[0]
        for name in geometry.DOCKS:
            assert table.count(f"| {name} |") == number


def test_the_drawing_is_that_of_the_docks(monkeypatch: Any) -> None:
    monkeypatch.setattr(sys, "path", [str(DOCS), *sys.path])
    import draw_docks

    drawn = "\n".join([*draw_docks.draw().parts, "</svg>", ""])
    assert (DOCS / "images" / "docks.svg").read_text(encoding="utf-8") == drawn
