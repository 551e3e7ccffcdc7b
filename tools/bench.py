"""Measures against budgets.py: .venv/bin/python tools/bench.py, by `make bench`.

Prints tables and writes out/bench.json.  What exceeds its budget is shown in red; that is
no failure here, the tests hold the dock's.  Exit status 1: the Xtensa run did not work.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import budgets
from bench_host import SkippedError, host_ratios, resident_mib, simulator_ratios
from rich.console import Console
from rich.table import Table
from xtensa import Measurement, measure
from xtensa_build import MissingError, XtensaError

RESULT = Path(__file__).resolve().parents[1] / "out" / "bench.json"

MEMORY_BUDGETS = {
    "code_bytes": ("code and tables", budgets.CODE_BYTES),
    "ram_bytes": ("RAM", budgets.RAM_BYTES),
    "stack_bytes": ("stack", budgets.STACK_BYTES),
}

# Without a terminal nothing is cut off to fit one.
console = Console(highlight=False, width=None if sys.stdout.isatty() else 120)


def main() -> int:
    """Measure what can be measured here, and return the exit status."""
    xtensa: dict[str, Any] = {}
    host: dict[str, Any] = {"ratio_to_gaussian_blur": {}, "peers": {}}
    skipped: list[str] = []
    failed = False
    try:
        measurement = measure()
        xtensa = xtensa_figures(measurement)
        show_instructions(measurement)
        show_memory(xtensa)
        for line in measurement.differences:
            console.print(line, markup=False)
        failed = bool(measurement.differences)
    except MissingError as error:
        skipped.append(f"Xtensa: {error}")
    except XtensaError as error:
        console.print(f"Xtensa: {error}", markup=False)
        failed = True
    try:
        host["ratio_to_gaussian_blur"], left_out = host_ratios()
        skipped += left_out
        show_ratios(host["ratio_to_gaussian_blur"])
        host["resident_mib"] = resident_mib()
        text = judged(host["resident_mib"], budgets.RESIDENT_MIB, f"{host['resident_mib']:.0f}")
        console.print(f"chromadock detect on VGA video: {text} of {budgets.RESIDENT_MIB} MiB")
        host["simulator_ratio_to_gaussian_blur"] = simulator_ratios()
        for scene, ratio in host["simulator_ratio_to_gaussian_blur"].items():
            console.print(f"a simulated VGA frame, {scene}: {ratio:.0f} Gaussian blurs")
    except SkippedError as error:
        skipped.append(str(error))
    for line in skipped:
        console.print(f"skipped: {line}", markup=False, soft_wrap=True)
    write({"xtensa": xtensa, "host": host})
    return 1 if failed else 0


def xtensa_figures(measurement: Measurement) -> dict[str, Any]:
    """Sum up for bench.json: the worst frame stands for all."""
    return {
        "instructions_qqvga": measurement.instructions[measurement.worst_frame],
        "code_bytes": measurement.code_bytes,
        "ram_bytes": measurement.ram_bytes,
        "stack_bytes": measurement.stack_bytes,
    }


def judged(value: float, limit: float, text: str) -> str:
    """Colour a figure that is over its limit."""
    return f"[red]{text}[/red]" if value > limit else text


def show_instructions(measurement: Measurement) -> None:
    """Print the instructions, a stage a row, a frame a column."""
    frames = measurement.instructions
    table = Table(title="dockcore on Xtensa: instructions a QQVGA RGB565 frame")
    table.add_column("stage")
    for name in (*(frame.removesuffix("_qqvga") for frame in frames), "budget"):
        table.add_column(name, justify="right")
    for stage in frames[measurement.worst_frame]:
        counts = [stages[stage] for stages in frames.values()]
        if stage == "total":
            table.add_section()
            limit = budgets.INSTRUCTIONS_QQVGA
            table.add_row(stage, *(judged(n, limit, f"{n:,}") for n in counts), f"{limit:,}")
        else:
            table.add_row(stage, *(f"{n:,}" for n in counts))
    console.print(table)


def show_memory(figures: dict[str, Any]) -> None:
    """Print code, RAM and stack."""
    table = Table(title="dockcore on Xtensa: bytes", caption="without libc and libgcc")
    table.add_column("what")
    table.add_column("used", justify="right")
    table.add_column("budget", justify="right")
    for key, (name, budget) in MEMORY_BUDGETS.items():
        used = figures[key]
        table.add_row(name, judged(used, budget, f"{used:,}"), f"{budget:,}")
    console.print(table)


def show_ratios(ratios: dict[str, float]) -> None:
    """Print the ratios, a scene a row."""
    stages = list(dict.fromkeys(name.split("/")[1] for name in ratios if "/" in name))
    table = Table(
        title="Detector.process, 640x480, one thread: times a 5x5 Gaussian blur",
        caption=f"budget of the total on plain water: {budgets.BLUR_RATIO}, for later methods; "
        "the paper's is here for comparison",
    )
    table.add_column("scene")
    for column in (*stages, "total"):
        table.add_column(column, justify="right")
    for scene in (name for name in ratios if "/" not in name):
        parts = [f"{ratios.get(f'{scene}/{stage}', 0.0):.2f}" for stage in stages]
        total = ratios[scene]
        table.add_row(scene, *parts, judged(total, budgets.BLUR_RATIO, f"{total:.2f}"))
    console.print(table)


def write(result: dict[str, Any]) -> None:
    """Write bench.json whole or not at all."""
    RESULT.parent.mkdir(exist_ok=True)
    temporary = RESULT.with_suffix(".json.new")
    temporary.write_text(json.dumps(result, indent=2) + "\n")
    temporary.replace(RESULT)
    console.print(f"written: {RESULT.relative_to(RESULT.parents[1])}")


if __name__ == "__main__":
    sys.exit(main())
