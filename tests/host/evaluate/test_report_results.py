"""docs/results.md and its figures, written from made-up runs."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from itertools import groupby
from pathlib import Path

import polars as pl
import pytest
import results
import results_approach
import results_document
from evaluation_data import FILTERS, write_evaluation
from results_claims import Claim, claims
from results_document import Run, document, figures
from results_tables import mapping_study, realism, sweep_table

from chromadock import ChromadockError
from chromadock.evaluate import formats
from chromadock.evaluate.drawings import Drawing
from chromadock.evaluate.frames import Evaluation
from chromadock.evaluate.statistics import wilson

MAX_SVG_BYTES = 300_000


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("evaluation")
    write_evaluation(folder, frames=24)
    return folder


@pytest.fixture(scope="module")
def run(out: Path) -> Run:
    return Run.read(out)


@pytest.fixture(scope="module")
def shown(run: Run) -> dict[str, Drawing]:
    return figures(run)


@pytest.fixture(scope="module")
def docs(run: Run, shown: dict[str, Drawing], tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("docs")
    (folder / "images").mkdir()
    (folder / "images" / "results-of-yesterday.svg").touch()
    (folder / "images" / "wiring.svg").touch()
    results.write(folder, document(run, shown), shown)
    return folder


def nearest(out: Path, folder: Path) -> Path:
    """A copy of the evaluation with the frames at 1 m alone, which are soon drawn."""
    copy = Path(shutil.copytree(out, folder / "out"))
    frames = pl.read_parquet(out / "frames.parquet")
    frames.filter(pl.col("distance_m") == 1).write_parquet(copy / "frames.parquet")
    return copy


def test_approaches_have_their_section_and_figure_where_they_were_run(
    out: Path, docs: Path, tmp_path: Path
) -> None:
    assert "## Approach" not in (docs / "results.md").read_text()
    copy = nearest(out, tmp_path)
    rows = [
        {
            "scene": "pool", "scenario": "nothing else", "time_s": 0.1 * k, "range_m": 8 - 0.1 * k,
            "markers_seen": 4, "contrast": 0.5, "frame_state": "found", "state": "tracking",
            "measured": True, "marker_px": 0.5, "place_m": 0.02, "attitude_deg": 2.0,
            "within_95": True,
        }
        for k in range(30)
    ]  # fmt: skip
    pl.DataFrame(rows).write_parquet(copy / results_approach.ROWS)
    again = Run.read(copy)
    drawn = figures(again)
    text = document(again, drawn)
    assert text.count("## Approach") == 1
    assert "| pool | nothing else | 0.0 s, 8.00 m | 0.0 s, 8.00 m | 100 % |" in text
    assert "approach" in drawn
    assert text.index("## Approach") < text.index("## Is the renderer")


def of(out: Path, experiment: str) -> pl.DataFrame:
    return Evaluation.read(out).frames.filter(pl.col("experiment") == experiment)


def test_every_figure_that_is_named_is_there_and_small_and_no_other(docs: Path) -> None:
    named = re.findall(r"!\[[^\]]*\]\(images/([^)]*)\)", (docs / "results.md").read_text())
    assert len(named) == len(set(named)) == 9
    there = {path.name for path in (docs / "images").iterdir()}
    assert there == {*named, "wiring.svg"}
    for name in named:
        svg = (docs / "images" / name).read_bytes()
        assert svg.startswith(b"<svg") and len(svg) < MAX_SVG_BYTES


def test_the_document_says_that_it_is_simulated_and_by_what(docs: Path) -> None:
    text = (docs / "results.md").read_text()
    assert "**All of this is simulated.**" in text
    captions = [line for line in text.splitlines() if line.startswith("*") and "**" not in line]
    assert len(captions) == 9
    assert all(line.startswith("*Simulated.") for line in captions)
    assert "| lake | 12 | 288 | 7 | `0123456789abcdef` |" in text
    assert "chromadock 0.1.0, jerlov 0.22.0." in text
    assert str(Path.cwd()) not in text and "/tmp" not in text


def test_tables_are_tables(docs: Path) -> None:
    lines = (docs / "results.md").read_text().splitlines()
    tables = [list(t) for bar, t in groupby(lines, lambda line: line.startswith("|")) if bar]
    assert len(tables) == 12
    for table in tables:
        assert len(table) > 2
        assert set(table[1]) == {"|", "-"}
        assert len({line.count("|") for line in table}) == 1


def test_the_recall_in_the_table_is_that_of_the_frames(out: Path, docs: Path) -> None:
    rows = of(out, "pool").filter(
        (pl.col("mapping") == "ternary") & (pl.col("distance_m") == 5) & pl.col("markers_in_view")
    )
    (line,) = [
        line
        for line in (docs / "results.md").read_text().splitlines()
        if line.startswith("| pool, ternary, 5 m |") and line.count("%") == 6
    ]
    for name, cell in zip(
        FILTERS,
        line.split("|")[2:],
        strict=False,
    ):
        correct = rows.filter(pl.col("filter") == name)["correct"]
        share = 100 * correct.sum() / len(correct)
        assert cell.split()[0] == formats.number(share)
        low, high = (100 * end for end in wilson(correct.sum(), len(correct)))
        shown = [float(end) for end in re.findall(r"\((.*)–(.*)\)", cell)[0]]
        assert shown[0] <= low + 0.5 and shown[1] >= high - 0.5


def test_rendered_water_is_compared_with_photographs_from_one_to_three_metres(out: Path) -> None:
    frames = of(out, "rendered water")
    easy = frames.with_columns(correct=pl.lit(True))
    hard = frames.with_columns(correct=pl.col("distance_m") < 2)
    same = realism(easy, easy)
    assert same.within and same.telling and same.worst_points == 0
    apart = realism(easy, hard)
    assert not apart.within and apart.worst_points == 100
    never = frames.with_columns(correct=pl.lit(False))
    assert realism(never, never).within and not realism(never, never).telling
    far = hard.with_columns(distance_m=pl.col("distance_m") * 2)
    assert realism(easy.with_columns(distance_m=pl.col("distance_m") * 2), far).worst_points == 0
    assert realism(easy, frames.clear()) is None


def test_without_photographs_the_document_says_so(out: Path, tmp_path: Path) -> None:
    copy = nearest(out, tmp_path)
    table = pl.read_parquet(copy / "frames.parquet")
    table.filter(pl.col("experiment").is_in(["lake", "pool"])).write_parquet(
        copy / "frames.parquet"
    )
    run = Run.read(copy)
    text = document(run, figures(run))
    assert "Not run: there were no photographs" in text
    assert "Beyond the paper" not in text
    table.filter(pl.col("experiment") == "lake").write_parquet(copy / "frames.parquet")
    with pytest.raises(ChromadockError, match="not the experiments lake and pool"):
        Run.read(copy)


def test_a_sweep_tells_where_the_dock_is_lost(out: Path) -> None:
    tint = Evaluation.read(out).sweeps[0]
    key = tint.keys[0]
    frames = tint.frames.with_columns(correct=pl.col(key).is_between(0.8, 1.2))
    table = sweep_table(type(tint)(tint.experiment, tint.keys, frames))
    assert set(table.verdicts) == set(FILTERS)
    assert all(v.found and v.lost == ["0.7", "1.3"] for v in table.verdicts.values())
    assert [row.setting for row in table.rows] == [["0.7"], ["0.85"], ["1"], ["1.15"], ["1.3"]]


def swapped(frames: pl.DataFrame, one: str, other: str) -> pl.DataFrame:
    """As if two filters had each other's results."""
    return frames.with_columns(pl.col("filter").replace({one: other, other: one}))


