"""Small evaluations from end to end: chunks, two workers, one of which is killed, resuming."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import polars as pl
import pytest
from distributed import Client
from small_experiment import CONTENT, TUNED, leave_tuned, runs

from chromadock.errors import ChromadockError
from chromadock.evaluate import plan, rows
from chromadock.evaluate.cluster import local_cluster
from chromadock.evaluate.plan import planned, warm_up_frames
from chromadock.evaluate.run import evaluate
from chromadock.evaluate.runs import Run
from chromadock.evaluate.work import measured_chunk, simulated_steps


@pytest.fixture(autouse=True)
def _small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "CHUNK_FRAMES", 6)
    monkeypatch.setattr(plan, "_WARM_UPS", 0)


@pytest.fixture
def out(tmp_path: Path) -> Path:
    """An output folder whose static filters are there already: tuning takes a while."""
    folder = tmp_path / "out"
    folder.mkdir()
    leave_tuned(folder)
    return folder


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with local_cluster(2) as two_workers:
        yield two_workers


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> pl.DataFrame:
    """The table of both runs, unbroken and in this process."""
    folder = tmp_path_factory.mktemp("expected")
    return pl.concat([unbroken(run) for run in runs(folder)])


def unbroken(run: Run) -> pl.DataFrame:
    whole = plan.Chunk(run, 0, run.frames, None, "")
    found, _ = measured_chunk(whole, simulated_steps(run), TUNED)
    return rows.merged([(rows.part(found, {}), run.varied)])


def test_chunks_are_the_unbroken_run_frame_by_frame(tmp_path: Path, expected: Any) -> None:
    run = runs(tmp_path)[0]
    steps = simulated_steps(run)
    chunks = planned([run], TUNED)
    assert [(c.first, c.end) for c in chunks] == [
        (0, 6),
        (6, 12),
        (12, 18),
        (18, 24),
        (24, 26),
    ]
    parts = [(rows.part(*measured_chunk(c, steps, TUNED)), run.varied) for c in chunks[1:3]]
    assert same(rows.merged(parts), expected.filter(pl.col("run") == run.name)[12:36])


def test_without_its_warm_up_a_chunk_is_not(
    tmp_path: Path, expected: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = runs(tmp_path)[0]
    chunk = planned([run], TUNED)[2]
    monkeypatch.setattr(plan, "warm_up_frames", lambda rate_hz: 0)
    found, _ = measured_chunk(chunk, simulated_steps(run), TUNED)
    cold = [row["vehicle_hue_deg"] for row in found]
    of_run = expected.filter(pl.col("run") == run.name)
    assert cold != of_run["vehicle_hue_deg"][24:36].to_list()


@pytest.mark.parametrize(("rate_hz", "frames"), [(4.0, 8), (4.175, 9), (12.5, 25), (0.2, 1)])
def test_the_warm_up_has_all_decisions_of_two_seconds(rate_hz: float, frames: int) -> None:
    assert warm_up_frames(rate_hz) == frames
    assert frames / rate_hz >= 2.0


def same(a: pl.DataFrame, b: pl.DataFrame) -> bool:
    order = ["run", "frame", "filter"]
    return a.sort(order).equals(b.select(a.columns).sort(order))


def test_a_killed_worker_loses_nothing(
    tmp_path: Path, out: Path, client: Client, expected: pl.DataFrame
) -> None:
    """One of two workers dies in the middle; all rows are those of the undisturbed run."""
    victim, killed = next(iter(client.run(os.getpid).values())), []

    def kill(done: int, total: int) -> None:
        if 0 < done < total and not killed:
            assert client.processing()  # it is at work
            os.kill(victim, signal.SIGKILL)
            killed.append(done)

    table = evaluate(runs(tmp_path), out, client, kill)
    assert killed
    assert victim not in client.run(os.getpid).values()
    assert same(table, expected)
    assert same(pl.read_parquet(out / "frames.parquet"), expected)
    assert pl.read_csv(out / "frames.csv").height == expected.height == 2 * 26 * 2


def test_an_evaluation_goes_on_where_it_was_and_makes_damaged_and_stale_parts_anew(
    tmp_path: Path, out: Path, client: Client, expected: pl.DataFrame
) -> None:
    evaluate(runs(tmp_path), out, client, lambda done, total: None)
    parts = sorted((out / "parts").iterdir())
    assert len(parts) == 10
    parts[0].unlink()
    parts[1].write_bytes(parts[1].read_bytes()[:-100])
    told: list[tuple[int, int]] = []
    table = evaluate(runs(tmp_path), out, client, lambda *counts: told.append(counts))
    assert told[0][1] == told[-1][0] == 52
    assert 52 - 12 <= told[0][0] < 52
    assert len(told) == 3
    assert same(table, expected)

    told.clear()
    evaluate(runs(tmp_path), out, NOBODY, lambda *counts: told.append(counts))
    assert told == [(52, 52)]  # all there: no worker is asked

    other_water = CONTENT.replace("transmittance = 0.3", "transmittance = 0.4")
    told.clear()
    stale = evaluate(runs(tmp_path, other_water), out, client, lambda *counts: told.append(counts))
    assert told[0] == (0, 52)
    assert not same(stale, expected)
    assert len(list((out / "parts").iterdir())) == 10


class _Nobody:
    def __getattr__(self, name: str) -> Any:
        raise AssertionError(f"asked to {name}")


NOBODY: Any = _Nobody()


def test_an_interrupted_evaluation_keeps_what_is_done(
    tmp_path: Path, out: Path, client: Client, expected: pl.DataFrame
) -> None:
    def interrupt(done: int, total: int) -> None:
        if done > 15:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        evaluate(runs(tmp_path), out, client, interrupt)
    assert not (out / "frames.parquet").exists()
    told: list[tuple[int, int]] = []
    table = evaluate(runs(tmp_path), out, client, lambda *counts: told.append(counts))
    assert told[0][0] > 15
    assert same(table, expected)


def test_the_gallery_has_a_sample_of_every_run(tmp_path: Path, out: Path, client: Client) -> None:
    of_experiment = runs(tmp_path)
    evaluate(of_experiment, out, client, lambda done, total: None)
    names = {path.name for path in (out / "gallery").iterdir()}
    assert names == {
        f"{run.name}{end}"
        for run in of_experiment
        for end in (".jpg", ".json", ".adaptive ternary.png", ".static lake.png")
    }
    swatches = json.loads((out / "gallery" / f"{of_experiment[0].name}.json").read_text())
    for side in ("vehicle", "dock"):
        red, _, blue = swatches[side]["background"]
        assert blue > red
        assert max(swatches[side]["pure"]) == 255
        assert min(swatches[side]["marker"]) == 0


def test_a_fault_of_the_users_in_a_worker_is_one_line(
    tmp_path: Path, out: Path, client: Client
) -> None:
    photographs = tmp_path / "photos"
    photographs.mkdir()
    (photographs / "broken.jpg").write_bytes(b"no picture")
    content = CONTENT.replace("seed = 7", 'seed = 7\nphotographs = "photos"')
    with pytest.raises(ChromadockError, match=r"broken\.jpg"):
        evaluate(runs(tmp_path, content), out, client, lambda done, total: None)
