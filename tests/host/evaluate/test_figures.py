"""Figures of an evaluation, against the made-up rows they are drawn from."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from evaluation_data import FILTERS, rows_of, write_evaluation
from matplotlib.axes import Axes
from matplotlib.colors import to_hex

from chromadock.choices import MAPPINGS
from chromadock.evaluate import figures, filters, style
from chromadock.evaluate.frames import Evaluation

MAX_SVG_BYTES = 300_000


@pytest.fixture(scope="module")
def evaluation(tmp_path_factory: pytest.TempPathFactory) -> Evaluation:
    folder = tmp_path_factory.mktemp("evaluation")
    write_evaluation(folder)
    return Evaluation.read(folder)


def lines_in(axes: Axes, name: str) -> list[np.ndarray]:
    """What is drawn in a filter's colour."""
    colour = style.LOOKS[name].colour.lower()
    return [np.array(x.get_xydata()) for x in axes.lines if to_hex(x.get_color()) == colour]


@pytest.mark.parametrize("name", FILTERS)
def test_each_filter_has_its_own_recall_in_its_own_colour(
    evaluation: Evaluation, name: str
) -> None:
    figure = figures.recall_by_distance(evaluation.still)
    axes = next(a for a in figure.axes if "complement" in a.get_title(loc="left"))
    (line,) = lines_in(axes, name)
    for x, y in line:
        rows = rows_of(
            evaluation.still,
            run=f"pool {x:g} m complement",
            filter=name,
            markers_in_view=True,
        )
        assert y == pytest.approx(100 * sum(r["correct"] for r in rows) / len(rows))


def test_boxes_stand_at_the_shares_of_their_run(evaluation: Evaluation) -> None:
    figure = figures.passed_box_plot(evaluation.still)
    lake, pool, *_ = figure.axes
    assert lake.get_yscale() == "log"
    assert [label.get_text() for label in lake.get_xticklabels()] == [*"NESW"] * 3
    assert [label.get_text() for label in pool.get_xticklabels()] == ["1 m", "3 m", "5 m"] * 2
    rows = rows_of(evaluation.still, run="pool 5 m ternary", filter="static lake")
    quartiles = np.percentile([r["passed"] for r in rows], [25, 75])
    (box,) = [
        patch
        for patch in pool.patches
        if to_hex(patch.get_facecolor()) == style.LOOKS["static lake"].colour.lower()
        and round(np.mean(patch.get_path().vertices[:4, 0])) == 2
    ]
    ys = box.get_path().vertices[:, 1]
    assert [ys.min(), ys.max()] == pytest.approx(quartiles)


def test_frames_without_any_pixel_have_a_place_on_the_logarithmic_axis(
    evaluation: Evaluation,
) -> None:
    nothing = evaluation.still.with_columns(passed=pl.lit(0.0))
    axes = figures.passed_box_plot(nothing).axes[0]
    tick = axes.get_yticks()[0]
    assert axes.get_yticklabels()[0].get_text() == "none"
    assert axes.get_ylim()[0] < tick
    assert all(y == tick for line in lines_in(axes, "intensity") for y in line[:, 1])


def test_the_same_data_give_the_same_small_svg(evaluation: Evaluation) -> None:
    first, second = (
        [
            style.svg(figures.passed_box_plot(evaluation.still), "passed"),
            style.svg(figures.sweep_plot(evaluation.sweeps[0]), "sweep"),
        ]
        for _ in range(2)
    )
    assert first == second
    assert all(text.startswith("<svg") and "dc:date" not in text for text in first)
    assert len(first[0].encode()) < MAX_SVG_BYTES


def test_many_settings_without_numbers_stand_upright_also_where_none_has_a_hue(
    evaluation: Evaluation,
) -> None:
    few, many = evaluation.sweeps[1:3]
    turned = [
        {label.get_rotation() for label in figures.sweep_plot(sweep).axes[1].get_xticklabels()}
        for sweep in (few, many)
    ]
    assert turned == [{0.0}, {90.0}]
    hueless = many.frames.with_columns(hue_disagreement_deg=pl.lit(None, pl.Float64))
    names = figures.sweep_plot(replace(many, frames=hueless)).axes[1].get_xticklabels()
    assert [name.get_text() for name in names][:2] == ["quay, noon", "pond, noon"]


def test_long_names_of_settings_have_their_room(evaluation: Evaluation) -> None:
    """Where there is none, matplotlib warns, and cuts them off."""
    many = evaluation.sweeps[2]
    long = many.frames.with_columns(condition=pl.col("condition") + pl.lit(" and long" * 7))
    figure = figures.sweep_plot(replace(many, frames=long))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        style.svg(figure, "sweep")
    names = [label.get_window_extent() for label in figure.axes[1].get_xticklabels()]
    assert all(figure.bbox.y0 <= name.y0 for name in names)


def test_marks_of_filters_are_about_their_place(evaluation: Evaluation) -> None:
    """One alone is at it."""
    sweep = evaluation.sweeps[0]
    alone = sweep.frames.filter(pl.col("filter") == filters.FILTERS[0])
    drawn = figures.sweep_plot(replace(sweep, frames=alone)).axes[1]
    (line,) = [each for each in drawn.lines if each.get_marker() == style.LOOKS["robust"].mark]
    x, y = line.get_data(orig=False)
    at = line.get_transform().transform((x[0], y[0]))
    assert at == pytest.approx(drawn.transData.transform((x[0], y[0])))


def test_all_filters_have_a_colour_a_mark_and_a_label() -> None:
    assert tuple(style.LOOKS) == filters.FILTERS
    assert set(style.MAPPING_LOOKS) == set(MAPPINGS)
    for looks in (style.LOOKS, style.MAPPING_LOOKS):
        for key in ("colour", "mark", "label", "place"):
            assert len({getattr(look, key) for look in looks.values()}) == len(looks)
