"""Prints what `make bench` measured, each figure beside its budget."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any

import budgets
from bench_memory import LongRun
from bench_peers import SETTINGS
from rich.console import Console
from rich.table import Table
from xtensa import Measurement

FRAME_BUDGETS = {"total": budgets.INSTRUCTIONS_QQVGA, "cold": budgets.INSTRUCTIONS_COLD}
MEMORY_BUDGETS = {
    "code_bytes": ("code and tables", budgets.CODE_BYTES),
    "ram_bytes": ("RAM", budgets.RAM_BYTES),
    "stack_bytes": ("stack", budgets.STACK_BYTES),
}


def console() -> Console:
    """Where it goes; without a terminal nothing is cut off to fit one."""
    return Console(highlight=False, width=None if sys.stdout.isatty() else 120)


def judged(value: float, limit: float | None, text: str) -> str:
    """Colour a figure that is over its limit."""
    return f"[red]{text}[/red]" if limit is not None and value > limit else text


def instructions_table(measurement: Measurement) -> Table:
    """The dock's instructions, a stage a row, a frame a column."""
    frames = measurement.instructions
    table = Table(title="dockcore on Xtensa: instructions a QQVGA RGB565 frame")
    table.add_column("stage")
    for name in (*(frame.removesuffix("_qqvga") for frame in frames), "budget"):
        table.add_column(name, justify="right")
    for stage in frames[measurement.worst_frame]:
        counts = [stages[stage] for stages in frames.values()]
        if stage in FRAME_BUDGETS:
            table.add_section()
            limit = FRAME_BUDGETS[stage]
            table.add_row(stage, *(judged(n, limit, f"{n:,}") for n in counts), f"{limit:,}")
        else:
            table.add_row(stage, *(f"{n:,}" for n in counts))
    return table


def bytes_table(figures: Mapping[str, Any]) -> Table:
    """The dock's code, RAM and stack."""
    table = Table(title="dockcore on Xtensa: bytes", caption="without libc and libgcc")
    table.add_column("what")
    table.add_column("used", justify="right")
    table.add_column("budget", justify="right")
    for key, (name, budget) in MEMORY_BUDGETS.items():
        used = figures[key]
        table.add_row(name, judged(used, budget, f"{used:,}"), f"{budget:,}")
    return table


def ratios_table(
    title: str, ratios: Mapping[str, float], rows: Sequence[tuple[str, str, float | None]]
) -> Table:
    """What ``Detector.process`` costs.

    Parameters
    ----------
    ratios : by "scene" and "scene/stage".
    rows : scene, what it is called, budget of its total or None.
    """
    scenes = {scene for scene, _, _ in rows}
    stages = dict.fromkeys(
        name.split("/")[1] for name in ratios if "/" in name and name.split("/")[0] in scenes
    )
    table = Table(title=title)
    table.add_column("frame")
    for column in (*stages, "total", "budget"):
        table.add_column(column, justify="right")
    for scene, called, limit in rows:
        parts = [f"{ratios.get(f'{scene}/{stage}', 0.0):.2f}" for stage in stages]
        total = judged(ratios[scene], limit, f"{ratios[scene]:.2f}")
        table.add_row(called, *parts, total, "" if limit is None else f"{limit:g}")
    return table


def tracked_table(ratios: Mapping[str, tuple[float, float]]) -> Table:
    """With the track: the mean and the 98th percentile by what the frame is called."""
    table = Table(title="with the track, 30 frames a second: times a 5x5 Gaussian blur")
    table.add_column("frame")
    table.add_column("mean", justify="right")
    table.add_column("98 %", justify="right")
    for called, (mean, longest) in ratios.items():
        table.add_row(called, f"{mean:.2f}", f"{longest:.2f}")
    return table


def peers_table(scene: str, own: float, peers: Mapping[str, float]) -> Table:
    """The whole detector beside a part of one and another kind of one, on the same frame."""
    table = Table(title=f"peers, {scene}: times a 5x5 Gaussian blur of it")
    table.add_column("what")
    table.add_column("run on")
    table.add_column("ratio", justify="right")
    table.add_row("Detector.process", "the whole way from the frame to the pose", f"{own:.2f}")
    for name, ratio in peers.items():
        table.add_row(name, SETTINGS[name], f"{ratio:.2f}")
    return table


def long_runs_table(runs: Mapping[str, LongRun]) -> Table:
    """Resident memory over many frames."""
    table = Table(title="one Detector over many VGA frames: MiB resident")
    for column in ("frames", "number", "settled", "at the end", "largest", "budget of growth"):
        table.add_column(column, justify="left" if column == "frames" else "right")
    limit = budgets.GROWTH_MIB
    for kind, run in runs.items():
        end = judged(run.end_mib - run.settled_mib, limit, f"{run.end_mib:.1f}")
        row = (f"{run.frames:,}", f"{run.settled_mib:.1f}", end, f"{run.largest_mib:.1f}")
        table.add_row(kind, *row, f"{limit:g}")
    return table
