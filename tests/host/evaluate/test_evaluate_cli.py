"""``chromadock evaluate`` as the user runs it: in a process of its own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import polars as pl
import pytest
from distributed import LocalCluster
from patience import PATIENCE_S
from small_experiment import CONTENT, leave_tuned, write

from chromadock.cli.evaluate import evaluate as command
from chromadock.errors import ChromadockError
from chromadock.evaluate import cluster, version

COMMAND = [sys.executable, "-m", "chromadock", "evaluate"]


def evaluate(folder: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*COMMAND, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=300
    )


def test_an_evaluation_leaves_tables_gallery_and_report(tmp_path: Path) -> None:
    leave_tuned(tmp_path / "out")
    done = evaluate(tmp_path, write(tmp_path), "--out", "out", "--workers", 2, "--frames", 5)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert done.stdout == "2 runs, 10 frames, simulated: wrote out/report.html\n"
    table = pl.read_parquet(tmp_path / "out" / "frames.parquet")
    assert table.height == 2 * 5 * 2
    assert table["vehicle_camera.white_balance"].unique().sort().to_list() == ["auto", "daylight"]
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"frames.csv", "evaluation.json", "tuned.json", "gallery", "report.html"} <= names
    assert not [name for name in names if "partial" in name]


def test_ctrl_c_is_a_line_and_what_is_done_is_kept(tmp_path: Path) -> None:
    leave_tuned(tmp_path / "out")
    long = CONTENT.replace("frames = 26", "frames = 104").replace("rate_hz = 4.0", "rate_hz = 1.0")
    path = write(tmp_path, long)
    parts = tmp_path / "out" / "parts"
    process = subprocess.Popen(
        [*COMMAND, str(path), "--out", "out", "--workers", "1"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    wait_for(lambda: parts.is_dir() and any(parts.glob("[!.]*")))
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: the workers get it too
    _, told = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 130
    assert told == (
        "chromadock: interrupted: what is done is kept in out; "
        "the same command goes on from there\n"
    )
    assert not (tmp_path / "out" / "frames.parquet").exists()
    kept = set(parts.iterdir())
    assert kept
    assert all(not path.name.startswith(".") for path in kept)


def wait_for(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_a_slip_in_the_file_is_told_in_a_line(tmp_path: Path) -> None:
    path = write(tmp_path, CONTENT.replace("seed = 7", "seed = 7\nspeed = 3"))
    done = evaluate(tmp_path, path, "--out", "out")
    assert done.returncode == 2
    assert done.stderr == (f"chromadock: error: {path}: unknown key speed: correct or remove it\n")
    assert not (tmp_path / "out").exists()


def test_a_slip_in_the_arguments_is_told_before_any_work(tmp_path: Path) -> None:
    with pytest.raises(ChromadockError, match=r"no\.toml: .*No such file"):
        command([tmp_path / "no.toml"], tmp_path / "out")
    path = write(tmp_path)
    with pytest.raises(ChromadockError, match="--workers are this machine's"):
        command([path], tmp_path / "out", scheduler="tcp://127.0.0.1:9", workers=2)
    (tmp_path / "file").write_text("")
    with pytest.raises(ChromadockError, match="file/out: cannot be written"):
        command([path], tmp_path / "file" / "out", workers=1)


def test_a_scheduler_that_does_not_answer_is_a_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_CONNECT_S", 0.5)
    for address in ("tcp://127.0.0.1:9", "what://ever", "127.0.0.1"):
        with (
            pytest.raises(ChromadockError, match=f"--scheduler {address}: nobody answers") as error,
            cluster.remote_cluster(address, print),
        ):
            pass
        assert "\n" not in str(error.value)


def test_workers_of_another_version_are_told_and_none_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with LocalCluster(
        n_workers=1, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as elsewhere:
        told: list[str] = []
        with cluster.remote_cluster(elsewhere.scheduler_address, told.append) as client:
            assert client.submit(sum, [1, 2]).result() == 3
        assert told == []
        found = version._version
        here = {"numpy": "0.9"}  # in this process; the workers have their own module
        monkeypatch.setattr(version, "_version", lambda name: here.get(name) or found(name))
        with cluster.remote_cluster(elsewhere.scheduler_address, told.append):
            pass
        assert len(told) == 1
        assert told[0].startswith("warning: numpy is 0.9 here and ")
        elsewhere.scale(0)
        wait_for(lambda: not elsewhere.scheduler_info["workers"])
        with (
            pytest.raises(ChromadockError, match="has no workers"),
            cluster.remote_cluster(elsewhere.scheduler_address, told.append),
        ):
            pass