def agreed(found: list[Claim]) -> dict[str, bool]:
    return {claim.name: claim.agrees for claim in found}


def test_claims_are_judged_by_the_frames(out: Path) -> None:
    lake, pool = of(out, "lake"), of(out, "pool")
    found = agreed(claims(lake, pool))
    # These frames are made so that the dock is found at 3 m and tuned filters pass least.
    assert {name for name, agrees in found.items() if not agrees} == {"reach-lake", "selective"}

    ternary, static, other = "adaptive ternary", "static pool", "static lake"
    assert not agreed(claims(swapped(lake, ternary, static), pool))["static-lake"]
    assert not agreed(claims(lake, swapped(pool, ternary, other)))["static-pool"]
    assert not agreed(claims(lake, swapped(pool, ternary, "adaptive complement")))["complement"]
    assert not agreed(claims(swapped(lake, static, other), pool))["tuned"]
    apart = pool.with_columns(hue_disagreement_deg=pl.lit(30.0))
    assert not agreed(claims(lake, apart))["agreement"]
    blind = pool.with_columns(correct=pl.lit(False))
    assert not agreed(claims(lake, blind))["reach-pool"]
    noisy = pool.with_columns(passed=pl.lit(0.5))
    assert not agreed(claims(lake, noisy))["nothing"]
    near = lake.with_columns(correct=pl.col("distance_m") < 2, passed=pl.lit(0.0))
    assert agreed(claims(near, pool))["reach-lake"]
    assert agreed(claims(near, pool))["selective"] is False
    clean = pool.with_columns(
        passed=pl.when(pl.col("filter") == ternary).then(0.0).otherwise(pl.col("passed"))
    )
    assert agreed(claims(near, clean))["selective"]


