"""Tables, figures and page of an evaluation, against the made-up rows they are drawn from."""

from __future__ import annotations

import json
import re
import shutil
import statistics
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from evaluation_data import FILTERS, PIXELS, rows_of, write_evaluation

from chromadock import ChromadockError
from chromadock.evaluate import formats
from chromadock.evaluate.frames import Evaluation
from chromadock.evaluate.report import write_report
from chromadock.evaluate.summary import Estimate, cells, hue_disagreement, pixel_ratio, share
from chromadock.evaluate.tables import places, ternary_against

MAX_SVG_BYTES = 300_000
FRAMES = 24


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("evaluation")
    write_evaluation(folder, frames=FRAMES)
    write_report(folder)
    return folder


@pytest.fixture(scope="module")
def evaluation(out: Path) -> Evaluation:
    return Evaluation.read(out)


@pytest.fixture
def copy(out: Path, tmp_path: Path) -> Path:
    """Of the evaluation, for tests that change it."""
    return Path(shutil.copytree(out, tmp_path / "copy"))


def test_a_cell_is_what_counting_by_hand_gives(evaluation: Evaluation) -> None:
    wanted = {"experiment": "lake", "distance_m": 3.0, "filter": "static pool"}
    rows = rows_of(evaluation.still, **wanted)
    lake = evaluation.still.filter((pl.col("experiment") == "lake") & (pl.col("distance_m") == 3))
    (cell,) = [cell for cell in cells(lake) if cell.filter == "static pool"]
    assert len(rows) == 4 * FRAMES
    assert cell.passed.value == statistics.median(r["passed"] for r in rows)
    assert cell.outside.value == statistics.median(r["passed_outside"] for r in rows)
    in_view = [r["correct"] for r in rows if r["markers_in_view"]]
    assert len(in_view) < len(rows)
    assert cell.recall.value == pytest.approx(sum(in_view) / len(in_view))
    assert cell.false_docks.value == pytest.approx(sum(r["false_dock"] for r in rows) / len(rows))
    errors = [abs(r["range_error"]) for r in rows if r["range_error"] is not None]
    assert 0 < len(errors) < len(rows)
    assert cell.range_error.value == pytest.approx(statistics.median(errors))
    for estimate in (cell.passed, cell.recall, cell.range_error, cell.attitude_error_deg):
        assert estimate.low < estimate.value < estimate.high


def test_frames_that_resemble_their_neighbours_make_a_wider_interval() -> None:
    def interval(correct: np.ndarray) -> Estimate:
        return share(
            pl.DataFrame(
                {
                    "experiment": "x",
                    "run": "x",
                    "time_s": np.arange(len(correct)) / 4,
                    "correct": correct,
                }
            ),
            "correct",
        )

    rng = np.random.default_rng(1)
    mixed = interval(rng.random(800) < 0.5)
    slow = interval(np.repeat(rng.random(20) < 0.5, 40))
    assert slow.high - slow.low > 2 * (mixed.high - mixed.low)
    assert mixed.high - mixed.low == pytest.approx(2 * 1.96 * 0.5 / np.sqrt(800), rel=0.35)


def pairs(static: list[int], ternary: list[int]) -> pl.DataFrame:
    """Frames of two filters by the pixels that each passes."""
    table = {"static lake": static, "adaptive ternary": ternary}
    return pl.DataFrame(
        [
            {
                "experiment": "pool",
                "run": "pool",
                "frame": frame,
                "time_s": float(frame),
                "filter": name,
                "passed": pixels / PIXELS,
            }
            for name, counts in table.items()
            for frame, pixels in enumerate(counts)
        ]
    )


def test_the_ratio_is_that_of_all_pixels_in_the_same_frames() -> None:
    pixels = pixel_ratio(pairs([300, 2000, 50], [10, 20, 50]), "static lake")
    assert pixels.ratio.value == pytest.approx(2350 / 80)
    assert pixels.static == pytest.approx(2350 / 3 / PIXELS)
    assert pixels.ternary == pytest.approx(80 / 3 / PIXELS)
    assert pixel_ratio(pairs([3], [0]), "static pool") is None


