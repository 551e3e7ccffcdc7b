"""Measures against budgets.py: .venv/bin/python tools/bench.py, by `make bench`.

Prints tables and writes out/bench.json.  What exceeds its budget is shown in red; that is
no failure here, the tests hold the dock's.  Exit status 1: the Xtensa run did not work.
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from typing import Any

import bench_tables
import budgets
from bench_memory import long_runs, resident_mib
from bench_peers import peer_ratios
from bench_ratios import by_cost, detector_ratios, tracked_ratios
from bench_scenes import LARGER, PHOTOGRAPHS, docks, enlarged, photographs, plain_water
from bench_simulator import simulator_ratios
from step import ROOT
from xtensa import Measurement, measure
from xtensa_build import MissingError, XtensaError

RESULT = ROOT / "out" / "bench.json"

WATER = "water"

console = bench_tables.console()


def main() -> int:
    """Measure what can be measured here, and return the exit status."""
    skipped: list[str] = []
    xtensa, failed = measured_xtensa(skipped)
    host = measured_host(skipped)
    for line in skipped:
        console.print(f"skipped: {line}", markup=False, soft_wrap=True)
    write({"xtensa": xtensa, "host": host})
    return 1 if failed else 0


def measured_xtensa(skipped: list[str]) -> tuple[dict[str, Any], bool]:
    """The dock: figures, and whether the run went wrong."""
    try:
        measurement = measure()
    except MissingError as error:
        skipped.append(f"Xtensa: {error}")
        return {}, False
    except XtensaError as error:
        console.print(f"Xtensa: {error}", markup=False)
        return {}, True
    figures = xtensa_figures(measurement)
    console.print(bench_tables.instructions_table(measurement))
    console.print(bench_tables.bytes_table(figures))
    for line in measurement.differences:
        console.print(line, markup=False)
    return figures, bool(measurement.differences)


def xtensa_figures(measurement: Measurement) -> dict[str, Any]:
    """Sum up for bench.json: the worst frame stands for all."""
    return {
        "instructions_qqvga": measurement.instructions[measurement.worst_frame],
        "code_bytes": measurement.code_bytes,
        "ram_bytes": measurement.ram_bytes,
        "stack_bytes": measurement.stack_bytes,
    }


def measured_host(skipped: list[str]) -> dict[str, Any]:
    """The vehicle: ratios, peers and memory."""
    host: dict[str, Any] = {}
    host["ratio_to_gaussian_blur"], host["peers"] = measured_detector(skipped)
    host["tracked_ratio_to_gaussian_blur"] = tracked = measured_track()
    console.print(bench_tables.tracked_table(tracked))
    host["resident_mib"] = resident_mib()
    text = bench_tables.judged(
        host["resident_mib"], budgets.RESIDENT_MIB, f"{host['resident_mib']:.0f}"
    )
    console.print(f"chromadock detect on VGA video: {text} of {budgets.RESIDENT_MIB} MiB")
    runs = long_runs()
    console.print(bench_tables.long_runs_table(runs))
    host["long_runs"] = {kind: asdict(run) for kind, run in runs.items()}
    host["simulator_ratio_to_gaussian_blur"] = simulator_ratios()
    for scene, ratio in host["simulator_ratio_to_gaussian_blur"].items():
        console.print(f"a simulated VGA frame, {scene}: {ratio:.0f} Gaussian blurs")
    return host


def measured_detector(skipped: list[str]) -> tuple[dict[str, float], dict[str, float]]:
    """Ratios of the detector on all frames, and of its peers on one."""
    ratios = detector_ratios({WATER: plain_water()})
    rows: list[tuple[str, str, float | None]] = [(WATER, "plain water", budgets.BLUR_RATIO)]
    real = photographs()
    middle = plain_water()
    if real:
        seen = detector_ratios(real)
        order = by_cost(seen)
        median, worst = order[len(order) // 2], order[-1]
        middle = real[median]
        ratios |= seen
        rows.append((median, f"median of {len(real)} photographs: {median}", None))
        rows.append((worst, f"worst of them: {worst}", budgets.BLUR_RATIO_WORST))
    else:
        skipped.append(
            f"real frames: no folder {PHOTOGRAPHS.relative_to(ROOT.parent)} beside this one"
        )
    with_dock = docks(middle)
    ratios |= detector_ratios(with_dock)
    rows += [(scene, f"{scene}, composited", None) for scene in with_dock]
    ratios |= detector_ratios(larger := larger_frames(middle))
    rows += [(scene, scene, limit_of(scene)) for scene in larger]
    console.print(
        bench_tables.ratios_table(
            "Detector.process, robust, one thread: times a 5x5 Gaussian blur of the frame "
            "(640x480 where not said; photographs of other sizes are scaled to it)",
            ratios,
            rows,
        )
    )
    paper = "water, method paper"
    ratios |= renamed(detector_ratios({WATER: plain_water()}, method="paper"), WATER, paper)
    console.print(
        bench_tables.ratios_table("the paper's method", ratios, [(paper, "plain water", None)])
    )
    scene, frame = next(iter(with_dock.items()))
    peers, missing = peer_ratios(frame)
    skipped += missing
    console.print(bench_tables.peers_table(scene, ratios[scene], peers))
    return ratios, peers


def measured_track() -> dict[str, tuple[float, float]]:
    """Mean and 98th percentile of the detector with its track, without a dock and with one."""
    measured = {"plain water": tracked_ratios({WATER: plain_water()})[WATER]}
    real = tracked_ratios(photographs())
    if real:
        order = sorted(real, key=lambda name: real[name])
        median, worst = order[len(order) // 2], order[-1]
        measured[f"median of {len(real)} photographs: {median}"] = real[median]
        measured[f"worst of them: {worst}"] = real[worst]
    tracked = tracked_ratios(docks(plain_water()))
    return measured | {f"{scene}, tracked": ratio for scene, ratio in tracked.items()}


def larger_frames(photograph: Any) -> dict[str, Any]:
    """Plain water and a photograph at the larger sizes, by the scene's name."""
    frames = {}
    for size in LARGER:
        frames[f"{WATER} {size[0]}x{size[1]}"] = plain_water(size)
        frames[f"photograph {size[0]}x{size[1]}"] = enlarged(photograph, size)
    return frames


def limit_of(scene: str) -> float:
    """The larger frame's budget is that of VGA."""
    return budgets.BLUR_RATIO if scene.startswith(WATER) else budgets.BLUR_RATIO_WORST


def renamed(ratios: dict[str, float], old: str, new: str) -> dict[str, float]:
    """The same figures of a scene under another name."""
    return {name.replace(old, new, 1): value for name, value in ratios.items()}


def write(result: dict[str, Any]) -> None:
    """Write bench.json whole or not at all."""
    RESULT.parent.mkdir(exist_ok=True)
    temporary = RESULT.with_suffix(".json.new")
    temporary.write_text(json.dumps(result, indent=2) + "\n")
    temporary.replace(RESULT)
    console.print(f"written: {RESULT.relative_to(ROOT)}")


if __name__ == "__main__":
    sys.exit(main())