def test_every_disagreement_is_explained(
    run: Run, shown: dict[str, Drawing], monkeypatch: pytest.MonkeyPatch
) -> None:
    wrong = [replace(claim, agrees=False) for claim in claims(run.of("lake"), run.of("pool"))]
    monkeypatch.setattr(results_document, "claims", lambda *_: wrong)
    lines = document(run, shown).splitlines()
    for claim in wrong:
        (explained,) = [line for line in lines if line.startswith(f"**{claim.paper}**")]
        assert len(explained) > len(claim.paper) + 40


def test_a_study_tells_where_contrast_is_better_and_where_it_is_not(out: Path, docs: Path) -> None:
    (hues,) = Evaluation.read(out).studies
    study = mapping_study(hues)
    assert study.farther == ["brown at 7 m"] and study.nearer == ["green at 3 m"]
    assert [(row.setting, row.distance_m) for row in study.rows] == [
        ("brown", 3.0),
        ("brown", 7.0),
        ("green", 3.0),
        ("green", 7.0),
    ]
    brown = study.rows[1].recall
    assert brown["contrast"].value > 0.5 > brown["ternary"].value
    text = (docs / "results.md").read_text()
    assert "## Which mapping sees farther" in text


def test_what_the_text_says_of_mappings_follows_the_frames(
    run: Run, shown: dict[str, Drawing]
) -> None:
    frames = run.evaluation.studies[0].frames
    same = frames.with_columns(correct=pl.lit(True))
    evaluation = replace(run.evaluation, studies=[replace(run.evaluation.studies[0], frames=same)])
    alike = replace(run, evaluation=evaluation)
    text = document(alike, shown)
    assert "nowhere here more often than ternary by more than chance" in text
    assert "nowhere here less often by more than chance" in text


def test_conditions_have_a_table_for_each_water_and_no_figure(
    run: Run, shown: dict[str, Drawing], docs: Path
) -> None:
    text = (docs / "results.md").read_text()
    section = text.partition("## Conditions")[2].partition("\n## ")[0]
    assert section.count("| condition |") == 2
    assert "### Quay" in section and "### Pond" in section
    rows = [line for line in section.splitlines() if line.startswith("| n")]
    assert [row.split(" | ")[0] for row in rows] == ["| noon", "| night"] * 2
    for noon, night in zip(rows[::2], rows[1::2], strict=True):
        cells = [[cell.split(" (")[0] for cell in row.split(" | ")[1:5]] for row in (noon, night)]
        assert cells == [["100 %", "100 %", "0 %", "0 %"], ["100 %", "0 %", "0 %", "50 %"]]
    (white, *_) = [line for line in section.splitlines() if line.startswith("| white lamps")]
    assert white.endswith(" – | – |")
    assert section.count("as in the first row: night, at 4 m.") == 2
    assert section.count("Wrong poses: night, at 4 m.") == 2
    assert not any("condition" in name for name in shown)
    assert "### Conditions" not in text


def test_where_all_goes_well_the_conditions_say_so(run: Run) -> None:
    (study,) = (sweep for sweep in run.evaluation.sweeps if sweep.experiment == "conditions")
    fine = study.frames.with_columns(correct=pl.lit(True), wrong_pose=pl.lit(False))
    evaluation = replace(run.evaluation, sweeps=[replace(study, frames=fine)])
    well = replace(run, evaluation=evaluation)
    text = document(well, figures(well))
    assert text.count("Found nowhere here less than half as often") == 2
    assert text.count("No wrong pose.") == 2


def test_the_tuning_is_shown(docs: Path) -> None:
    assert "| pool | 119–214 | 20–65 | 127–255 | 0.65 |" in (docs / "results.md").read_text()


def test_a_run_that_fails_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    experiments = tmp_path / "experiments"
    experiments.mkdir()
    (experiments / "bad.toml").write_text('name = "bad"\nsurprise = 1\n')
    monkeypatch.setattr(results, "EXPERIMENTS", experiments)
    monkeypatch.setattr(results, "OUT", tmp_path / "out")
    monkeypatch.setattr(results, "DOCS", tmp_path / "docs")
    assert results.main() == 2
    assert not (tmp_path / "docs").exists()
    assert not capsys.readouterr().out