def test_the_ratios_interval_holds_the_true_one_as_often_as_it_says() -> None:
    """Log-normal shares with a true ratio of 20, in blocks of five frames."""
    rng = np.random.default_rng(3)
    held = 0
    for _ in range(60):
        static, ternary = (
            (scale * rng.lognormal(0, 0.5, 200)).astype(int).tolist() for scale in (20_000, 1000)
        )
        ends = pixel_ratio(pairs(static, ternary), "static lake").ratio
        held += ends.low < 20 < ends.high
    assert 0.85 * 60 < held < 60


def test_a_filter_that_passes_nothing_makes_no_nan() -> None:
    nothing = pixel_ratio(pairs([300] * 20, [0] * 20), "static lake").ratio
    assert formats.ratio(nothing) == "×∞ (∞–∞)"
    assert pixel_ratio(pairs([0] * 20, [0] * 20), "static lake").ratio.value == 1
    few = pixel_ratio(pairs([30, 30], [3, 3]), "static lake").ratio
    assert formats.ratio(few) == "×10 (0–∞)"


def test_static_filters_are_compared_in_the_water_they_are_not_tuned_to(
    evaluation: Evaluation,
) -> None:
    found = {each.title: each for each in ternary_against(evaluation.still)}
    assert found["lake, ternary"].static == "static pool"
    assert found["pool, complement"].static == "static lake"
    made = FILTERS["static pool"][0] / FILTERS["adaptive ternary"][0]
    assert found["lake, ternary"].pixels.ratio.value == pytest.approx(made, rel=0.15)
    rows = rows_of(
        evaluation.still, experiment="lake", filter="adaptive ternary", markers_in_view=True
    )
    recall = found["lake, ternary"].recall["adaptive ternary"].value
    assert recall == pytest.approx(sum(r["correct"] for r in rows) / len(rows))


def test_only_what_varies_beyond_the_place_is_a_sweep(evaluation: Evaluation) -> None:
    names = [(sweep.experiment, sweep.keys) for sweep in evaluation.sweeps]
    assert names == [
        ("tint", ("vehicle_camera.tint",)),
        ("balance", ("dock_camera.white_balance", "vehicle_camera.white_balance")),
        ("conditions", ("body of water", "condition")),
    ]
    still = {"lake", "pool", "photographs", "rendered water"}
    assert set(evaluation.still["experiment"].unique()) == still


def test_hues_are_counted_once_a_frame(evaluation: Evaluation) -> None:
    tint = evaluation.sweeps[0]
    found = {key: hue.value for (key,), hue in hue_disagreement(tint.frames, tint.keys)}
    for value, median in found.items():
        rows = rows_of(tint.frames, **{tint.keys[0]: value, "filter": "intensity"})
        assert median == statistics.median(r["hue_disagreement_deg"] for r in rows)
    assert found[0.7] > found[0.85] > found[1.0]


def test_words_have_two_digits() -> None:
    assert formats.percent(Estimate(0.00042, 0.0004, 0.00051)) == "0.042 % (0.040–0.051)"
    assert formats.degrees(Estimate(3.04, 2.0, 16.4)) == "3.0° (2.0–16)"
    assert formats.percent(Estimate(0, 0, 0.1)) == "0 % (0–10)"
    assert formats.percent(None) == "–"
    assert formats.times(1234.4) == "×1234"
    assert [formats.number(x) for x in (0.996, 9.96, 99.6, -0.5)] == ["1.0", "10", "100", "-0.50"]


def test_the_page_needs_nothing_but_itself(out: Path) -> None:
    page = (out / "report.html").read_text()
    assert "<script" not in page
    references = re.findall(r'(?:src|href)="([^"]*)"', page)
    outside = [r for r in references if not r.startswith(("data:image/", "#"))]
    assert not outside
    addresses = set(re.findall(r"https?://[^\s\"<]*", page))
    # Names of formats, which nothing fetches.
    assert addresses <= {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}


