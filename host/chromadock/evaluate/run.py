"""An evaluation from runs to tables: what is there is kept, the rest is worked on."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import polars as pl
from distributed import Client, Future, as_completed

from chromadock.errors import ChromadockError
from chromadock.evaluate import provenance, rows
from chromadock.evaluate.cluster import result_of
from chromadock.evaluate.plan import Chunk, planned, run_digest
from chromadock.evaluate.runs import Run
from chromadock.evaluate.store import Store, digest, make_folder, write_whole
from chromadock.evaluate.tuned import Tuned
from chromadock.evaluate.tuning_frames import tuned_filters, tuning_digest
from chromadock.evaluate.version import versions
from chromadock.evaluate.work import Measured, measured_chunk, simulated_steps
from chromadock.sim.simulation import Step

PARTS = "parts"
TUNED = "tuned.json"
GALLERY = "gallery"
TABLE = "frames"

Progress = Callable[[int, int], None]
"""Takes the numbers of frames that are done and of all."""


def evaluate(runs: Sequence[Run], out: Path, client: Client, progress: Progress) -> pl.DataFrame:
    """Measure all frames of the runs; write the tables and the gallery into ``out``.

    ``frames.parquet`` and ``frames.csv`` have a row for each frame and filter (``rows``),
    ``gallery`` a sample of each run, ``tuned.json`` the static filters, ``evaluation.json``
    seeds, digests and versions.  Parts of an earlier evaluation of the same runs by the same
    code are taken as they are.

    Raises
    ------
    ChromadockError
        Where a worker meets a fault of the user's, the workers are lost, or a file cannot be
        written.
    """
    make_folder(out)
    store = Store(out / PARTS)
    tuned = _tuned(out / TUNED, client)
    chunks = planned(runs, tuned)
    missing = [chunk for chunk in chunks if store.read(chunk.key) is None]
    total = sum(chunk.frames for chunk in chunks)
    done = total - sum(chunk.frames for chunk in missing)
    progress(done, total)
    for chunk, (found, files) in _worked(client, missing, tuned):
        store.write(chunk.key, rows.part(found, files))
        done += chunk.frames
        progress(done, total)
    table = _collected(out, store, chunks)
    write_whole(out / provenance.FILE, _provenance(runs).model_dump_json(indent=1).encode())
    store.keep_only(chunk.key for chunk in chunks)
    return table


def _tuned(path: Path, client: Client) -> Tuned:
    """The static filters: those that are there if they are of this code, else made anew."""
    key = tuning_digest()
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        if content["digest"] == key:
            return Tuned.from_dict(content)
    except (OSError, ValueError, KeyError, TypeError):
        pass
    tuned: Tuned = result_of(client.submit(tuned_filters, key=f"tuned-{key}"))
    content = {"digest": key, **tuned.to_dict()}
    write_whole(path, json.dumps(content, indent=1).encode())
    return tuned


def _worked(
    client: Client, chunks: Sequence[Chunk], tuned: Tuned
) -> Iterator[tuple[Chunk, Measured]]:
    """The chunks with their results, as they get done.

    A chunk whose worker dies is done again by another one.  Chunks of one run share its
    steps; a run whose chunks are all there is not simulated at all.
    """
    steps: dict[int, Future[list[Step]]] = {}
    chunk_of: dict[Future[Measured], Chunk] = {}
    for order, chunk in enumerate(chunks):
        run = chunk.run
        if id(run) not in steps:
            key = f"steps-{chunk.key}"
            steps[id(run)] = client.submit(simulated_steps, run, key=key, priority=-order)
        future = client.submit(
            measured_chunk, chunk, steps[id(run)], tuned, key=f"chunk-{chunk.key}", priority=-order
        )
        chunk_of[future] = chunk
    steps.clear()  # the scheduler drops those that no chunk waits for
    for future in as_completed(chunk_of):  # type: ignore[no-untyped-call]
        result = result_of(future)
        yield chunk_of.pop(future), result


def _collected(out: Path, store: Store, chunks: Sequence[Chunk]) -> pl.DataFrame:
    """Write the tables and the gallery from the parts."""
    parts = [(store.read(chunk.key), chunk) for chunk in chunks]
    found = []
    for part, chunk in parts:
        if part is None:
            raise ChromadockError(f"{out / PARTS}: a part has gone: evaluate again")
        for name, content in rows.files_of(part).items():
            write_whole(out / GALLERY / name, content)
        found.append((part, chunk.run.varied))
    table = rows.merged(found)
    for suffix, write in ((".parquet", table.write_parquet), (".csv", table.write_csv)):
        buffer = io.BytesIO()
        write(buffer)
        write_whole(out / f"{TABLE}{suffix}", buffer.getvalue())
    return table


def _provenance(runs: Sequence[Run]) -> provenance.Provenance:
    """Where the tables come from."""
    experiments = {}
    for name in dict.fromkeys(run.experiment for run in runs):
        of_one = [run for run in runs if run.experiment == name]
        made_from = " ".join(run_digest(run) for run in of_one)
        experiments[name] = provenance.Origin(
            seed=of_one[0].scene.seed, digest=digest(made_from.encode())
        )
    return provenance.Provenance(experiments=experiments, versions=versions())
