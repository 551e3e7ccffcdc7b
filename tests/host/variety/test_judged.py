"""What counts as recalled, and what as wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from limit import standing_out
from recall_tables import by_distance, by_factors
from recall_trials import judged

from chromadock import Detection
from chromadock.results.detection import Background, Marker
from chromadock.results.pose import Pose
from chromadock.variety import Backdrops, Truth, draw, render
from chromadock.variety.docks import matched


@pytest.fixture(scope="module")
def truth() -> Truth:
    return render(draw(3, 1, Backdrops(), camera="vga", dock="square"))[1]


def detection(
    truth: Truth, order: np.ndarray, off_px: float = 0.0, farther: float = 1.0
) -> Detection:
    """A detection with the true places, of which ``order`` tells which has which name."""
    assert truth.dock is not None
    places = truth.pixels[order] + (off_px, 0.0)
    x, y, z = (truth.t * farther).tolist()
    return Detection(
        state="found",
        background=Background((0, 0, 0), None, 0.0),
        marker=Marker((0, 0, 0), 0.0),
        observed=(0, 0, 0),
        passed_fraction=0.0,
        markers={n: (x, y) for n, (x, y) in zip(truth.dock.names, places.tolist(), strict=True)},
        pose=Pose((x, y, z), (1.0, 0.0, 0.0, 0.0), 0.1),
        evidence=5.0,
        timing_ms={"total": 1.0},
    )


@pytest.mark.parametrize("turn", [[0, 1, 2, 3], [1, 3, 0, 2], [3, 2, 1, 0]])
def test_a_square_is_recalled_whichever_way_up_it_is_named(turn: list[int], truth: Truth) -> None:
    row = judged(detection(truth, np.array(turn)), truth)
    assert row["recalled"] and not row["wrong"]
    assert row["apart_px"] == pytest.approx(0) and row["place_error"] == pytest.approx(0)


def test_a_marker_is_where_it_is_within_three_pixels_of_a_frame_640_wide(truth: Truth) -> None:
    straight = np.arange(4)
    assert judged(detection(truth, straight, off_px=2.9), truth)["recalled"]
    assert not judged(detection(truth, straight, off_px=3.5), truth)["recalled"]


def test_a_dock_that_is_a_twentieth_off_is_wrong(truth: Truth) -> None:
    straight = np.arange(4)
    near, far = (judged(detection(truth, straight, farther=f), truth) for f in (1.04, 1.06))
    assert near["recalled"] and not near["wrong"]
    assert far["wrong"] and not far["recalled"]


def test_any_dock_is_wrong_where_there_is_none(truth: Truth) -> None:
    seen = detection(truth, np.arange(4))
    nothing = replace(truth, dock=None, pixels=np.empty((0, 2)))
    assert judged(seen, nothing)["wrong"] and not judged(seen, nothing)["recalled"]


def test_a_found_place_is_of_one_marker_only() -> None:
    true = np.array([(0.0, 0.0), (10.0, 0.0), (20.0, 0.0)])
    own = matched(true, np.array([(9.0, 0.0), (1.0, 0.0)]))
    assert own[0].tolist() == [1.0, 0.0] and own[1].tolist() == [9.0, 0.0]
    assert np.isnan(own[2]).all()


def test_tables_count_by_distance_and_by_factor() -> None:
    scenes = [draw(i, 1, Backdrops(), distance="2" if i % 2 else "4") for i in range(30)]
    came = {"found": True, "evidence": 4.0, "total_ms": 9.0, "standing_out": True, "wrong": False}
    rows = [s.factors() | came | {"recalled": s.build == "lamps"} for s in scenes]
    lines = list(by_distance(rows))
    assert [line.split()[:3] for line in lines[1:3]] == [["2", "m", "15"], ["4", "m", "15"]]
    lamps = str(sum(s.build == "lamps" for s in scenes))
    assert ["lamps", lamps, "1.000", "1.000", "0"] in [line.split() for line in by_factors(rows)]


def test_bars_without_light_do_not_stand_out_as_lamps() -> None:
    """White bars before the dark shine at the lamps' places, with lamps and without."""
    factors = {"camera": "vga", "dock": "square", "build": "white bars", "distance": "1.5"}
    scene = draw(3, 1, Backdrops(), **factors)
    (lit, truth), (dark, _) = render(scene), render(replace(scene, radiance=0.0))
    assert standing_out(lit, truth.camera, truth.pixels, 120.0)
    assert standing_out(lit, truth.camera, truth.pixels, 120.0, dark)
    assert standing_out(dark, truth.camera, truth.pixels, 120.0)
    assert not standing_out(dark, truth.camera, truth.pixels, 120.0, dark)