def test_the_page_says_of_every_figure_what_it_is(out: Path, evaluation: Evaluation) -> None:
    page = (out / "report.html").read_text()
    captions = re.findall(r"<figcaption>(.*?)</figcaption>", page, re.DOTALL)
    assert len(captions) == page.count("<figure ") == 5 + 3 + 1
    for caption in captions:
        assert "SIMULATED" in caption
        assert "seed 7, digest 0123456789abcdef" in caption
        assert "jerlov 0.22.0" in caption
        assert re.search(r"\d runs, [\d,]+ frames", caption)
    for run in evaluation.still["run"].unique():
        assert f"<h3>{run}</h3>" in page
    for place in places(evaluation.still):
        for cell in place.cells:
            assert formats.percent(cell.recall) in page


def test_names_cannot_bring_markup_into_the_page(copy: Path) -> None:
    frames = pl.read_parquet(copy / "frames.parquet").filter(pl.col("frame") < 3)
    evil = pl.lit("<b>evil&amp;</b>").alias("experiment")
    frames.filter(pl.col("experiment") == "photographs").with_columns(evil).write_parquet(
        copy / "frames.parquet"
    )
    origin = {"experiments": {"<b>evil&amp;</b>": {"seed": 1, "digest": "0"}}, "versions": {}}
    (copy / "evaluation.json").write_text(json.dumps(origin))
    page = write_report(copy).read_text()
    assert "<b>evil" not in page
    assert "&lt;b&gt;evil&amp;amp;&lt;/b&gt;" in page


@pytest.mark.parametrize("experiments", [["photographs"], ["tint"], ["photographs", "balance"]])
def test_parts_of_an_evaluation_make_a_page_too(copy: Path, experiments: list[str]) -> None:
    frames = pl.read_parquet(copy / "frames.parquet").filter(pl.col("frame") < 3)
    part = frames.filter(pl.col("experiment").is_in(experiments))
    part.write_parquet(copy / "frames.parquet")
    assert "<figure" in write_report(copy).read_text()


def test_a_dock_that_is_never_found_makes_a_page_too(copy: Path) -> None:
    frames = pl.read_parquet(copy / "frames.parquet").filter(pl.col("frame") < 3)
    frames = frames.filter(pl.col("experiment").is_in(["photographs", "balance"]))
    errors = ("range_error", "bearing_error_deg", "attitude_error_deg")
    frames.with_columns(
        pl.lit(False).alias("correct"), *(pl.lit(None, pl.Float64).alias(e) for e in errors)
    ).write_parquet(copy / "frames.parquet")
    assert "<td>–</td>" in write_report(copy).read_text()


def damage_nothing_left(out: Path) -> None:
    (out / "frames.parquet").unlink()


def damage_truncated(out: Path) -> None:
    whole = (out / "frames.parquet").read_bytes()
    (out / "frames.parquet").write_bytes(whole[: len(whole) // 2])


def damage_other_table(out: Path) -> None:
    pl.DataFrame({"a": [1]}).write_parquet(out / "frames.parquet")


def damage_no_rows(out: Path) -> None:
    pl.read_parquet(out / "frames.parquet").clear().write_parquet(out / "frames.parquet")


def damage_picture(out: Path) -> None:
    (out / "gallery" / "lake 1 m N.jpg").write_bytes(b"no picture")


def damage_mask(out: Path) -> None:
    (out / "gallery" / "lake 1 m N.static pool.png").unlink()


def damage_swatches(out: Path) -> None:
    (out / "gallery" / "lake 1 m N.json").write_text('{"vehicle": {"background": [1, 2]}}')


def damage_origin(out: Path) -> None:
    (out / "evaluation.json").write_text("{}")


@pytest.mark.parametrize(
    ("damage", "file"),
    [
        (damage_nothing_left, "frames.parquet"),
        (damage_truncated, "frames.parquet"),
        (damage_other_table, "frames.parquet"),
        (damage_no_rows, "frames.parquet"),
        (damage_picture, "lake 1 m N.jpg"),
        (damage_mask, "lake 1 m N.static pool.png"),
        (damage_swatches, "lake 1 m N.json"),
        (damage_origin, "evaluation.json"),
    ],
)
def test_what_is_missing_or_broken_is_named_in_one_line(
    copy: Path, damage: object, file: str
) -> None:
    (copy / "report.html").write_text("the old page")
    damage(copy)
    with pytest.raises(ChromadockError) as caught:
        write_report(copy)
    assert file in str(caught.value)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 300
    assert (copy / "report.html").read_text() == "the old page"
    assert not list(copy.glob(".*"))
